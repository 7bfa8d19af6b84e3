/* SPDX-License-Identifier: BSD-2-Clause */
/* See folder.h. */
#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "common/folder.h"

/* --- making --- */

static int make_above(const char *path, size_t length)
{
    char *const part = malloc(length + 1);
    int made = part != NULL;

    for (size_t i = 1; made && i <= length; i++) {
        if (path[i] != '/' && path[i] != '\0' && i < length)
            continue;
        memcpy(part, path, i);
        part[i] = '\0';
        made = !mkdir(part, 0777) || errno == EEXIST;
    }
    free(part);
    return made;
}

int folder_make(const char *path)
{
    return make_above(path, strlen(path));
}

int folder_make_for(const char *path)
{
    const char *const slash = strrchr(path, '/');
    return !slash || slash == path || make_above(path, (size_t)(slash - path));
}

/* --- listing --- */

typedef struct walk {
    folder_list *l;
    struct stat leave_out;
    int leaves_out;
} walk;

static char *join(const char *folder, const char *name)
{
    const size_t room = strlen(folder) + strlen(name) + 2;
    char *const path = malloc(room);

    if (path)
        snprintf(path, room, *folder ? "%s/%s" : "%s%s", folder, name);
    return path;
}

static fap_err keep(folder_list *l, char *name)
{
    if (l->count == FOLDER_MAX_FILES)
        return FAP_E_LIMIT;
    if (l->count == l->room) {
        const size_t room = l->room ? 2 * l->room : 64;
        char **grown = realloc(l->name, room * sizeof *grown);
        if (!grown)
            return FAP_E_NOMEM;
        l->name = grown;
        l->room = room;
    }
    l->name[l->count++] = name;
    return FAP_OK;
}

static fap_err walk_folder(walk *w, const char *path, const char *relative, int depth);

static int is_left_out(const walk *w, const struct stat *s)
{
    return w->leaves_out && s->st_dev == w->leave_out.st_dev && s->st_ino == w->leave_out.st_ino;
}

/* What cannot be looked at or has gone meanwhile is not there. */
static fap_err walk_entry(walk *w, const char *path, char **relative, int depth)
{
    struct stat s;

    if (lstat(path, &s))
        return FAP_OK;
    if (S_ISDIR(s.st_mode))
        return is_left_out(w, &s) ? FAP_OK : walk_folder(w, path, *relative, depth + 1);
    if (stat(path, &s) || !S_ISREG(s.st_mode))
        return FAP_OK;
    const fap_err err = keep(w->l, *relative);
    if (err == FAP_OK)
        *relative = NULL; /* the list's now */
    return err;
}

static fap_err walk_folder(walk *w, const char *path, const char *relative, int depth)
{
    const struct dirent *entry;
    fap_err err = FAP_OK;

    if (depth > FOLDER_MAX_DEPTH)
        return FAP_E_LIMIT;
    DIR *const d = opendir(path);
    if (!d)
        return depth ? FAP_OK : errno == ENOENT ? FAP_E_NOT_FOUND : FAP_E_IO;
    while (err == FAP_OK && (entry = readdir(d))) {
        if (*entry->d_name == '.')
            continue;
        char *const full = join(path, entry->d_name);
        char *rest = join(relative, entry->d_name);
        err = full && rest ? walk_entry(w, full, &rest, depth) : FAP_E_NOMEM;
        free(full);
        free(rest);
    }
    closedir(d);
    return err;
}

static int by_name(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

fap_err folder_list_files(folder_list *l, const char *path, const char *leave_out)
{
    walk w = { .l = l };

    *l = (folder_list){ 0 };
    w.leaves_out = leave_out && !stat(leave_out, &w.leave_out);
    const fap_err err = walk_folder(&w, path, "", 0);
    if (err != FAP_OK) {
        const int why = errno;
        folder_list_free(l);
        errno = why;
        return err;
    }
    if (l->count)
        qsort(l->name, l->count, sizeof *l->name, by_name);
    return FAP_OK;
}

void folder_list_free(folder_list *l)
{
    for (size_t i = 0; i < l->count; i++)
        free(l->name[i]);
    free(l->name);
    *l = (folder_list){ 0 };
}
