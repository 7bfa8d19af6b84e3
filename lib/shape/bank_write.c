/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The builder of databanks: collects floats, then orders the vertices, quantises the motions and writes the
 * chunks. Layout: docs/fbank.md; shared constants: lib/bank/format.h.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <fap/studio/bank_build.h>

#include "bank/format.h"
#include "bank/mask.h"
#include "bank/pack.h"
#include "bank/pca.h"
#include "bank/recipe.h"
#include "bank/region.h"
#include "base/mem.h"
#include "shape/bytes.h"

typedef struct build_key {
    char name[FBANK_KEY_NAME];
    fap_key_kind kind;
    int number;
    float (*delta)[3];
} build_key;

typedef struct build_point {
    uint8_t present;
    float position[3];
    uint32_t count, *vertex;
} build_point;

struct fap_bank_builder {
    char name[64];
    uint32_t vertex_count, triangle_count;
    float (*position)[3], (*uv)[2];
    uint8_t *part, *head_weight, (*colour)[4];
    uint32_t (*triangle)[3];
    build_point point[FAP_POINT_COUNT];
    float eye[2][4];
    int key_count;
    build_key *key;   /* FBANK_MAX_KEYS, of which key_count are used */
    uint8_t *mask;    /* NULL: to be derived */
    float (*from)[2]; /* NULL: to be derived, and the lines with it */
    fap_region_lines lines;
    int components; /* 0: no basis */
};

/* --- collecting --- */

static void *copy_of(const void *data, size_t count, size_t size)
{
    void *p = malloc(count * size + 1);
    return p ? memcpy(p, data, count * size) : NULL;
}

static int sane(const float (*v)[3], uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        for (int axis = 0; axis < 3; axis++)
            if (!(fabsf(v[i][axis]) <= 10000))
                return 0;
    return 1;
}

static fap_err check_mesh(const fap_build_mesh *m)
{
    if (m->vertex_count > FBANK_MAX_VERTICES || m->triangle_count > FBANK_MAX_TRIANGLES)
        return FAP_E_LIMIT;
    if (!m->vertex_count || !sane(m->position, m->vertex_count))
        return FAP_E_DATA;
    for (uint32_t v = 0; v < m->vertex_count; v++)
        if (m->part[v] >= FAP_PART_COUNT)
            return FAP_E_DATA;
    for (uint32_t t = 0; t < m->triangle_count; t++)
        for (int i = 0; i < 3; i++)
            if (m->triangle[t][i] >= m->vertex_count ||
                m->part[m->triangle[t][i]] != m->part[m->triangle[t][0]])
                return FAP_E_DATA;
    return FAP_OK;
}

static int copy_mesh(fap_bank_builder *b, const fap_build_mesh *m)
{
    b->vertex_count = m->vertex_count;
    b->triangle_count = m->triangle_count;
    b->position = copy_of(m->position, m->vertex_count, sizeof *m->position);
    b->uv = m->uv ? copy_of(m->uv, m->vertex_count, sizeof *m->uv) : NULL;
    b->part = copy_of(m->part, m->vertex_count, 1);
    b->head_weight = copy_of(m->head_weight, m->vertex_count, 1);
    b->colour = copy_of(m->colour, m->vertex_count, sizeof *m->colour);
    b->triangle = copy_of(m->triangle, m->triangle_count, sizeof *m->triangle);
    b->key = calloc(FBANK_MAX_KEYS, sizeof *b->key);
    return b->position && (b->uv || !m->uv) && b->part && b->head_weight && b->colour && b->triangle &&
           b->key;
}

fap_err fap_bank_builder_open(fap_bank_builder **out, const char *name, const fap_build_mesh *mesh)
{
    *out = NULL;
    const fap_err err = check_mesh(mesh);
    if (err)
        return err;
    fap_bank_builder *b = calloc(1, sizeof *b);
    if (!b || !copy_mesh(b, mesh)) {
        fap_bank_builder_close(&b);
        return FAP_E_NOMEM;
    }
    strncpy(b->name, name, sizeof b->name - 1);
    *out = b;
    return FAP_OK;
}

