/* SPDX-License-Identifier: BSD-2-Clause */
/* FAP interpolation tables as files. A stream take.fba has its table in take.fit. */
#ifndef COMMON_FIT_FILE_H
#define COMMON_FIT_FILE_H

#include <stddef.h>

#include <fap/fit.h>

/* @p where gets FAP_ERROR_TEXT_SIZE bytes of what is wrong. *fit is NULL unless FAP_OK; fap_fit_close() it. */
fap_err fit_file_read(fap_fit **fit, const char *path, char *where);
/* The name that the table of @p stream has: its own, with .fit in place of the ending. 0: standard input or output,
 * or a name too long. */
int fit_file_name(const char *stream, char *path, size_t room);
/* 1: that file is there. */
int fit_file_beside(const char *stream, char *path, size_t room);

#endif
