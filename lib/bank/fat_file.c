/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The .fat file, as docs/fat.md describes it: little-endian numbers one after the other, a checksum at the end. Reader and
 * writer walk the same way; the reader believes no count before the bytes for it are there.
 */
#include <math.h>
#include <string.h>

#include "bank/fat.h"
#include "bank/format.h"
#include "base/mem.h"

#define FAT_MAGIC "\211FAPFAT\n"

enum { FAT_VERSION = 1, FAT_MAGIC_SIZE = 8, FAT_CRC_SIZE = 4 };

static const size_t size_max = (size_t)1 << 30;

/* --- reading --- */

typedef struct source {
    const uint8_t *at;
    size_t left;
    int bad;
} source;

static uint32_t take(source *s, int bytes)
{
    uint32_t v = 0;

    if (s->left < (size_t)bytes) {
        s->bad = 1;
        s->left = 0;
        return 0;
    }
    for (int i = 0; i < bytes; i++)
        v |= (uint32_t)s->at[i] << (8 * i);
    s->at += bytes;
    s->left -= (size_t)bytes;
    return v;
}

static float take_float(source *s)
{
    const uint32_t bits = take(s, 4);
    float v;

    memcpy(&v, &bits, sizeof v);
    if (!(fabsf(v) <= 10000)) /* ten metres is no face, and a NaN no number */
        s->bad = 1;
    return s->bad ? 0 : v;
}

/* A count of things of @p each bytes that must all still come. */
static uint32_t take_count(source *s, size_t each)
{
    const uint32_t n = take(s, 4);

    if (n > s->left / each)
        s->bad = 1;
    return s->bad ? 0 : n;
}

static uint32_t take_index(source *s, uint32_t end)
{
    const uint32_t v = take(s, 4);

    if (v >= end)
        s->bad = 1;
    return s->bad ? 0 : v;
}

static void require(source *s, int truth)
{
    if (!truth)
        s->bad = 1;
}

static fap_err load_neutral(source *s, fap_fat *fat)
{
    fat->vertex_count = take_count(s, 12);
    require(s, fat->vertex_count > 0 && fat->vertex_count <= FAT_VERTICES_MAX);
    if (s->bad)
        return FAP_E_DATA;
    fat->neutral = fap_mem_calloc(&fat->alloc, fat->vertex_count, sizeof *fat->neutral);
    if (!fat->neutral)
        return FAP_E_NOMEM;
    for (uint32_t v = 0; v < fat->vertex_count; v++)
        for (int axis = 0; axis < 3; axis++)
            fat->neutral[v][axis] = take_float(s);
    return s->bad ? FAP_E_DATA : FAP_OK;
}

static fap_err load_triangles(source *s, fap_fat *fat)
{
    fat->triangle_count = take_count(s, 12);
    require(s, fat->triangle_count <= FAT_TRIANGLES_MAX);
    if (s->bad)
        return FAP_E_DATA;
    fat->triangle = fap_mem_calloc(&fat->alloc, fat->triangle_count, 3 * sizeof *fat->triangle);
    if (!fat->triangle)
        return FAP_E_NOMEM;
    for (size_t i = 0; i < 3 * (size_t)fat->triangle_count; i++)
        fat->triangle[i] = take_index(s, fat->vertex_count);
    return s->bad ? FAP_E_DATA : FAP_OK;
}

static void load_borders(source *s, fat_table *t)
{
    int zero = 0;

    t->border_count = (uint8_t)take(s, 1);
    require(s, t->border_count >= 2 && t->border_count <= FAT_BORDERS_MAX);
    for (int k = 0; k < t->border_count && !s->bad; k++) {
        t->border[k] = (int32_t)take(s, 4);
        zero |= t->border[k] == 0;
        require(s, t->border[k] > -(1 << 24) && t->border[k] < 1 << 24 &&
                       (!k || t->border[k] > t->border[k - 1]));
    }
    require(s, zero);
}