void fap_bank_builder_close(fap_bank_builder **b)
{
    if (!b || !*b)
        return;
    for (int k = 0; k < (*b)->key_count; k++)
        free((*b)->key[k].delta);
    for (int p = 0; p < FAP_POINT_COUNT; p++)
        free((*b)->point[p].vertex);
    free((*b)->position);
    free((*b)->uv);
    free((*b)->part);
    free((*b)->head_weight);
    free((*b)->colour);
    free((*b)->triangle);
    free((*b)->key);
    free((*b)->mask);
    free((*b)->from);
    free(*b);
    *b = NULL;
}

static void mean_of(const float (*v)[3], const uint32_t *vertex, uint32_t count, float out[3])
{
    memset(out, 0, 3 * sizeof *out);
    for (uint32_t i = 0; i < count; i++)
        for (int axis = 0; axis < 3; axis++)
            out[axis] += v[vertex[i]][axis] / (float)count;
}

fap_err fap_bank_builder_point(fap_bank_builder *b, int point, const uint32_t *vertex, uint32_t count)
{
    if (point < 0 || point >= FAP_POINT_COUNT || !count || count > b->vertex_count)
        return FAP_E_ARG;
    for (uint32_t i = 0; i < count; i++)
        if (vertex[i] >= b->vertex_count)
            return FAP_E_ARG;
    build_point *p = &b->point[point];
    free(p->vertex);
    *p = (build_point){ 1, { 0 }, count, copy_of(vertex, count, sizeof *vertex) };
    if (!p->vertex) {
        *p = (build_point){ 0 };
        return FAP_E_NOMEM;
    }
    mean_of((const float(*)[3])b->position, vertex, count, p->position);
    return FAP_OK;
}

fap_err fap_bank_builder_place(fap_bank_builder *b, int point, const float position_mm[3])
{
    if (point < 0 || point >= FAP_POINT_COUNT || !sane((const float(*)[3])position_mm, 1))
        return FAP_E_ARG;
    free(b->point[point].vertex);
    b->point[point] = (build_point){ 1, { position_mm[0], position_mm[1], position_mm[2] }, 0, NULL };
    return FAP_OK;
}

void fap_bank_builder_eye(fap_bank_builder *b, int right, const float centre_mm[3], float radius_mm)
{
    memcpy(b->eye[right != 0], centre_mm, 3 * sizeof *centre_mm);
    b->eye[right != 0][3] = radius_mm;
}

void fap_bank_builder_colours(fap_bank_builder *b, const uint8_t (*colour)[4])
{
    memcpy(b->colour, colour, b->vertex_count * sizeof *colour);
}

fap_err fap_bank_builder_masks(fap_bank_builder *b, const uint8_t *mask)
{
    for (uint32_t v = 0; v < b->vertex_count; v++)
        if (mask[v] > FAP_MASK_ALL)
            return FAP_E_ARG;
    free(b->mask);
    b->mask = copy_of(mask, b->vertex_count, 1);
    return b->mask ? FAP_OK : FAP_E_NOMEM;
}

fap_err fap_bank_builder_regions(fap_bank_builder *b, const fap_region_lines *lines, uint32_t stride)
{
    float(*from)[2] = malloc(b->vertex_count * sizeof *from);

    if (!from)
        return FAP_E_NOMEM;
    for (uint32_t v = 0; v < b->vertex_count; v++)
        for (uint32_t axis = 0; axis < 2; axis++)
            from[v][axis] = lines->from[axis * (size_t)stride + v];
    free(b->from);
    b->from = from;
    b->lines = *lines;
    return FAP_OK;
}

fap_err fap_bank_builder_basis(fap_bank_builder *b, int components)
{
    if (components < 0 || components > FBANK_MAX_COMPONENTS)
        return FAP_E_ARG;
    b->components = components;
    return FAP_OK;
}

static int number_fits(fap_key_kind kind, int number)
{
    return kind == FAP_KEY_VISEME       ? number >= 1 && number <= FAP_VISEME_COUNT
           : kind == FAP_KEY_EXPRESSION ? number >= 1 && number <= FAP_EXPRESSION_COUNT
                                        : number == 0;
}

