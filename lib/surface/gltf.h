/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * What a GLB's JSON says, as tables, and the numbers that its accessors give: between gltf_tables.c and gltf_columns.c, which
 * read them, and read_gltf.c, which walks the scene.
 */
#ifndef LIB_SURFACE_GLTF_H
#define LIB_SURFACE_GLTF_H

#include "surface/surface_driver.h"
#include "take/json_text.h"

enum { GLTF_MOST_ITEMS = 1 << 16, GLTF_TRIANGLES = 4, GLTF_STRIP = 5, GLTF_FAN = 6 };
/* Component types, as the specification numbers them. */
enum { GLTF_I8 = 5120, GLTF_U8, GLTF_I16, GLTF_U16, GLTF_U32 = 5125, GLTF_F32 };

typedef struct view {
    uint64_t offset, length, stride;
} view;

typedef struct accessor {
    int view, sparse_indices, sparse_values; /* -1: none */
    uint64_t offset, count, sparse_count, sparse_indices_offset, sparse_values_offset;
    int type, sparse_type, width;
} accessor;

typedef struct primitive {
    int mesh, position, uv, colour, indices, mode;
    json_text targets; /* at the array; end where there is none */
} primitive;

typedef struct node {
    int mesh;
    double matrix[16]; /* columns */
    json_text children;
} node;

typedef struct gltf {
    const surface_source *src;
    const uint8_t *bin;
    uint64_t bin_size;
    json_text views_text, accessors_text, meshes_text, nodes_text, scenes_text, required_text;
    int scene;
    view *view;
    accessor *accessor;
    primitive *primitive;
    node *node;
    int view_count, accessor_count, primitive_count, node_count, mesh_count;
    json_text *names; /* [mesh_count] extras.targetNames */
    /* What the first walk counts and the second fills. */
    fap_surface *s;
    uint64_t vertices, triangles;
    uint32_t targets;
    int visits, filling;
    fap_err err;
} gltf;

/* The JSON and the binary part; everything but the scene is in tables then. gltf_close() in any case. */
fap_err gltf_open(gltf *g);
void gltf_close(gltf *g);
/* Notes the first error. */
void gltf_stop(gltf *g, fap_err err, const char *why);

/* --- JSON --- */

int gltf_same(text key, const char *word);
int gltf_is_there(const json_text *j);
int gltf_index(json_text *j);
/* A value for later: where it begins; the reader goes on behind it. */
json_text gltf_keep(json_text *j);
void gltf_read_attributes(primitive *p, json_text *j);

/* --- columns --- */

/* What an accessor gives, element by element. */
typedef struct column {
    const accessor *a;
    const uint8_t *base, *indices, *values; /* NULL: zeroes; not sparse */
    uint64_t stride, size;
    uint64_t next; /* of the sparse elements: those in front are behind us */
} column;

uint32_t gltf_read_32(const uint8_t *p);
/* What may number things. */
int gltf_counts(int type);
/* 0: it does not say what it should, or not within the file. @p width: 0: any. */
int gltf_open_column(const gltf *g, column *c, int index, int width);
/* Elements are asked for in ascending order, as sparse ones are stored. */
void gltf_element(column *c, uint64_t i, double *out);
/* Whole numbers that stand for 0 to 1. */
double gltf_unit(const accessor *a, double v);

#endif
