/* SPDX-License-Identifier: BSD-2-Clause */
/* A face's FAPU as a text file: "ES 62.5" a line, in millimetres. */
#ifndef COMMON_FAPU_FILE_H
#define COMMON_FAPU_FILE_H

#include <stddef.h>

#include <fap/fapu.h>

/* @p where gets FAP_ERROR_TEXT_SIZE bytes of what is wrong. All five must be there. */
fap_err fapu_file_read(const char *path, fap_fapu *out, char *where);
fap_err fapu_file_parse(const char *text, fap_fapu *out, char *where);

#endif