static build_key *find_key(fap_bank_builder *b, fap_key_kind kind, int number, const char *name)
{
    for (int k = 0; k < b->key_count; k++)
        if (b->key[k].kind == kind && b->key[k].number == number && (number || !strcmp(b->key[k].name, name)))
            return &b->key[k];
    return NULL;
}

fap_err fap_bank_builder_key(fap_bank_builder *b, fap_key_kind kind, int number, const char *name,
                             const float (*delta)[3])
{
    if (!name[0] || strlen(name) >= FBANK_KEY_NAME || !number_fits(kind, number))
        return FAP_E_ARG;
    if (!sane(delta, b->vertex_count))
        return FAP_E_DATA;
    build_key *k = find_key(b, kind, number, name);
    if (!k && b->key_count == FBANK_MAX_KEYS)
        return FAP_E_LIMIT;
    float(*copied)[3] = copy_of(delta, b->vertex_count, sizeof *delta);
    if (!copied)
        return FAP_E_NOMEM;
    if (k)
        free(k->delta);
    else
        k = &b->key[b->key_count++];
    *k = (build_key){ .kind = kind, .number = number, .delta = copied };
    strcpy(k->name, name);
    return FAP_OK;
}

void fap_bank_builder_forget_keys(fap_bank_builder *b)
{
    while (b->key_count)
        free(b->key[--b->key_count].delta);
}

static const build_key *find_unit(const fap_bank_builder *b, const char *name)
{
    for (int k = 0; k < b->key_count; k++)
        if (b->key[k].kind == FAP_KEY_UNIT && !strcmp(b->key[k].name, name))
            return &b->key[k];
    return NULL;
}

static void blend_in(const fap_bank_builder *b, const fap_recipe_row *r, float (*sum)[3])
{
    const build_key *unit = find_unit(b, r->unit);

    for (uint32_t v = 0; unit && v < b->vertex_count; v++)
        for (int axis = 0; axis < 3; axis++)
            sum[v][axis] += r->weight * unit->delta[v][axis];
}

fap_err fap_bank_builder_models(fap_bank_builder *b)
{
    float(*sum)[3] = calloc(b->vertex_count, sizeof *sum);
    fap_recipe_row r;
    fap_err err = sum ? FAP_OK : FAP_E_NOMEM;

    for (int i = 0; !err && fap_recipe_get(i, &r); i++) {
        blend_in(b, &r, sum);
        if (!r.last)
            continue;
        if (!find_key(b, r.kind, r.number, r.name))
            err = fap_bank_builder_key(b, r.kind, r.number, r.name, (const float(*)[3])sum);
        memset(sum, 0, b->vertex_count * sizeof *sum);
    }
    free(sum);
    return err;
}

/* --- order --- */

/*
 * Which keys move a vertex, as bits, decides its place: vertices that move together share blocks, the rest of
 * the blocks can be left out. Parts stay whole; among equals those of one height are neighbours.
 */
typedef struct ranked {
    uint32_t vertex;
    uint8_t part;
    uint64_t moved[2];
    float height;
} ranked;

static int by_rank(const void *x, const void *y)
{
    const ranked *a = x, *b = y;

    if (a->part != b->part)
        return a->part < b->part ? -1 : 1;
    for (int i = 0; i < 2; i++)
        if (a->moved[i] != b->moved[i])
            return a->moved[i] > b->moved[i] ? -1 : 1;
    if (a->height != b->height)
        return a->height > b->height ? -1 : 1;
    return a->vertex < b->vertex ? -1 : a->vertex > b->vertex;
}

static int moves(const float d[3])
{
    return fabsf(d[0]) > FAP_PACK_STILL_MM || fabsf(d[1]) > FAP_PACK_STILL_MM ||
           fabsf(d[2]) > FAP_PACK_STILL_MM;
}

static void rank(const fap_bank_builder *b, uint32_t v, ranked *r)
{
    *r = (ranked){ v, b->part[v], { 0, 0 }, b->position[v][1] };
    for (int k = 0, bit = 0; k < b->key_count && bit < 128; k++)
        if (b->key[k].kind == FAP_KEY_UNIT) {
            r->moved[bit / 64] |= (uint64_t)moves(b->key[k].delta[v]) << (63 - bit % 64);
            bit++;
        }
}

