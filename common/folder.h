/* SPDX-License-Identifier: BSD-2-Clause */
/* Folders: making them, and what is in them. */
#ifndef COMMON_FOLDER_H
#define COMMON_FOLDER_H

#include <stddef.h>

#include <fap/error.h>

/* The folder and those above it, where they are not there yet. 0: errno says why. */
int folder_make(const char *path);
/* The folder that @path lies in, made. 0: errno says why. */
int folder_make_for(const char *path);

/* Names of regular files, relative to the folder that was looked through, in the order of strcmp(). */
typedef struct folder_list {
    char **name;
    size_t count, room;
} folder_list;

enum { FOLDER_MAX_DEPTH = 32, FOLDER_MAX_FILES = 1000000 };

/*
 * All files under @path whose names and folders do not begin with a dot. Links to folders are not followed. @leave_out: a folder
 * that is not looked into, by whatever name; NULL: none. FAP_E_NOT_FOUND and FAP_E_IO with errno; FAP_E_LIMIT; FAP_E_NOMEM.
 */
fap_err folder_list_files(folder_list *l, const char *path, const char *leave_out);
void folder_list_free(folder_list *l);

#endif