static fap_err load_table(source *s, fap_fat *fat, fat_table *t)
{
    t->fap = (uint8_t)take(s, 1);
    t->select = (uint8_t)take(s, 1);
    require(s, t->fap >= 1 && t->fap <= FAP_COUNT);
    load_borders(s, t);
    t->scale_mm = take_float(s);
    require(s, t->scale_mm >= 0);
    t->vertex_count = take_count(s, 4 + 6 * (size_t)(s->bad ? 1 : t->border_count - 1));
    if (s->bad)
        return FAP_E_DATA;
    if (!fat_table_open(fat, t))
        return FAP_E_NOMEM;
    for (uint32_t i = 0; i < t->vertex_count; i++)
        t->vertex[i] = take_index(s, fat->vertex_count);
    for (size_t i = 0; i < (size_t)(t->border_count - 1) * t->vertex_count; i++)
        for (int axis = 0; axis < 3; axis++)
            t->slope[i][axis] = (int16_t)take(s, 2);
    return s->bad ? FAP_E_DATA : FAP_OK;
}

static fap_err load_turn(source *s, fap_fat *fat, fat_turn *t)
{
    t->fap = (uint8_t)take(s, 1);
    t->axis = (uint8_t)take(s, 1);
    require(s, t->fap >= 3 && t->fap <= FAP_COUNT && t->axis < 3);
    for (int axis = 0; axis < 3; axis++)
        t->pivot[axis] = take_float(s);
    t->radians = take_float(s);
    t->vertex_count = take_count(s, 5);
    if (s->bad)
        return FAP_E_DATA;
    if (!fat_turn_open(fat, t))
        return FAP_E_NOMEM;
    for (uint32_t i = 0; i < t->vertex_count; i++)
        t->vertex[i] = take_index(s, fat->vertex_count);
    for (uint32_t i = 0; i < t->vertex_count; i++)
        t->share[i] = (uint8_t)take(s, 1);
    return s->bad ? FAP_E_DATA : FAP_OK;
}

static void load_follow(source *s, fat_follow *f)
{
    f->fap = (uint8_t)take(s, 1);
    f->leader = (uint8_t)take(s, 1);
    f->share_1024 = (int16_t)take(s, 2);
    require(s, f->fap >= 3 && f->fap <= FAP_COUNT && f->leader >= 3 && f->leader <= FAP_COUNT);
}

static uint32_t take_limited(source *s, uint32_t most)
{
    const uint32_t n = take(s, 4);

    require(s, n <= most);
    return s->bad ? 0 : n;
}

static fap_err load_all(source *s, fap_fat *fat)
{
    fap_err err = load_neutral(s, fat);

    if (err == FAP_OK)
        err = load_triangles(s, fat);
    const uint32_t tables = err == FAP_OK ? take_limited(s, FAT_TABLES_MAX) : 0;

    while (err == FAP_OK && fat->table_count < tables)
        err = load_table(s, fat, &fat->table[fat->table_count++]);
    const uint32_t turns = err == FAP_OK ? take_limited(s, FAT_TURNS_MAX) : 0;
    while (err == FAP_OK && fat->turn_count < turns)
        err = load_turn(s, fat, &fat->turn[fat->turn_count++]);
    const uint32_t follows = err == FAP_OK ? take_limited(s, FAT_FOLLOW_MAX) : 0;
    while (fat->follow_count < follows)
        load_follow(s, &fat->follow[fat->follow_count++]);
    if (err == FAP_OK && (s->bad || s->left))
        err = FAP_E_DATA;
    return err;
}

fap_err fap_fat_load(fap_fat **fat, const void *data, size_t size, const fap_allocator *alloc)
{
    source s = { data, size, 0 };

    if (!fat)
        return FAP_E_ARG;
    *fat = NULL;
    if (!data)
        return FAP_E_ARG;
    if (size < FAT_MAGIC_SIZE || memcmp(data, FAT_MAGIC, FAT_MAGIC_SIZE) != 0)
        return FAP_E_UNKNOWN_FORMAT;
    if (size > size_max)
        return FAP_E_LIMIT;
    s.at += FAT_MAGIC_SIZE;
    s.left -= FAT_MAGIC_SIZE;
    if (take(&s, 4) != FAT_VERSION)
        return s.bad ? FAP_E_DATA : FAP_E_UNSUPPORTED;
    if (s.left < FAT_CRC_SIZE)
        return FAP_E_DATA;
    s.left -= FAT_CRC_SIZE;
    source end = { s.at + s.left, FAT_CRC_SIZE, 0 };
    if (take(&end, FAT_CRC_SIZE) != fbank_crc32(s.at, s.left))
        return FAP_E_DATA;

    fap_fat *f = fat_new(alloc);
    const fap_err err = f ? load_all(&s, f) : FAP_E_NOMEM;
    if (err != FAP_OK)
        fap_fat_close(&f);
    *fat = f;
    return err;
}