/* order[new] = old, place[old] = new. */
static int sort_vertices(const fap_bank_builder *b, uint32_t *order, uint32_t *place)
{
    ranked *r = malloc(b->vertex_count * sizeof *r);

    if (!r)
        return 0;
    for (uint32_t v = 0; v < b->vertex_count; v++)
        rank(b, v, &r[v]);
    qsort(r, b->vertex_count, sizeof *r, by_rank);
    for (uint32_t v = 0; v < b->vertex_count; v++) {
        order[v] = r[v].vertex;
        place[r[v].vertex] = v;
    }
    free(r);
    return 1;
}

/* --- chunks --- */

enum chunk_id {
    C_NAME,
    C_HEAD,
    C_VPOS,
    C_VPRT,
    C_VHDW,
    C_VCOL,
    C_VTUV,
    C_TRIS,
    C_FAPU,
    C_EYES,
    C_PNTS,
    C_PVTX,
    C_KEYS,
    C_KBLK,
    C_KDLT,
    C_KPNT,
    C_REGN,
    C_MASK,
    C_PCAC,
    C_PCAM,
    C_PCAW,
    C_PCAP,
    C_PCAB,
    C_PCAD,
    C_COUNT
};

static const char tags[C_COUNT][5] = { "NAME", "HEAD", "VPOS", "VPRT", "VHDW", "VCOL", "VTUV", "TRIS",
                                       "FAPU", "EYES", "PNTS", "PVTX", "KEYS", "KBLK", "KDLT", "KPNT",
                                       "REGN", "MASK", "PCAC", "PCAM", "PCAW", "PCAP", "PCAB", "PCAD" };

typedef struct image {
    const fap_bank_builder *b;
    uint32_t stride, *order, *place, run_count, pool_count;
    fap_bytes chunk[C_COUNT];
    float *motion; /* one key in the new order: x[stride] y[stride] z[stride] */
    uint16_t *block;
    int16_t *delta;
} image;

static void put_mesh(image *m)
{
    const fap_bank_builder *b = m->b;

    for (int axis = 0; axis < 3; axis++)
        for (uint32_t v = 0; v < m->stride; v++)
            fap_bytes_float(&m->chunk[C_VPOS], v < b->vertex_count ? b->position[m->order[v]][axis] : 0);
    for (uint32_t v = 0; v < m->stride; v++) {
        const int real = v < b->vertex_count;
        const uint32_t old = real ? m->order[v] : 0;
        fap_bytes_8(&m->chunk[C_VPRT], real ? b->part[old] : 0);
        fap_bytes_8(&m->chunk[C_VHDW], real ? b->head_weight[old] : 0);
        for (int i = 0; i < 4; i++)
            fap_bytes_8(&m->chunk[C_VCOL], real ? b->colour[old][i] : 0);
        for (int i = 0; b->uv && i < 2; i++)
            fap_bytes_float(&m->chunk[C_VTUV], real ? b->uv[old][i] : 0);
    }
    for (uint32_t t = 0; t < b->triangle_count; t++)
        for (int i = 0; i < 3; i++)
            fap_bytes_32(&m->chunk[C_TRIS], m->place[b->triangle[t][i]]);
}

static fap_err put_fapu(image *m)
{
    float points[FAP_POINT_COUNT][3];
    fap_fapu u;

    for (int p = 0; p < FAP_POINT_COUNT; p++)
        memcpy(points[p], m->b->point[p].position, sizeof points[p]);
    const fap_err err = fap_fapu_measure((const float(*)[3])points, &u);
    if (err)
        return err;
    const float values[] = { u.irisd_mm, u.es_mm, u.ens_mm, u.mns_mm, u.mw_mm };
    for (int i = 0; i < 5; i++)
        fap_bytes_float(&m->chunk[C_FAPU], values[i]);
    return FAP_OK;
}

