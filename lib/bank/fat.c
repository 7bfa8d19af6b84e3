/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Life of face animation tables, and the pose: sums of slopes, then rotations.
 * Source: ISO/IEC 14496-1, FaceDefMesh and FaceDefTransform nodes.
 */
#include <math.h>
#include <string.h>

#include <fap/derive.h>

#include "bank/fat.h"
#include "base/mem.h"

enum { STRENGTH_MAX = 63 };

static const int32_t value_limit = 1 << 24; /* exact as a float, and farther than any face goes */

/* --- life --- */

fap_fat *fat_new(const fap_allocator *alloc)
{
    const fap_allocator own = fap_mem_allocator(alloc);
    fap_fat *fat = fap_mem_calloc(&own, 1, sizeof *fat);

    if (fat)
        fat->alloc = own;
    return fat;
}

int fat_table_open(const fap_fat *fat, fat_table *t)
{
    const size_t slopes = (size_t)(t->border_count - 1) * t->vertex_count;

    t->vertex = fap_mem_calloc(&fat->alloc, t->vertex_count, sizeof *t->vertex);
    t->slope = fap_mem_calloc(&fat->alloc, slopes, sizeof *t->slope);
    return t->vertex && t->slope;
}

int fat_turn_open(const fap_fat *fat, fat_turn *t)
{
    t->vertex = fap_mem_calloc(&fat->alloc, t->vertex_count, sizeof *t->vertex);
    t->share = fap_mem_calloc(&fat->alloc, t->vertex_count, sizeof *t->share);
    return t->vertex && t->share;
}

void fap_fat_close(fap_fat **fat)
{
    fap_fat *f = fat ? *fat : NULL;

    if (!f)
        return;
    const fap_allocator alloc = f->alloc;
    for (uint32_t i = 0; i < f->table_count; i++) {
        fap_mem_free(&alloc, f->table[i].vertex);
        fap_mem_free(&alloc, f->table[i].slope);
    }
    for (uint32_t i = 0; i < f->turn_count; i++) {
        fap_mem_free(&alloc, f->turn[i].vertex);
        fap_mem_free(&alloc, f->turn[i].share);
    }
    fap_mem_free(&alloc, f->neutral);
    fap_mem_free(&alloc, f->triangle);
    fap_mem_free(&alloc, f);
    *fat = NULL;
}

uint32_t fap_fat_vertex_count(const fap_fat *fat)
{
    return fat->vertex_count;
}

const uint32_t *fap_fat_triangles(const fap_fat *fat, uint32_t *count)
{
    *count = fat->triangle_count;
    return fat->triangle;
}

const float (*fap_fat_neutral(const fap_fat *fat))[3]
{
    return (const float(*)[3])fat->neutral;
}

/* --- what a frame asks --- */

static int32_t clamp_value(int64_t v)
{
    return (int32_t)(v > value_limit ? value_limit : v < -value_limit ? -value_limit : v);
}

static int is_given(const fap_frame *f, int fap)
{
    return f->state[fap] != FAP_ABSENT && f->state[fap] != FAP_DERIVED;
}

int fat_gives_mouth(const fap_frame *f)
{
    for (int fap = 4; fap <= 13; fap++)
        if (is_given(f, fap) || is_given(f, fap + 47)) /* FAPs 51 to 60 are the outer contour */
            return 1;
    return 0;
}

/* Head, eyeballs and jaw go with any expression. */
int fat_gives_expression(const fap_frame *f)
{
    for (int fap = 19; fap <= 42; fap++)
        if (is_given(f, fap) && (fap < 23 || fap > 30))
            return 1;
    return fat_gives_mouth(f);
}

/* A follower leads nobody: shares are those of FAPs that somebody sent. */
static void follow(const fap_fat *fat, fap_frame *f)
{
    const fap_frame sent = *f;

    for (uint32_t i = 0; i < fat->follow_count; i++) {
        const fat_follow *l = &fat->follow[i];
        if (f->state[l->fap] != FAP_ABSENT || sent.state[l->leader] == FAP_ABSENT)
            continue;
        f->value[l->fap] = clamp_value((int64_t)sent.value[l->leader] * l->share_1024 / 1024);
        f->state[l->fap] = FAP_DERIVED;
    }
}

static int viseme_strength(const fap_viseme *v, int select)
{
    return (v->select1 == select ? v->blend : 0) + (v->select2 == select ? STRENGTH_MAX - v->blend : 0);
}

