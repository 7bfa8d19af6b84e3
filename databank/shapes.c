/* SPDX-License-Identifier: BSD-2-Clause */
/* See shapes.h. */
#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

#include "common/file.h"
#include "common/tool.h"
#include "databank/shapes.h"

enum { PATH_SIZE = 4096, FILES_MAX = SHAPES_MAX + 1 };

static const size_t most = (size_t)1 << 30;

static int read_surface(fap_surface **out, const char *path, fault *f)
{
    char where[FAP_ERROR_TEXT_SIZE] = "";
    uint8_t *data;
    size_t size;

    errno = 0;
    fap_err err = file_read(path, most, &data, &size);
    if (err == FAP_OK) {
        err = fap_surface_read(out, data, size, NULL, where);
        free(data);
    }
    return err == FAP_OK || fault_set(f, EXIT_DATA, "%s: %s", path,
                                      *where                     ? where
                                      : err == FAP_E_IO && errno ? strerror(errno)
                                                                 : fap_strerror(err));
}

/* --- a file with morph targets --- */

static int take_targets(shapes *s, const char *path, fault *f)
{
    const fap_surface *n = s->neutral;

    if (!n->target_count)
        return fault_set(f, EXIT_DATA,
                         "%s: no morph target in it; a folder with a mesh for each shape will do as well",
                         path);
    for (uint32_t t = 0; t < n->target_count && s->count < SHAPES_MAX; t++) {
        s->delta[s->count] = malloc(n->vertex_count * sizeof *s->delta[0]);
        if (!s->delta[s->count])
            return fault_set(f, EXIT_DATA, "out of memory");
        memcpy(s->delta[s->count], n->target[t].delta, n->vertex_count * sizeof *s->delta[0]);
        if (*n->target[t].name)
            snprintf(s->name[s->count], SHAPE_NAME_SIZE, "%s", n->target[t].name);
        else
            snprintf(s->name[s->count], SHAPE_NAME_SIZE, "shape_%u", (unsigned)t);
        s->count++;
    }
    return 1;
}

/* --- a folder of meshes --- */

typedef struct listing {
    char name[FILES_MAX][SHAPE_NAME_SIZE + 8];
    int count;
} listing;

static int is_mesh(const char *name)
{
    const char *dot = strrchr(name, '.');
    return dot && dot != name && (!strcasecmp(dot, ".obj") || !strcasecmp(dot, ".ply"));
}

static int by_name(const void *a, const void *b)
{
    return strcmp(a, b);
}

static int list_folder(listing *l, const char *path, fault *f)
{
    DIR *dir = opendir(path);

    if (!dir)
        return fault_set(f, EXIT_DATA, "%s: %s", path, strerror(errno));
    for (const struct dirent *e; (e = readdir(dir)) && l->count < FILES_MAX;)
        if (is_mesh(e->d_name) && strlen(e->d_name) < sizeof l->name[0])
            strcpy(l->name[l->count++], e->d_name);
    closedir(dir);
    qsort(l->name, (size_t)l->count, sizeof l->name[0], by_name);
    return 1;
}

static int has_word(const char *name, const char *word)
{
    for (; *name; name++)
        if (!strncasecmp(name, word, strlen(word)))
            return 1;
    return 0;
}

static int find_neutral(const listing *l)
{
    for (int i = 0; i < l->count; i++)
        if (has_word(l->name[i], "neutral"))
            return i;
    return -1;
}

static int take_shape(shapes *s, const char *path, const char *name, fault *f)
{
    fap_surface *shape;
    const uint32_t n = s->neutral->vertex_count;

    if (!read_surface(&shape, path, f))
        return 0;
    if (shape->vertex_count != n) {
        const unsigned has = shape->vertex_count;
        fap_surface_close(&shape);
        return fault_set(f, EXIT_DATA, "%s: %u vertices, the neutral face has %u: not of one structure", path,
                         has, (unsigned)n);
    }
    float(*delta)[3] = malloc(n * sizeof *delta);
    for (uint32_t i = 0; delta && i < n; i++)
        for (int a = 0; a < 3; a++)
            delta[i][a] = shape->position[i][a] - s->neutral->position[i][a];
    fap_surface_close(&shape);
    snprintf(s->name[s->count], SHAPE_NAME_SIZE, "%.*s", (int)(strrchr(name, '.') - name), name);
    s->delta[s->count] = delta;
    s->count += delta != NULL;
    return delta || fault_set(f, EXIT_DATA, "out of memory");
}

static int read_folder(shapes *s, const char *folder, fault *f)
{
    char path[PATH_SIZE];
    listing *l = calloc(1, sizeof *l);
    int ok = l ? list_folder(l, folder, f) : fault_set(f, EXIT_DATA, "out of memory");

    const int neutral = ok ? find_neutral(l) : -1;
    if (ok && neutral < 0)
        ok = fault_set(f, EXIT_DATA, "%s: which is the face at rest? No mesh has \"neutral\" in its name",
                       folder);
    if (ok) {
        snprintf(path, sizeof path, "%s/%s", folder, l->name[neutral]);
        ok = read_surface(&s->neutral, path, f);
    }
    for (int i = 0; ok && i < l->count && s->count < SHAPES_MAX; i++) {
        snprintf(path, sizeof path, "%s/%s", folder, l->name[i]);
        ok = i == neutral || take_shape(s, path, l->name[i], f);
    }
    free(l);
    return ok && (s->count || fault_set(f, EXIT_DATA, "%s: no shape beside the neutral face", folder));
}

int shapes_read(shapes *s, const char *path, fault *f)
{
    struct stat st;

    memset(s, 0, sizeof *s);
    if (stat(path, &st))
        return fault_set(f, EXIT_DATA, "%s: %s", path, strerror(errno));
    if (S_ISDIR(st.st_mode))
        return read_folder(s, path, f);
    return read_surface(&s->neutral, path, f) && take_targets(s, path, f);
}

void shapes_free(shapes *s)
{
    for (int i = 0; i < s->count; i++)
        free(s->delta[i]);
    fap_surface_close(&s->neutral);
    s->count = 0;
}