static void put_points(image *m)
{
    for (int p = 0; p < FAP_POINT_COUNT; p++) {
        const build_point *point = &m->b->point[p];
        fap_bytes_32(&m->chunk[C_PNTS], point->present);
        for (int axis = 0; axis < 3; axis++)
            fap_bytes_float(&m->chunk[C_PNTS], point->position[axis]);
        fap_bytes_32(&m->chunk[C_PNTS], m->pool_count);
        fap_bytes_32(&m->chunk[C_PNTS], point->count);
        for (uint32_t i = 0; i < point->count; i++)
            fap_bytes_32(&m->chunk[C_PVTX], m->place[point->vertex[i]]);
        m->pool_count += point->count;
    }
    for (int i = 0; i < 8; i++)
        fap_bytes_float(&m->chunk[C_EYES], m->b->eye[i / 4][i % 4]);
}

static void put_key_points(image *m, const build_key *k)
{
    for (int p = 0; p < FAP_POINT_COUNT; p++) {
        const build_point *point = &m->b->point[p];
        float mean[3];
        mean_of((const float(*)[3])k->delta, point->vertex, point->count, mean);
        for (int axis = 0; axis < 3; axis++)
            fap_bytes_float(&m->chunk[C_KPNT], mean[axis]);
    }
}

typedef struct packed {
    float scale;
    uint32_t count; /* of blocks */
} packed;

/* m->motion in steps, blocks that stand still left out. */
static packed put_motion(image *m, fap_bytes *blocks, fap_bytes *deltas)
{
    const packed p = { fap_pack_scale(m->motion, m->stride),
                       fap_pack_blocks(m->motion, m->stride, m->block) };

    fap_pack_delta(m->motion, m->stride, m->block, p.count, p.scale, m->delta);
    for (uint32_t i = 0; i < p.count; i++)
        fap_bytes_16(blocks, m->block[i]);
    for (uint32_t i = 0; i < p.count * 3 * FAP_BLOCK; i++)
        fap_bytes_16(deltas, (uint16_t)m->delta[i]);
    return p;
}

static void put_key(image *m, const build_key *k)
{
    for (int axis = 0; axis < 3; axis++)
        for (uint32_t v = 0; v < m->b->vertex_count; v++)
            m->motion[axis * m->stride + v] = k->delta[m->order[v]][axis];

    const packed p = put_motion(m, &m->chunk[C_KBLK], &m->chunk[C_KDLT]);
    fap_bytes *c = &m->chunk[C_KEYS];
    fap_bytes_put(c, k->name, FBANK_KEY_NAME);
    fap_bytes_8(c, (uint8_t)k->kind);
    fap_bytes_8(c, (uint8_t)k->number);
    fap_bytes_16(c, 0);
    fap_bytes_32(c, m->run_count);
    fap_bytes_float(c, p.scale);
    fap_bytes_32(c, p.count);
    put_key_points(m, k);
    m->run_count += p.count;
}

static void put_counts(image *m)
{
    const uint32_t counts[] = { m->b->vertex_count, m->b->triangle_count, (uint32_t)m->b->key_count,
                                m->pool_count,      m->run_count,         FAP_POINT_COUNT };
    for (int i = 0; i < 6; i++)
        fap_bytes_32(&m->chunk[C_HEAD], counts[i]);
    fap_bytes_put(&m->chunk[C_NAME], m->b->name, strlen(m->b->name));
}

static fap_err check_chunks(const image *m)
{
    for (int c = 0; c < C_COUNT; c++)
        if (m->chunk[c].failed)
            return FAP_E_NOMEM;
    return FAP_OK;
}

/* Key models first, units last: the population of the GA is then one run. */
static fap_err fill_chunks(image *m)
{
    put_mesh(m);
    const fap_err err = put_fapu(m);
    if (err)
        return err;
    put_points(m);
    for (int units = 0; units < 2; units++)
        for (int k = 0; k < m->b->key_count; k++)
            if ((m->b->key[k].kind == FAP_KEY_UNIT) == units)
                put_key(m, &m->b->key[k]);
    put_counts(m);
    return check_chunks(m);
}

static size_t aligned(size_t n)
{
    return (n + FBANK_ALIGN - 1) / FBANK_ALIGN * FBANK_ALIGN;
}

