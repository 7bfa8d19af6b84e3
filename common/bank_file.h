/* SPDX-License-Identifier: BSD-2-Clause */
/* A face as a file, and where the default face is. */
#ifndef COMMON_BANK_FILE_H
#define COMMON_BANK_FILE_H

#include <stddef.h>

#include <fap/bank.h>

enum { BANK_PATH_SIZE = 4096 };

/* @p where gets FAP_ERROR_TEXT_SIZE bytes of what is wrong. *bank is NULL unless FAP_OK; fap_bank_close() it. */
fap_err bank_file_read(fap_bank **bank, const char *path, char *where);

/* 1 and BANK_PATH_SIZE bytes of path where there is one: beside the build folder of this program (whoever builds
 * means the face that was built), or where it was installed. */
int bank_file_default(char *path);

#endif
