/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The container: numbers in sections of one binary chunk, accessors that say what they are, and JSON in front.
 * Source: Khronos, glTF 2.0 specification, sections 3.6 (binary data) and 4 (GLB).
 */
#ifndef PLAYER_SINKS_GLB_FILE_H
#define PLAYER_SINKS_GLB_FILE_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "common/json.h"

/* Each becomes a buffer view. */
typedef enum glb_section {
    SECTION_TRIANGLES,
    SECTION_POSITION,
    SECTION_NORMAL,
    SECTION_COLOUR,
    SECTION_UV,
    SECTION_VERTEX,
    SECTION_JOINTS,
    SECTION_SHARES,
    SECTION_MORPH,
    SECTION_SPARSE_INDEX,
    SECTION_SPARSE_VALUE,
    SECTION_BIND,
    SECTION_ANIMATION,
    SECTION_IMAGE,
    SECTION_COUNT
} glb_section;

/* Component types, by glTF's numbers. */
typedef enum glb_component { GLB_U8 = 5121, GLB_U16 = 5123, GLB_U32 = 5125, GLB_FLOAT = 5126 } glb_component;

typedef struct glb_bytes {
    uint8_t *data;
    size_t size, room;
} glb_bytes;

typedef struct glb_accessor {
    int section; /* -1: all zero but for what is sparse */
    size_t offset;
    uint32_t count;
    glb_component component;
    int width; /* 1 scalar, 2 to 4 vector, 16 matrix */
    int normalised, has_range;
    float least[3], most[3];
    uint32_t sparse_count;
    glb_component sparse_component;
    size_t sparse_index, sparse_value; /* offsets in their sections */
} glb_accessor;

typedef struct glb_file {
    glb_bytes section[SECTION_COUNT];
    glb_accessor *accessor;
    int accessor_count, accessor_room;
    int failed; /* no memory: everything after that is nothing */
} glb_file;

void glb_file_close(glb_file *g);

/* All return the accessor's number. Elements have @width components each. */
int glb_add_floats(glb_file *g, glb_section section, const float *value, uint32_t count, int width);
int glb_add_integers(glb_file *g, glb_section section, glb_component component, const uint32_t *value,
                     uint32_t count, int width, int normalised);
/* Vectors most of which are zero: those shorter than @least become so. The smaller of two ways to store them. */
int glb_add_motion(glb_file *g, const float (*value)[3], uint32_t count, float least);
/* A file as it is, for what has no accessor. */
void glb_add_bytes(glb_file *g, glb_section section, const uint8_t *data, size_t size);
/* Number of the section's buffer view, once everything has been added. */
int glb_view(const glb_file *g, int section);
/* The accessor tells least and most of @value, which it was made of. */
void glb_set_range(glb_file *g, int accessor, const float *value);

/* What the JSON must have of it: "buffers", "bufferViews", "accessors". */
void glb_put_json(const glb_file *g, json *j);
/* Header, JSON and binary chunk. @return 0 when writing failed. */
int glb_write(const glb_file *g, const char *text, size_t text_size, FILE *out);
/* Bytes that glb_write() will write. */
double glb_size(const glb_file *g, size_t text_size);

#endif