static int has_chunk(const image *m, int c)
{
    return c < C_VTUV || (c > C_VTUV && c < C_REGN) || m->chunk[c].size;
}

static uint32_t count_chunks(const image *m)
{
    uint32_t count = 0;

    for (int c = 0; c < C_COUNT; c++)
        count += has_chunk(m, c) != 0;
    return count;
}

static void put_table(const image *m, fap_bytes *table, uint32_t count, size_t *end)
{
    *end = aligned(FBANK_HEAD_SIZE + count * FBANK_ENTRY_SIZE);
    for (int c = 0; c < C_COUNT; c++) {
        if (!has_chunk(m, c))
            continue;
        fap_bytes_put(table, tags[c], 4);
        fap_bytes_32(table, (uint32_t)*end);
        fap_bytes_32(table, (uint32_t)m->chunk[c].size);
        fap_bytes_32(table, fbank_crc32(m->chunk[c].data, m->chunk[c].size));
        *end = aligned(*end + m->chunk[c].size);
    }
}

static void put_head(fap_bytes *head, const fap_bytes *table, uint32_t count, size_t total)
{
    fap_bytes_put(head, FBANK_MAGIC, 8);
    fap_bytes_16(head, FBANK_MAJOR);
    fap_bytes_16(head, FBANK_MINOR);
    fap_bytes_32(head, count);
    fap_bytes_32(head, (uint32_t)total);
    fap_bytes_32(head, fbank_crc32(table->data, table->size));
    fap_bytes_32(head, 0);
    fap_bytes_32(head, 0);
}

/* Writes @p bytes and zeros up to the next chunk's start. */
static fap_err send(const fap_writer *out, const fap_bytes *bytes, size_t padded)
{
    static const uint8_t zeros[FBANK_ALIGN];

    if (bytes->size && out->write(out->user, bytes->data, bytes->size))
        return FAP_E_IO;
    return padded > bytes->size && out->write(out->user, zeros, padded - bytes->size) ? FAP_E_IO : FAP_OK;
}

static fap_err send_all(const image *m, const fap_writer *out)
{
    const uint32_t count = count_chunks(m);
    fap_bytes head = { 0 }, table = { 0 };
    size_t total;

    put_table(m, &table, count, &total);
    put_head(&head, &table, count, total);
    fap_err err = head.failed || table.failed ? FAP_E_NOMEM : total > FBANK_MAX_SIZE ? FAP_E_LIMIT : FAP_OK;
    if (!err)
        err = send(out, &head, head.size);
    if (!err)
        err = send(out, &table, aligned(FBANK_HEAD_SIZE + table.size) - FBANK_HEAD_SIZE);
    for (int c = 0; !err && c < C_COUNT; c++)
        if (has_chunk(m, c))
            err = send(out, &m->chunk[c], aligned(m->chunk[c].size));
    fap_bytes_free(&head);
    fap_bytes_free(&table);
    return err;
}

/* --- chunks that are found out from the rest of the file, by the code that a face would use --- */

static void put_floats(fap_bytes *out, const float *value, size_t count)
{
    for (size_t i = 0; i < count; i++)
        fap_bytes_float(out, value[i]);
}

static void put_lines(fap_bytes *out, const fap_region_lines *lines)
{
    const float head[FBANK_REGION_HEAD / 4] = { lines->middle[0], lines->middle[1], lines->extent[0],
                                                lines->extent[1] };
    put_floats(out, head, FBANK_REGION_HEAD / 4);
}

static void put_own_regions(image *m)
{
    put_lines(&m->chunk[C_REGN], &m->b->lines);
    for (int axis = 0; axis < 2; axis++)
        for (uint32_t v = 0; v < m->stride; v++)
            fap_bytes_float(&m->chunk[C_REGN], v < m->b->vertex_count ? m->b->from[m->order[v]][axis] : 0);
}

static fap_err put_regions(image *m, const fap_bank *bank)
{
    fap_region_lines lines;

    if (m->b->from) {
        put_own_regions(m);
        return FAP_OK;
    }
    float *from = calloc(2 * (size_t)m->stride, sizeof *from);
    if (!from)
        return FAP_E_NOMEM;
    fap_region_measure(bank, &lines);
    fap_region_distances(bank, &lines, from);
    put_lines(&m->chunk[C_REGN], &lines);
    put_floats(&m->chunk[C_REGN], from, 2 * (size_t)m->stride);
    free(from);
    return FAP_OK;
}

