/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Writes a take as C3D, in the byte order and number format asked for. The parameter section is built in
 * memory, since its length stands in the header; samples are streamed a frame at a time. Source: the C3D file
 * format as described at c3d.org.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include <fap/studio/take.h>

#include "base/mem.h"
#include "take/c3d.h"

enum {
    MAX_PARAMETER_BLOCKS = 255,
    GROUP_POINT = 1,
    GROUP_TRIAL = 2,
    TYPE_CHAR = -1,
    TYPE_INT = 2,
    TYPE_FLOAT = 4
};

/* Bytes in the making; what does not fit is noted, not written. */
typedef struct c3d_bytes {
    uint8_t *data;
    size_t size, room;
    fap_c3d_processor processor;
    int full;
} c3d_bytes;

static void put_byte(c3d_bytes *b, unsigned v)
{
    if (b->size < b->room)
        b->data[b->size++] = (uint8_t)v;
    else
        b->full = 1;
}

static void put_u16(c3d_bytes *b, unsigned v)
{
    const int big = b->processor == FAP_C3D_SGI;

    put_byte(b, big ? v >> 8 : v);
    put_byte(b, big ? v : v >> 8);
}

/* VAX F: four times the value, IEEE, with the halves swapped. */
static void put_float(c3d_bytes *b, float v)
{
    const float stored = b->processor == FAP_C3D_DEC ? v * 4 : v;
    uint32_t bits;

    memcpy(&bits, &stored, sizeof bits);
    put_u16(b, b->processor == FAP_C3D_INTEL ? bits & 0xffff : bits >> 16);
    put_u16(b, b->processor == FAP_C3D_INTEL ? bits >> 16 : bits & 0xffff);
}

static void put_text(c3d_bytes *b, const char *text, size_t width)
{
    const size_t length = strlen(text);

    for (size_t i = 0; i < width; i++)
        put_byte(b, i < length ? (uint8_t)text[i] : ' ');
}

static void put_group(c3d_bytes *b, int group, const char *name)
{
    put_byte(b, (unsigned)strlen(name));
    put_byte(b, (unsigned)-group);
    put_text(b, name, strlen(name));
    put_u16(b, 3); /* to the next record, counted from here: this word and the empty description */
    put_byte(b, 0);
}

/* Everything of a parameter up to its data. @p columns 0: a scalar; @p rows 0: one dimension. */
static void put_parameter(c3d_bytes *b, int group, const char *name, int type, unsigned columns,
                          unsigned rows)
{
    const unsigned dimensions = columns ? rows ? 2 : 1 : 0;
    const unsigned elements = (columns ? columns : 1) * (rows ? rows : 1);

    put_byte(b, (unsigned)strlen(name));
    put_byte(b, (unsigned)group);
    put_text(b, name, strlen(name));
    put_u16(b, 2 + 1 + 1 + dimensions + elements * (unsigned)(type < 0 ? 1 : type) + 1);
    put_byte(b, (unsigned)type);
    put_byte(b, dimensions);
    if (columns)
        put_byte(b, columns);
    if (columns && rows)
        put_byte(b, rows);
}

static void put_int_parameter(c3d_bytes *b, const char *name, unsigned v)
{
    put_parameter(b, GROUP_POINT, name, TYPE_INT, 0, 0);
    put_u16(b, v);
    put_byte(b, 0);
}

static void put_float_parameter(c3d_bytes *b, const char *name, float v)
{
    put_parameter(b, GROUP_POINT, name, TYPE_FLOAT, 0, 0);
    put_float(b, v);
    put_byte(b, 0);
}

static void put_text_parameter(c3d_bytes *b, const char *name, const char *text)
{
    put_parameter(b, GROUP_POINT, name, TYPE_CHAR, (unsigned)strlen(text), 0);
    put_text(b, text, strlen(text));
    put_byte(b, 0);
}

static void put_long_parameter(c3d_bytes *b, const char *name, uint32_t v)
{
    put_parameter(b, GROUP_TRIAL, name, TYPE_INT, 2, 0);
    put_u16(b, v & 0xffff);
    put_u16(b, v >> 16);
    put_byte(b, 0);
}

static size_t longest_name(const fap_take *take)
{
    size_t longest = 1;

    for (uint32_t p = 0; p < take->point_count; p++)
        longest = strlen(take->name[p]) > longest ? strlen(take->name[p]) : longest;
    return longest;
}

static void put_labels(c3d_bytes *b, const fap_take *take)
{
    const size_t width = longest_name(take);

    for (uint32_t first = 0, part = 1; first < take->point_count; first += 255, part++) {
        const uint32_t left = take->point_count - first, rows = left < 255 ? left : 255;
        char name[16];
        snprintf(name, sizeof name, part == 1 ? "LABELS" : "LABELS%u", (unsigned)part);
        put_parameter(b, GROUP_POINT, name, TYPE_CHAR, (unsigned)width, rows);
        for (uint32_t p = first; p < first + rows; p++)
            put_text(b, take->name[p], width);
        put_byte(b, 0);
    }
}

