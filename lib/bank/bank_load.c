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

static void check_blocks(loader *l, const uint16_t *block, uint32_t count)
{
    for (uint32_t b = 0; !l->err && b < count; b++) {
        require(l, block[b] < l->bank->mesh.stride / FAP_BLOCK);
        require(l, b == 0 || block[b] > block[b - 1]);
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
    check_blocks(l, key->block, key->block_count);
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

/* --- chunks of version 1.1: each may be absent --- */

static int has(loader *l, const char *tag)
{
    size_t size;

    return chunk(l, tag, &size) != NULL;
}

static void load_regions(loader *l)
{
    const size_t head = FBANK_REGION_HEAD / sizeof(float), count = head + 2 * (size_t)l->bank->mesh.stride;
    fap_region_lines *r = &l->bank->regions;

    if (!has(l, "REGN"))
        return;
    const float *f = array(l, "REGN", count, sizeof *f);
    if (!f)
        return;
    require(l, all_sane(f, count) && f[2] >= 0 && f[3] >= 0);
    for (size_t i = 4; i < head; i++)
        require(l, f[i] == 0);
    *r = (fap_region_lines){ { f[0], f[1] }, { f[2], f[3] }, f + head };
}

static void load_masks(loader *l)
{
    if (!has(l, "MASK"))
        return;
    l->bank->mask = array(l, "MASK", l->bank->mesh.stride, 1);
    for (uint32_t v = 0; !l->err && v < l->bank->mesh.stride; v++)
        require(l, l->bank->mask[v] <= FAP_MASK_ALL);
}

/* Arrays that components are cut out of. */
typedef struct basis_arrays {
    uint8_t *record;
    uint32_t run_count;
    const uint32_t *model;
    const float *mix, (*points)[FAP_POINT_COUNT][3];
    const uint16_t *block;
    const int16_t *delta;
} basis_arrays;

static void load_models(loader *l, const fap_basis *basis)
{
    const uint32_t keys = (uint32_t)l->bank->key_count;

    for (int i = 0; !l->err && i < basis->model_count; i++) {
        const uint32_t *m = &basis->model[i];
        require(l, i == 0 ? *m == FAP_MODEL_NEUTRAL : *m < keys && (i == 1 || *m > m[-1]));
    }
}

static void load_basis_arrays(loader *l, fap_basis *basis, basis_arrays *a)
{
    const size_t shapes = (size_t)basis->component_count + 1, models = (size_t)basis->model_count;

    basis->model = array(l, "PCAM", models, 4);
    a->mix = array(l, "PCAW", (shapes - 1) * models, 4);
    a->points = array(l, "PCAP", shapes * FAP_POINT_COUNT * 3, 4);
    a->block = array(l, "PCAB", a->run_count, 2);
    a->delta = array(l, "PCAD", (size_t)a->run_count * 3 * FAP_BLOCK, 2);
    if (l->err)
        return;
    require(l, all_sane(&a->points[0][0][0], shapes * FAP_POINT_COUNT * 3));
    for (size_t i = 0; i < (shapes - 1) * models; i++)
        require(l,
                fabsf(a->mix[i]) <= 1); /* entries of a unit vector, over the root of the number of models */
    load_models(l, basis);
}

/* The mean comes first; it has no numbers of its own. */
static void load_component(loader *l, fap_component *c, const basis_arrays *a, size_t shape, size_t models)
{
    const uint8_t *record = a->record + shape * FBANK_BASIS_SIZE;
    const uint32_t first = get32(record + 16);

    c->sigma_mm = get_float(record);
    c->ratio = get_float(record + 4);
    c->rest = get_float(record + 8);
    c->scale_mm = get_float(record + 12);
    c->block_count = get32(record + 20);
    const float numbers[] = { c->sigma_mm, c->ratio, c->rest };
    require(l, fabsf(c->sigma_mm) <= 1e6f && all_sane(numbers + 1, 2) && c->scale_mm > 0 && c->scale_mm <= 1);
    require(l, shape ? c->sigma_mm > 0 && c->ratio >= 0 && c->ratio <= 1
                     : c->sigma_mm == 0 && c->ratio == 0 && c->rest == 0);
    require(l, get32(record + 24) == 0 && get32(record + 28) == 0);
    require(l, first <= a->run_count && c->block_count <= a->run_count - first);
    if (l->err)
        return;
    c->block = a->block + first;
    c->delta = a->delta + (size_t)first * 3 * FAP_BLOCK;
    c->point_mm = a->points[shape];
    c->mix = shape ? a->mix + (shape - 1) * models : NULL;
    check_blocks(l, c->block, c->block_count);
}

static void load_components(loader *l, fap_basis *basis, const basis_arrays *a)
{
    const size_t count = (size_t)basis->component_count, models = (size_t)basis->model_count;
    fap_component *c = l->err ? NULL : fap_bank_keep(l->bank, count, sizeof *c);

    if (!l->err && !c)
        fail(l, FAP_E_NOMEM);
    if (!l->err)
        load_component(l, &basis->mean, a, 0, models);
    for (size_t i = 0; !l->err && i < count; i++) {
        load_component(l, &c[i], a, i + 1, models);
        require(l, i == 0 || (c[i].sigma_mm <= c[i - 1].sigma_mm && c[i].ratio >= c[i - 1].ratio));
    }
    basis->component = c;
}

static void load_basis(loader *l)
{
    fap_basis *basis = &l->bank->basis;
    basis_arrays a = { 0 };
    size_t size;

    uint8_t *head = chunk(l, "PCAC", &size);
    if (!head)
        return;
    require(l, size >= FBANK_BASIS_HEAD);
    if (l->err)
        return;
    const uint32_t components = get32(head), models = get32(head + 4);
    if (components > FBANK_MAX_COMPONENTS || models > FBANK_MAX_MODELS || get32(head + 8) > FBANK_MAX_SIZE)
        fail(l, FAP_E_LIMIT);
    require(l, components > 0 && models > 1 && get32(head + 12) == 0);
    require(l, size == FBANK_BASIS_HEAD + (size_t)(components + 1) * FBANK_BASIS_SIZE);
    if (l->err)
        return;
    basis->component_count = (int)components;
    basis->model_count = (int)models;
    a.record = head + FBANK_BASIS_HEAD;
    a.run_count = get32(head + 8);
    load_basis_arrays(l, basis, &a);
    load_components(l, basis, &a);
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
    load_regions(&l);
    load_masks(&l);
    load_basis(&l);
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