static fap_err put_masks(image *m, const fap_bank *bank)
{
    const fap_allocator heap = fap_mem_allocator(NULL);
    uint8_t *mask = calloc(m->stride, 1);
    const int failed = !mask || (!m->b->mask && fap_mask_derive(bank, mask, &heap));

    for (uint32_t v = 0; m->b->mask && mask && v < m->b->vertex_count; v++)
        mask[v] = m->b->mask[m->order[v]];
    if (!failed)
        fap_bytes_put(&m->chunk[C_MASK], mask, m->stride);
    free(mask);
    return failed ? FAP_E_NOMEM : FAP_OK;
}

static void add_key(image *m, const fap_key *key, float weight)
{
    for (uint32_t b = 0; b < key->block_count; b++)
        for (uint32_t i = 0; i < 3 * FAP_BLOCK; i++)
            m->motion[i / FAP_BLOCK * m->stride + (uint32_t)key->block[b] * FAP_BLOCK + i % FAP_BLOCK] +=
                weight * key->scale_mm * key->delta[(size_t)b * 3 * FAP_BLOCK + i];
}

static void put_shape_points(image *m, const fap_bank *bank, const fap_pca *pca, const float *weight)
{
    for (int i = 0; i < FAP_POINT_COUNT * 3; i++) {
        float sum = 0;
        for (int j = pca->neutral; j < pca->model_count; j++)
            sum += weight[j] * fap_bank_key_get(bank, pca->key[j])->point_mm[i / 3][i % 3];
        fap_bytes_float(&m->chunk[C_PCAP], sum);
    }
}

/* One record, its points and its blocks: the sum of models by @p weight. @p number: sigma, ratio, rest. */
static void put_shape(image *m, const fap_bank *bank, const fap_pca *pca, const float *weight,
                      const float number[3])
{
    memset(m->motion, 0, 3 * (size_t)m->stride * sizeof *m->motion);
    for (int j = pca->neutral; j < pca->model_count; j++)
        add_key(m, fap_bank_key_get(bank, pca->key[j]), weight[j]);
    put_shape_points(m, bank, pca, weight);

    const uint32_t first = (uint32_t)(m->chunk[C_PCAB].size / 2);
    const packed p = put_motion(m, &m->chunk[C_PCAB], &m->chunk[C_PCAD]);
    put_floats(&m->chunk[C_PCAC], number, 3);
    fap_bytes_float(&m->chunk[C_PCAC], p.scale);
    fap_bytes_32(&m->chunk[C_PCAC], first);
    fap_bytes_32(&m->chunk[C_PCAC], p.count);
    fap_bytes_32(&m->chunk[C_PCAC], 0);
    fap_bytes_32(&m->chunk[C_PCAC], 0);
}

static void put_mean(image *m, const fap_bank *bank, const fap_pca *pca, float *weight)
{
    static const float none[3] = { 0 };

    for (int j = 0; j < pca->model_count; j++)
        weight[j] = 1.0f / (float)pca->model_count;
    put_shape(m, bank, pca, weight, none);
}

static void put_component(image *m, const fap_bank *bank, const fap_pca *pca, int c, float *weight)
{
    const float number[3] = { (float)sqrt(pca->variance[c]), (float)fap_pca_contribution(pca, c + 1),
                              (float)pca->rest[c] };

    for (int j = 0; j < pca->model_count; j++)
        weight[j] = (float)pca->mix[(size_t)c * (size_t)pca->model_count + (size_t)j];
    put_floats(&m->chunk[C_PCAW], weight, (size_t)pca->model_count);
    put_shape(m, bank, pca, weight, number);
}

