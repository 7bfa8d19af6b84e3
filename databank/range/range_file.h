/* SPDX-License-Identifier: BSD-2-Clause */
/* A range image on disk: the camera's JSON, a depth picture (16-bit grey PNG, PFM) and a colour picture (PNG) beside it. */
#ifndef DATABANK_RANGE_RANGE_FILE_H
#define DATABANK_RANGE_RANGE_FILE_H

#include <fap/studio/surface.h>

/* @where FAP_ERROR_TEXT_SIZE bytes: which file, and what is wrong with it. FAP_E_UNKNOWN_FORMAT: the text is no camera. */
fap_err range_file_read(fap_surface **out, const char *path, const void *text, size_t size, char *where);

#endif
