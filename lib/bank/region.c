/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Borders run through the neutral face's own feature points: the middle of the face, and half way between eyes
 * and mouth. What is no skin (an eyeball, a row of teeth) is shaped as one body and takes the shares of its
 * middle. Source: Zhu 2006 section 3.4.2, eq. 3.7, figures 3.7, 3.8 and 3.11.
 */
#include <math.h>
#include <string.h>

#include "bank/region.h"
#include "base/mem.h"

/* The two ramps: 0 at one end of the intermediate strip, 1 at the other. */
typedef struct borders {
    int count;
    float middle[2], half_width[2]; /* x to the face's left, y up */
} borders;

static float ramp(const borders *b, int axis, float from)
{
    const float half = b->half_width[axis];

    return half > 0 ? fminf(1, fmaxf(0, 0.5f + 0.5f * from / half)) : from > 0;
}

/* Regions: left, right; or upper left, upper right, lower left, lower right. @p x, @p y: from the borders. */
static void share_out(const borders *b, float x, float y, float share[FAP_REGION_MAX])
{
    const float left = ramp(b, 0, x), upper = ramp(b, 1, y);

    memset(share, 0, FAP_REGION_MAX * sizeof *share);
    if (b->count == 1) {
        share[0] = 1;
    } else if (b->count == 2) {
        share[0] = left;
        share[1] = 1 - left;
    } else {
        share[0] = upper * left;
        share[1] = upper * (1 - left);
        share[2] = (1 - upper) * left;
        share[3] = (1 - upper) * (1 - left);
    }
}

/* Mean of the named points that the face has; 0: it has none of them. */
static int mean_of(const fap_bank *bank, const char *const *name, int axis, float *mean)
{
    float sum = 0;
    int n = 0;

    for (; *name; name++) {
        const fap_bank_point *p = fap_bank_point_get(bank, fap_point_by_name(*name));
        if (p->present) {
            sum += p->position_mm[axis];
            n++;
        }
    }
    *mean = n ? sum / (float)n : 0;
    return n;
}

/* Ears, hair line, tongue and spine do not belong to the face's width and height. */
static int measures(const fap_bank_point *p, const fap_point_info *info)
{
    return p->present && info->group != 6 && info->group != 7 && info->group != 11 &&
           !(info->group == 10 && info->index <= 6);
}

static float extent(const fap_bank *bank, int axis)
{
    float lo = INFINITY, hi = -INFINITY;

    for (int i = 0; i < FAP_POINT_COUNT; i++) {
        const fap_bank_point *p = fap_bank_point_get(bank, i);
        if (!measures(p, fap_point_get(i)))
            continue;
        lo = fminf(lo, p->position_mm[axis]);
        hi = fmaxf(hi, p->position_mm[axis]);
    }
    return hi > lo ? hi - lo : 0;
}

void fap_region_measure(const fap_bank *bank, fap_region_lines *lines)
{
    static const char *const centre[] = { "2.1", "9.3", "9.15", "9.12", NULL };
    static const char *const eyes[] = { "3.1", "3.2", "3.3", "3.4", NULL };
    static const char *const lips[] = { "2.2", "2.3", "8.1", "8.2", NULL };
    float eye, mouth;

    *lines = (fap_region_lines){ .from = NULL };
    mean_of(bank, centre, 0, &lines->middle[0]);
    if (mean_of(bank, eyes, 1, &eye) && mean_of(bank, lips, 1, &mouth))
        lines->middle[1] = (eye + mouth) / 2;
    for (int axis = 0; axis < 2; axis++)
        lines->extent[axis] = extent(bank, axis);
}

/* Middle of each part that is no skin. */
static void find_middles(const fap_mesh *mesh, float middle[FAP_PART_COUNT][2])
{
    double sum[FAP_PART_COUNT][3] = { { 0 } };

    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        double *s = sum[mesh->part[v] % FAP_PART_COUNT];
        s[0] += mesh->position[v];
        s[1] += mesh->position[mesh->stride + v];
        s[2]++;
    }
    for (int p = 0; p < FAP_PART_COUNT; p++)
        for (int axis = 0; axis < 2; axis++)
            middle[p][axis] = sum[p][2] > 0 ? (float)(sum[p][axis] / sum[p][2]) : 0;
}