/* Blocks of all shapes are counted only when they are there, so their number is filled in last. */
static fap_err put_shapes(image *m, const fap_bank *bank, const fap_pca *pca)
{
    const int count = pca->component_count < m->b->components ? pca->component_count : m->b->components;
    float *weight = malloc((size_t)pca->model_count * sizeof *weight);
    fap_bytes *c = &m->chunk[C_PCAC];

    if (!weight || !count) {
        free(weight);
        return weight ? FAP_E_DATA : FAP_E_NOMEM;
    }
    const uint32_t head[4] = { (uint32_t)count, (uint32_t)pca->model_count };
    for (int i = 0; i < 4; i++)
        fap_bytes_32(c, head[i]);
    for (int j = 0; j < pca->model_count; j++)
        fap_bytes_32(&m->chunk[C_PCAM], pca->key[j] < 0 ? FAP_MODEL_NEUTRAL : (uint32_t)pca->key[j]);
    put_mean(m, bank, pca, weight);
    for (int i = 0; i < count; i++)
        put_component(m, bank, pca, i, weight);
    free(weight);
    const uint32_t runs = (uint32_t)(m->chunk[C_PCAB].size / 2);
    for (int i = 0; i < 4 && !c->failed; i++)
        c->data[8 + i] = (uint8_t)(runs >> 8 * i);
    return FAP_OK;
}

static fap_err put_basis(image *m, const fap_bank *bank)
{
    const fap_allocator heap = fap_mem_allocator(NULL);
    fap_pca pca;
    int key[FAP_PCA_MODELS];
    const int count = fap_pca_population(bank, key);
    fap_err err = fap_pca_open(&pca, bank, key, count, 1, &heap) ? FAP_E_NOMEM : FAP_OK;

    if (!err)
        err = put_shapes(m, bank, &pca);
    fap_pca_close(&pca, &heap);
    return err;
}

static int keep_bytes(void *user, const void *data, size_t size)
{
    fap_bytes_put(user, data, size);
    return ((fap_bytes *)user)->failed;
}

static fap_err derive_chunks(image *m)
{
    fap_bytes file = { 0 };
    const fap_writer w = { keep_bytes, &file };
    fap_bank *bank = NULL;

    fap_err err = send_all(m, &w);
    if (!err)
        err = fap_bank_load(&bank, file.data, file.size, NULL);
    fap_bytes_free(&file);
    if (!err)
        err = put_regions(m, bank);
    if (!err)
        err = put_masks(m, bank);
    if (!err && m->b->components)
        err = put_basis(m, bank);
    fap_bank_close(&bank);
    return err ? err : check_chunks(m);
}

static int image_open(image *m, const fap_bank_builder *b)
{
    const uint32_t stride = (b->vertex_count + FAP_BLOCK - 1) / FAP_BLOCK * FAP_BLOCK;

    *m = (image){ .b = b, .stride = stride };
    m->order = malloc(b->vertex_count * sizeof *m->order);
    m->place = malloc(b->vertex_count * sizeof *m->place);
    m->motion = calloc(3 * (size_t)stride, sizeof *m->motion);
    m->block = malloc(stride / FAP_BLOCK * sizeof *m->block);
    m->delta = malloc(3 * (size_t)stride * sizeof *m->delta);
    return m->order && m->place && m->motion && m->block && m->delta && sort_vertices(b, m->order, m->place);
}

static void image_close(image *m)
{
    for (int c = 0; c < C_COUNT; c++)
        fap_bytes_free(&m->chunk[c]);
    free(m->order);
    free(m->place);
    free(m->motion);
    free(m->block);
    free(m->delta);
}

static int eyes_are_sane(const fap_bank_builder *b)
{
    for (int right = 0; right < 2; right++)
        if (!sane((const float(*)[3])b->eye[right], 1) ||
            !(b->eye[right][3] >= 0 && b->eye[right][3] <= 10000))
            return 0;
    return 1;
}

fap_err fap_bank_builder_write(fap_bank_builder *b, const fap_writer *out)
{
    image m;

    if (!eyes_are_sane(b))
        return FAP_E_DATA;
    fap_err err = image_open(&m, b) ? fill_chunks(&m) : FAP_E_NOMEM;

    if (!err)
        err = derive_chunks(&m);
    if (!err)
        err = send_all(&m, out);
    image_close(&m);
    return err;
}
