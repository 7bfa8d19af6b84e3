/* SPDX-License-Identifier: BSD-2-Clause */
/* A range image on disk: the camera's JSON, a depth picture (16-bit grey PNG, PFM) and a colour picture (PNG) beside it. */
#ifndef DATABANK_RANGE_RANGE_FILE_H
#define DATABANK_RANGE_RANGE_FILE_H

#include <fap/studio/surface.h>

/* Where the pictures come from, by the name the camera has for them: malloc'ed bytes. */
typedef struct range_folder {
    fap_err (*read)(void *user, const char *name, uint8_t **data, size_t *size);
    void *user;
} range_folder;

/* 1: what an unknown file begins with may be a camera. */
int range_file_may_be(const uint8_t *data, size_t size);
/* @where FAP_ERROR_TEXT_SIZE bytes: which file, and what is wrong with it. FAP_E_UNKNOWN_FORMAT: the text is no camera. */
fap_err range_file_read(fap_surface **out, const range_folder *folder, const void *text, size_t size,
                        char *where);
/* The pictures are in the folder of the camera's file. */
fap_err range_file_read_beside(fap_surface **out, const char *path, const void *text, size_t size,
                               char *where);

#endif