static int is_body(uint8_t part)
{
    return part != FAP_PART_SKIN && part != FAP_PART_LASHES;
}

void fap_region_distances(const fap_bank *bank, const fap_region_lines *lines, float *from)
{
    const fap_mesh *mesh = fap_bank_mesh(bank);
    float middle[FAP_PART_COUNT][2];

    find_middles(mesh, middle);
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        for (uint32_t axis = 0; axis < 2; axis++) {
            const uint8_t part = mesh->part[v] % FAP_PART_COUNT;
            const float at = is_body(part) ? middle[part][axis] : mesh->position[axis * mesh->stride + v];
            from[axis * mesh->stride + v] = at - lines->middle[axis];
        }
}

static void fill_map(fap_regions *r, const borders *b, const fap_mesh *mesh, const float *from)
{
    float share[FAP_REGION_MAX];

    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        float *block = r->map + (size_t)(v / FAP_BLOCK) * FAP_REGION_MAX * FAP_BLOCK + v % FAP_BLOCK;
        share_out(b, from[v], from[mesh->stride + v], share);
        for (int i = 0; i < FAP_REGION_MAX; i++)
            block[i * FAP_BLOCK] = share[i];
    }
}

/* A point is where its vertices are: the mean of their shares. */
static void share_point(fap_regions *r, const borders *b, const fap_bank_point *p, int point)
{
    float share[FAP_REGION_MAX];

    share_out(b, p->position_mm[0] - b->middle[0], p->position_mm[1] - b->middle[1], share);
    for (int i = 0; i < FAP_REGION_MAX; i++) {
        float sum = 0;
        for (uint32_t k = 0; k < p->vertex_count && r->map; k++)
            sum += r->map[((size_t)(p->vertex[k] / FAP_BLOCK) * FAP_REGION_MAX + (size_t)i) * FAP_BLOCK +
                          p->vertex[k] % FAP_BLOCK];
        r->point[i][point] = r->map && p->vertex_count ? sum / (float)p->vertex_count : share[i];
    }
}

/* The bank's own distances where it has them. */
static int open_map(fap_regions *r, const borders *b, const fap_bank *bank, const fap_region_lines *lines,
                    const fap_allocator *alloc)
{
    const fap_mesh *mesh = fap_bank_mesh(bank);
    float *own = lines->from ? NULL : fap_mem_calloc(alloc, 2 * (size_t)mesh->stride, sizeof *own);

    r->map = fap_mem_calloc(alloc, (size_t)mesh->stride * FAP_REGION_MAX, sizeof *r->map);
    const int failed = !r->map || (!lines->from && !own);
    if (own)
        fap_region_distances(bank, lines, own);
    if (!failed)
        fill_map(r, b, mesh, own ? own : lines->from);
    fap_mem_free(alloc, own);
    return failed;
}

int fap_regions_open(fap_regions *r, const fap_bank *bank, int count, float overlap,
                     const fap_allocator *alloc)
{
    const fap_region_lines *stored = fap_bank_regions(bank);
    fap_region_lines lines;
    borders b = { .count = count };

    memset(r, 0, sizeof *r);
    r->count = count;
    if (stored)
        lines = *stored;
    else
        fap_region_measure(bank, &lines);
    for (int axis = 0; axis < 2; axis++) {
        b.middle[axis] = lines.middle[axis];
        b.half_width[axis] = overlap * lines.extent[axis];
    }
    if (count > 1 && open_map(r, &b, bank, &lines, alloc))
        return 1;
    for (int p = 0; p < FAP_POINT_COUNT; p++)
        share_point(r, &b, fap_bank_point_get(bank, p), p);
    return 0;
}

void fap_regions_close(fap_regions *r, const fap_allocator *alloc)
{
    fap_mem_free(alloc, r->map);
    memset(r, 0, sizeof *r);
}
