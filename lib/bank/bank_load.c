/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * A .fbank file into a bank. The file is copied once into aligned memory and used in place; every count,
 * offset and index is checked first, so that posing needs no checks at all. Layout: docs/fbank.md.
 */
#include <math.h>
#include <string.h>

#include "bank/bank.h"
#include "bank/format.h"
#include "base/mem.h"

/* Remembers the first thing that was wrong; chunks asked for afterwards come back NULL. */
typedef struct loader {
    fap_bank *bank;
    uint8_t *data; /* the whole file, ours to change */
    size_t size;
    uint32_t chunk_count;
    uint32_t pool_count; /* point vertices in PVTX */
    uint32_t run_count;  /* blocks in KBLK */
    fap_err err;
} loader;

static uint32_t get32(const uint8_t *p)
{
    return p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}

static uint16_t get16(const uint8_t *p)
{
    return (uint16_t)(p[0] | p[1] << 8);
}

static float get_float(const uint8_t *p)
{
    const uint32_t bits = get32(p);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static int big_endian(void)
{
    const uint16_t probe = 1;
    return !*(const uint8_t *)&probe;
}

/* Little-endian elements of 2 or 4 bytes into the machine's own order, in place. */
static void to_native(uint8_t *p, size_t size, size_t element)
{
    if (!big_endian() || element == 1)
        return;
    for (size_t i = 0; i + element <= size; i += element)
        for (size_t k = 0; k < element / 2; k++) {
            const uint8_t t = p[i + k];
            p[i + k] = p[i + element - 1 - k];
            p[i + element - 1 - k] = t;
        }
}

static void fail(loader *l, fap_err err)
{
    if (!l->err)
        l->err = err;
}

static void require(loader *l, int truth)
{
    if (!truth)
        fail(l, FAP_E_DATA);
}

static const uint8_t *entry_of(const loader *l, const char *tag)
{
    for (uint32_t i = 0; i < l->chunk_count; i++) {
        const uint8_t *entry = l->data + FBANK_HEAD_SIZE + i * FBANK_ENTRY_SIZE;
        if (!memcmp(entry, tag, 4))
            return entry;
    }
    return NULL;
}

/* The chunk's bytes and size; NULL where the file has none, which is an error for those that must be. */
static uint8_t *chunk(loader *l, const char *tag, size_t *size)
{
    const uint8_t *entry = l->err ? NULL : entry_of(l, tag);

    *size = entry ? get32(entry + 8) : 0;
    return entry ? l->data + get32(entry + 4) : NULL;
}

/* A chunk that must be there with exactly @p count elements of @p element bytes, in the machine's byte order.
 */
static void *array(loader *l, const char *tag, size_t count, size_t element)
{
    size_t size;
    uint8_t *p = chunk(l, tag, &size);

    require(l, p && size == count * element);
    if (l->err)
        return NULL;
    to_native(p, size, element);
    return p;
}

static void check_entry(loader *l, uint32_t i)
{
    const uint8_t *entry = l->data + FBANK_HEAD_SIZE + i * FBANK_ENTRY_SIZE;
    const size_t offset = get32(entry + 4), size = get32(entry + 8);

    require(l, offset % FBANK_ALIGN == 0 &&
                   offset >= FBANK_HEAD_SIZE + (size_t)l->chunk_count * FBANK_ENTRY_SIZE);
    require(l, offset <= l->size && size <= l->size - offset);
    if (!l->err)
        require(l, fbank_crc32(l->data + offset, size) == get32(entry + 12));
    for (uint32_t k = 0; !l->err && k < i; k++) {
        const uint8_t *other = l->data + FBANK_HEAD_SIZE + k * FBANK_ENTRY_SIZE;
        const size_t start = get32(other + 4), end = start + get32(other + 8);
        require(l, memcmp(entry, other, 4) != 0 && (offset >= end || offset + size <= start));
    }
}

static void check_table(loader *l)
{
    const size_t table = (size_t)l->chunk_count * FBANK_ENTRY_SIZE;

    require(l, get32(l->data + 16) == l->size && l->chunk_count <= FBANK_MAX_CHUNKS);
    require(l, FBANK_HEAD_SIZE + table <= l->size);
    if (!l->err)
        require(l, fbank_crc32(l->data + FBANK_HEAD_SIZE, table) == get32(l->data + 20));
    for (uint32_t i = 0; !l->err && i < l->chunk_count; i++)
        check_entry(l, i);
}

/* Ten metres is no face; written so that a NaN is refused too. */
static int all_sane(const float *value, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (!(fabsf(value[i]) <= 10000))
            return 0;
    return 1;
}

static void load_name(loader *l)
{
    size_t size;
    const uint8_t *p = chunk(l, "NAME", &size);

    require(l, p && size < FAP_BANK_NAME_SIZE);
    if (!l->err)
        memcpy(l->bank->name, p, size);
}

static void load_counts(loader *l)
{
    const uint32_t *count = array(l, "HEAD", 6, 4);
    fap_mesh *m = &l->bank->mesh;

    if (l->err)
        return;
    if (count[0] > FBANK_MAX_VERTICES || count[1] > FBANK_MAX_TRIANGLES || count[2] > FBANK_MAX_KEYS ||
        count[3] > FBANK_MAX_VERTICES || count[4] > FBANK_MAX_SIZE)
        fail(l, FAP_E_LIMIT);
    require(l, count[0] > 0 && count[5] == FAP_POINT_COUNT);
    m->vertex_count = count[0];
    m->stride = (count[0] + FAP_BLOCK - 1) / FAP_BLOCK * FAP_BLOCK;
    m->triangle_count = count[1];
    l->bank->key_count = (int)count[2];
    l->pool_count = count[3];
    l->run_count = count[4];
}

static void check_parts(loader *l, const fap_mesh *m)
{
    for (uint32_t v = 0; !l->err && v < m->vertex_count; v++)
        require(l, m->part[v] < FAP_PART_COUNT);
}

static void check_triangles(loader *l, const fap_mesh *m)
{
    for (uint32_t t = 0; !l->err && t < m->triangle_count; t++) {
        const uint32_t *v = m->triangle + 3 * (size_t)t;
        require(l, v[0] < m->vertex_count && v[1] < m->vertex_count && v[2] < m->vertex_count);
        if (!l->err)
            require(l, m->part[v[0]] == m->part[v[1]] && m->part[v[0]] == m->part[v[2]]);
    }
}

static void load_mesh(loader *l)
{
    fap_mesh *m = &l->bank->mesh;
    const size_t stride = m->stride;
    size_t uv_size;

    m->position = array(l, "VPOS", 3 * stride, 4);
    m->part = array(l, "VPRT", stride, 1);
    m->head_weight = array(l, "VHDW", stride, 1);
    m->colour = array(l, "VCOL", 4 * stride, 1);
    m->triangle = array(l, "TRIS", 3 * (size_t)m->triangle_count, 4);
    if (!l->err && chunk(l, "VTUV", &uv_size))
        m->uv = array(l, "VTUV", 2 * stride, 4);
    if (l->err)
        return;
    require(l, all_sane(m->position, 3 * stride) && (!m->uv || all_sane(m->uv, 2 * stride)));
    check_parts(l, m);
    check_triangles(l, m);
}

static void load_fapu(loader *l)
{
    const float *f = array(l, "FAPU", 5, 4);

    if (!f)
        return;
    require(l, all_sane(f, 5));
    for (int i = 0; i < 5; i++)
        require(l, f[i] > 0);
    l->bank->fapu = (fap_fapu){ f[0], f[1], f[2], f[3], f[4] };
}

static void load_eyes(loader *l)
{
    const float *f = array(l, "EYES", 8, 4);

    if (!f)
        return;
    require(l, all_sane(f, 8) && f[3] >= 0 && f[7] >= 0);
    for (int right = 0; right < 2; right++) {
        memcpy(l->bank->eye[right].centre_mm, f + 4 * right, 3 * sizeof *f);
        l->bank->eye[right].radius_mm = f[4 * right + 3];
    }
}

static void load_point(loader *l, fap_bank_point *point, const uint8_t *record, const uint32_t *pool)
{
    const uint32_t present = get32(record), first = get32(record + 16), count = get32(record + 20);

    for (int axis = 0; axis < 3; axis++)
        point->position_mm[axis] = get_float(record + 4 + 4 * axis);
    require(l, present <= 1 && all_sane(point->position_mm, 3));
    require(l, first <= l->pool_count && count <= l->pool_count - first);
    point->present = (uint8_t)present;
    point->vertex_count = count;
    point->vertex = pool + first;
}

static void load_points(loader *l)
{
    const uint8_t *record = array(l, "PNTS", FAP_POINT_COUNT * FBANK_POINT_SIZE, 1);
    const uint32_t *pool = array(l, "PVTX", l->pool_count, 4);

    for (uint32_t i = 0; !l->err && i < l->pool_count; i++)
        require(l, pool[i] < l->bank->mesh.vertex_count);
    for (int p = 0; !l->err && p < FAP_POINT_COUNT; p++)
        load_point(l, &l->bank->point[p], record + p * FBANK_POINT_SIZE, pool);
}

static int number_fits(int kind, int number)
{
    switch (kind) {
    case FAP_KEY_VISEME: return number >= 1 && number <= FAP_VISEME_COUNT;
    case FAP_KEY_EXPRESSION: return number >= 1 && number <= FAP_EXPRESSION_COUNT;
    case FAP_KEY_EXTRA:
    case FAP_KEY_UNIT: return number == 0;
    default: return 0;
    }
}

static void check_blocks(loader *l, const fap_key *key)
{
    for (uint32_t b = 0; !l->err && b < key->block_count; b++) {
        require(l, key->block[b] < l->bank->mesh.stride / FAP_BLOCK);
        require(l, b == 0 || key->block[b] > key->block[b - 1]);
    }
}

static void load_key(loader *l, fap_key *key, const uint8_t *record, const uint16_t *block,
                     const int16_t *delta)
{
    const uint32_t first = get32(record + 36);

    key->name = (const char *)record;
    key->kind = record[FBANK_KEY_NAME];
    key->number = record[FBANK_KEY_NAME + 1];
    key->scale_mm = get_float(record + 40);
    key->block_count = get32(record + 44);
    require(l, memchr(record, 0, FBANK_KEY_NAME) && record[0] && number_fits(key->kind, key->number));
    require(l, key->scale_mm > 0 && key->scale_mm <= 1);
    require(l, get16(record + 34) == 0 && first <= l->run_count && key->block_count <= l->run_count - first);
    if (l->err)
        return;
    key->block = block + first;
    key->delta = delta + (size_t)first * 3 * FAP_BLOCK;
    check_blocks(l, key);
}

static void load_keys(loader *l)
{
    const size_t count = (size_t)l->bank->key_count;
    const uint8_t *record = array(l, "KEYS", count * FBANK_KEY_SIZE, 1);
    const uint16_t *block = array(l, "KBLK", l->run_count, 2);
    const int16_t *delta = array(l, "KDLT", (size_t)l->run_count * 3 * FAP_BLOCK, 2);
    const float(*points)[FAP_POINT_COUNT][3] = array(l, "KPNT", count * FAP_POINT_COUNT * 3, 4);

    if (l->err)
        return;
    require(l, all_sane(&points[0][0][0], count * FAP_POINT_COUNT * 3));
    l->bank->key = fap_bank_keep(l->bank, count, sizeof *l->bank->key);
    if (!l->bank->key)
        fail(l, FAP_E_NOMEM);
    for (size_t k = 0; !l->err && k < count; k++) {
        l->bank->key[k].point_mm = points[k];
        load_key(l, &l->bank->key[k], record + k * FBANK_KEY_SIZE, block, delta);
    }
}

static fap_err check_head(const uint8_t *data, size_t size)
{
    if (size < 8 || memcmp(data, FBANK_MAGIC, 8))
        return FAP_E_UNKNOWN_FORMAT;
    if (size < FBANK_HEAD_SIZE)
        return FAP_E_DATA;
    if (get16(data + 8) != FBANK_MAJOR)
        return FAP_E_UNSUPPORTED;
    return size > FBANK_MAX_SIZE ? FAP_E_LIMIT : FAP_OK;
}

static fap_err load(fap_bank *bank, const void *data, size_t size)
{
    loader l = { .bank = bank, .size = size, .data = fap_bank_keep(bank, size, 1) };

    if (!l.data)
        return FAP_E_NOMEM;
    memcpy(l.data, data, size);
    l.chunk_count = get32(l.data + 12);
    check_table(&l);
    load_name(&l);
    load_counts(&l);
    load_mesh(&l);
    load_fapu(&l);
    load_eyes(&l);
    load_points(&l);
    load_keys(&l);
    return l.err;
}

fap_err fap_bank_load(fap_bank **out, const void *data, size_t size, const fap_allocator *alloc)
{
    *out = NULL;
    fap_err err = check_head(data, size);
    if (err)
        return err;
    fap_bank *bank = fap_bank_new(alloc);
    if (!bank)
        return FAP_E_NOMEM;
    err = load(bank, data, size);
    if (err)
        fap_bank_close(&bank);
    *out = bank;
    return err;
}

/* Bytes read so far; grows by doubling. */
typedef struct buffer {
    uint8_t *data;
    size_t used, room;
} buffer;

static int grow(buffer *b, const fap_allocator *a)
{
    const size_t room = b->room ? 2 * b->room : 64 << 10;
    uint8_t *data = fap_mem_calloc(a, room, 1);

    if (!data)
        return 0;
    if (b->used)
        memcpy(data, b->data, b->used);
    fap_mem_free(a, b->data);
    b->data = data;
    b->room = room;
    return 1;
}

static fap_err read_all(buffer *b, const fap_reader *in, const fap_allocator *a)
{
    for (;;) {
        if (b->used == b->room && !grow(b, a))
            return FAP_E_NOMEM;
        const size_t want = b->room - b->used, n = in->read(in->user, b->data + b->used, want);
        if (n > want)
            return FAP_E_IO;
        if (n == 0)
            return FAP_OK;
        b->used += n;
        if (b->used > FBANK_MAX_SIZE)
            return FAP_E_LIMIT;
    }
}

fap_err fap_bank_read(fap_bank **out, const fap_reader *in, const fap_allocator *alloc)
{
    const fap_allocator a = fap_mem_allocator(alloc);
    buffer b = { 0 };

    *out = NULL;
    fap_err err = read_all(&b, in, &a);
    if (!err)
        err = fap_bank_load(out, b.data, b.used, alloc);
    fap_mem_free(&a, b.data);
    return err;
}