static int expression_strength(const fap_expression *e, int select)
{
    return (e->select1 == select ? e->intensity1 : 0) + (e->select2 == select ? e->intensity2 : 0);
}

/* The value that a table is read at. */
static int32_t value_of(const fap_frame *f, const fat_table *t, int speaks, int feels)
{
    if (t->fap == 1)
        return speaks ? viseme_strength(&f->viseme, t->select) : 0;
    if (t->fap == 2)
        return feels ? expression_strength(&f->expression, t->select) : 0;
    return f->state[t->fap] == FAP_ABSENT ? 0 : clamp_value(f->value[t->fap]);
}

/* --- pose --- */

/*
 * How much of interval @p k lies between 0 and @p v, with v's sign. Beyond the first and last border the slope goes on, also
 * where that border is 0: a straight line needs one interval.
 */
static int32_t covered(const fat_table *t, int k, int32_t v)
{
    const int last = t->border_count - 2;

    if ((k == 0 && t->border[0] == 0 && v < 0) || (k == last && t->border[last + 1] == 0 && v > 0))
        return v;
    const int32_t low = k == 0 && v < t->border[0] ? v : t->border[k];
    const int32_t high = k == last && v > t->border[k + 1] ? v : t->border[k + 1];

    if (v > 0)
        return low < 0 || v <= low ? 0 : (v < high ? v : high) - low;
    return high > 0 || v >= high ? 0 : (v > low ? v : low) - high;
}

static void add_table(const fat_table *t, int32_t v, float (*position)[3])
{
    for (int k = 0; v && k + 1 < t->border_count; k++) {
        const int16_t(*slope)[3] = (const int16_t(*)[3])t->slope + (size_t)k * t->vertex_count;
        const float length = (float)covered(t, k, v) * t->scale_mm;
        for (uint32_t i = 0; length != 0 && i < t->vertex_count; i++)
            for (int axis = 0; axis < 3; axis++)
                position[t->vertex[i]][axis] += length * (float)slope[i][axis];
    }
}

static void turn_vertex(const fat_turn *t, float sine, float cosine, float p[3])
{
    const int a = (t->axis + 1) % 3, b = (t->axis + 2) % 3;
    const float u = p[a] - t->pivot[a], v = p[b] - t->pivot[b];

    p[a] = t->pivot[a] + cosine * u - sine * v;
    p[b] = t->pivot[b] + sine * u + cosine * v;
}

/* Vertices with the same share stand together, so that few sines are taken. */
static void turn(const fat_turn *t, int32_t v, float (*position)[3])
{
    float sine = 0, cosine = 1;
    int share = 0;

    for (uint32_t i = 0; v && i < t->vertex_count; i++) {
        if (t->share[i] != share) {
            share = t->share[i];
            const float angle = (float)v * t->radians * (float)share / 255;
            sine = sinf(angle);
            cosine = cosf(angle);
        }
        turn_vertex(t, sine, cosine, position[t->vertex[i]]);
    }
}

void fat_add_low_level(const fap_fat *fat, const fap_frame *frame, float (*position)[3])
{
    fap_frame f = *frame;

    fap_derive(&f);
    follow(fat, &f);
    for (uint32_t i = 0; i < fat->table_count; i++)
        if (fat->table[i].fap > 2)
            add_table(&fat->table[i], value_of(&f, &fat->table[i], 0, 0), position);
}

/* A viseme or expression brings its lips along; FAPs that nobody sent do not add to them. */
void fap_fat_pose(const fap_fat *fat, const fap_frame *frame, float (*position)[3])
{
    const int speaks = frame->state[1] != FAP_ABSENT && !fat_gives_mouth(frame);
    const int feels = frame->state[2] != FAP_ABSENT && !fat_gives_expression(frame);
    fap_frame f = *frame;

    fap_derive(&f);
    if (!speaks && !feels)
        follow(fat, &f);
    memcpy(position, fat->neutral, fat->vertex_count * sizeof *position);
    for (uint32_t i = 0; i < fat->table_count; i++)
        add_table(&fat->table[i], value_of(&f, &fat->table[i], speaks, feels), position);
    for (uint32_t i = 0; i < fat->turn_count; i++)
        if (f.state[fat->turn[i].fap] != FAP_ABSENT)
            turn(&fat->turn[i], clamp_value(f.value[fat->turn[i].fap]), position);
}