/* --- writing --- */

typedef struct sink {
    const fap_writer *out;
    uint8_t buffer[4096];
    size_t used;
    uint32_t crc; /* running, see fbank_crc32_add() */
    int failed;
} sink;

static void drain(sink *s)
{
    s->crc = fbank_crc32_add(s->crc, s->buffer, s->used);
    s->failed |= s->used && s->out->write(s->out->user, s->buffer, s->used) != 0;
    s->used = 0;
}

static void put(sink *s, int bytes, uint32_t v)
{
    if (s->used + 4 > sizeof s->buffer)
        drain(s);
    for (int i = 0; i < bytes; i++)
        s->buffer[s->used++] = (uint8_t)(v >> (8 * i));
}

static void put_float(sink *s, float v)
{
    uint32_t bits;

    memcpy(&bits, &v, sizeof bits);
    put(s, 4, bits);
}

static void put_mesh(sink *s, const fap_fat *fat)
{
    put(s, 4, fat->vertex_count);
    for (uint32_t v = 0; v < fat->vertex_count; v++)
        for (int axis = 0; axis < 3; axis++)
            put_float(s, fat->neutral[v][axis]);
    put(s, 4, fat->triangle_count);
    for (size_t i = 0; i < 3 * (size_t)fat->triangle_count; i++)
        put(s, 4, fat->triangle[i]);
}

static void put_table(sink *s, const fat_table *t)
{
    put(s, 1, t->fap);
    put(s, 1, t->select);
    put(s, 1, t->border_count);
    for (int k = 0; k < t->border_count; k++)
        put(s, 4, (uint32_t)t->border[k]);
    put_float(s, t->scale_mm);
    put(s, 4, t->vertex_count);
    for (uint32_t i = 0; i < t->vertex_count; i++)
        put(s, 4, t->vertex[i]);
    for (size_t i = 0; i < (size_t)(t->border_count - 1) * t->vertex_count; i++)
        for (int axis = 0; axis < 3; axis++)
            put(s, 2, (uint16_t)t->slope[i][axis]);
}

static void put_turn(sink *s, const fat_turn *t)
{
    put(s, 1, t->fap);
    put(s, 1, t->axis);
    for (int axis = 0; axis < 3; axis++)
        put_float(s, t->pivot[axis]);
    put_float(s, t->radians);
    put(s, 4, t->vertex_count);
    for (uint32_t i = 0; i < t->vertex_count; i++)
        put(s, 4, t->vertex[i]);
    for (uint32_t i = 0; i < t->vertex_count; i++)
        put(s, 1, t->share[i]);
}

static void put_follow(sink *s, const fat_follow *f)
{
    put(s, 1, f->fap);
    put(s, 1, f->leader);
    put(s, 2, (uint16_t)f->share_1024);
}

static int put_bytes(const fap_writer *out, const void *data, size_t size)
{
    return out->write(out->user, data, size);
}

fap_err fap_fat_write(const fap_fat *fat, const fap_writer *out)
{
    static const uint8_t version[4] = { FAT_VERSION };
    sink s = { .out = out };

    if (put_bytes(out, FAT_MAGIC, FAT_MAGIC_SIZE) || put_bytes(out, version, sizeof version))
        return FAP_E_IO;
    put_mesh(&s, fat);
    put(&s, 4, fat->table_count);
    for (uint32_t i = 0; i < fat->table_count; i++)
        put_table(&s, &fat->table[i]);
    put(&s, 4, fat->turn_count);
    for (uint32_t i = 0; i < fat->turn_count; i++)
        put_turn(&s, &fat->turn[i]);
    put(&s, 4, fat->follow_count);
    for (uint32_t i = 0; i < fat->follow_count; i++)
        put_follow(&s, &fat->follow[i]);
    drain(&s);
    put(&s, 4, s.crc);
    drain(&s);
    return s.failed ? FAP_E_IO : FAP_OK;
}
