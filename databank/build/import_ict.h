/* SPDX-License-Identifier: BSD-2-Clause */
/* ICT-FaceKit's light face model: its neutral head and its unit shapes, under ARKit's names. */
#ifndef DATABANK_BUILD_IMPORT_ICT_H
#define DATABANK_BUILD_IMPORT_ICT_H

#include <stddef.h>

#include <fap/studio/bank_build.h>

/*
 * @path  the folder FaceXModel: generic_neutral_mesh.obj, and beside it one OBJ a shape, or expressions/ with .target files
 * @bad   gets the name of the file at fault
 */
fap_err import_ict(fap_bank_builder **out, const char *path, char *bad, size_t bad_size);

#endif
