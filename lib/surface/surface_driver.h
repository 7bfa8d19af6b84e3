/* SPDX-License-Identifier: BSD-2-Clause */
/* What a reader of surfaces has: one file a format, found by its first bytes. */
#ifndef LIB_SURFACE_SURFACE_DRIVER_H
#define LIB_SURFACE_SURFACE_DRIVER_H

#include <fap/studio/surface.h>

typedef struct surface_source {
    const uint8_t *data;
    size_t size;
    const fap_allocator *alloc; /* complete */
    char *where;                /* FAP_ERROR_TEXT_SIZE bytes */
} surface_source;

typedef struct surface_driver {
    const char *name; /* static */
    /* 1: these bytes are of this format; not more than that needs looking at. */
    int (*sniff)(const uint8_t *data, size_t size);
    /* Triangles may be degenerate and indices out of range: who calls looks after that. */
    fap_err (*read)(const surface_source *src, fap_surface **out);
} surface_driver;

extern const surface_driver surface_driver_obj, surface_driver_ply, surface_driver_gltf;

/* Says where and returns @p err. */
fap_err surface_fail(const surface_source *src, fap_err err, const char *fmt, ...)
    __attribute__((format(printf, 3, 4)));
void surface_note(fap_surface *s, const char *fmt, ...) __attribute__((format(printf, 2, 3)));

/* FAP_E_LIMIT or FAP_E_DATA with a text where the counts cannot be meant. @p least: bytes a vertex takes in the file. */
fap_err surface_check_counts(const surface_source *src, uint64_t vertices, uint64_t triangles);
/* Optional parts; 0: no memory. */
int surface_want_uv(fap_surface *s);
int surface_want_colour(fap_surface *s);
int surface_want_targets(fap_surface *s, uint32_t count);

#endif