/* One written count in file units: negative says that the points are floats. */
static float point_scale(const fap_take *take, int integer)
{
    const size_t samples = (size_t)take->frame_count * take->point_count;
    float largest = 1;

    for (size_t i = 0; i < samples; i++)
        for (int axis = 0; axis < 3; axis++)
            largest = fmaxf(largest, fabsf(take->xyz[i][axis]));
    return (integer ? 1.0f : -1.0f) * largest / 32000;
}

static void put_parameters(c3d_bytes *b, const fap_take *take, float scale, unsigned blocks)
{
    b->size = 0;
    put_byte(b, 1);
    put_byte(b, C3D_KEY);
    put_byte(b, blocks);
    put_byte(b, (unsigned)b->processor);
    put_group(b, GROUP_POINT, "POINT");
    put_int_parameter(b, "USED", take->point_count);
    put_int_parameter(b, "FRAMES", take->frame_count < 65535 ? take->frame_count : 65535);
    put_int_parameter(b, "DATA_START", 2 + blocks);
    put_float_parameter(b, "SCALE", scale);
    put_float_parameter(b, "RATE", (float)take->rate_hz);
    put_text_parameter(b, "UNITS", "mm");
    if (*take->screen[0] && *take->screen[1]) {
        put_text_parameter(b, "X_SCREEN", take->screen[0]);
        put_text_parameter(b, "Y_SCREEN", take->screen[1]);
    }
    put_labels(b, take);
    put_group(b, GROUP_TRIAL, "TRIAL");
    put_long_parameter(b, "ACTUAL_START_FIELD", 1);
    put_long_parameter(b, "ACTUAL_END_FIELD", take->frame_count);
    put_u16(b, 0);
    while (b->size % C3D_BLOCK && !b->full)
        put_byte(b, 0);
}

static void put_header(c3d_bytes *b, const fap_take *take, float scale, size_t parameter_blocks)
{
    put_byte(b, 2);
    put_byte(b, C3D_KEY);
    put_u16(b, take->point_count);
    put_u16(b, 0);
    put_u16(b, 1);
    put_u16(b, take->frame_count < 65535 ? take->frame_count : 65535);
    put_u16(b, 0);
    put_float(b, scale);
    put_u16(b, (unsigned)(2 + parameter_blocks));
    put_u16(b, 0);
    put_float(b, (float)take->rate_hz);
    while (b->size < C3D_BLOCK)
        put_byte(b, 0);
}

static void put_float_point(c3d_bytes *b, const float *v)
{
    for (int axis = 0; axis < 3; axis++)
        put_float(b, v ? v[axis] : 0);
    put_float(b, v ? 0.0f : -1.0f);
}

static void put_integer_point(c3d_bytes *b, const float *v, float scale)
{
    for (int axis = 0; axis < 3; axis++)
        put_u16(b, v ? (unsigned)lrintf(v[axis] / scale) & 0xffff : 0);
    put_u16(b, v ? 0 : 0xffff);
}

static fap_err flush(c3d_bytes *b, const fap_writer *out)
{
    const int failed = out->write(out->user, b->data, b->size);

    b->size = 0;
    return failed ? FAP_E_IO : FAP_OK;
}

static fap_err write_samples(c3d_bytes *b, const fap_take *take, float scale, const fap_writer *out)
{
    size_t total = 0;

    for (uint32_t f = 0; f < take->frame_count; f++) {
        for (uint32_t p = 0; p < take->point_count; p++) {
            const float *v = fap_take_sample(take, f, p);
            if (scale < 0)
                put_float_point(b, v);
            else
                put_integer_point(b, v, scale);
        }
        total += b->size;
        const fap_err err = flush(b, out);
        if (err != FAP_OK)
            return err;
    }
    while (total++ % C3D_BLOCK)
        put_byte(b, 0);
    return flush(b, out);
}

static fap_err write_all(c3d_bytes *b, const fap_take *take, int integer, const fap_writer *out)
{
    uint8_t head[C3D_BLOCK];
    c3d_bytes h = { head, 0, sizeof head, b->processor, 0 };
    const float scale = point_scale(take, integer);

    /* The section states its own length: the first pass finds it. */
    put_parameters(b, take, scale, 0);
    put_parameters(b, take, scale, (unsigned)(b->size / C3D_BLOCK));
    if (b->full)
        return FAP_E_LIMIT;
    put_header(&h, take, scale, b->size / C3D_BLOCK);
    const fap_err err = flush(&h, out);
    if (err != FAP_OK)
        return err;
    const fap_err parameters = flush(b, out);
    return parameters != FAP_OK ? parameters : write_samples(b, take, scale, out);
}

fap_err fap_take_write_c3d(const fap_take *take, const fap_writer *out, fap_c3d_processor processor,
                           int integer)
{
    c3d_bytes b = { .room = (size_t)MAX_PARAMETER_BLOCKS * C3D_BLOCK, .processor = processor };

    if (processor < FAP_C3D_INTEL || processor > FAP_C3D_SGI)
        return FAP_E_ARG;
    b.data = fap_mem_calloc(&take->alloc, b.room, 1);
    if (!b.data)
        return FAP_E_NOMEM;
    const fap_err err = write_all(&b, take, integer, out);
    fap_mem_free(&take->alloc, b.data);
    return err;
}
