/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * No example faces, lids aside: what the feature points do is spread over the skin by Hardy's multiquadrics, each
 * axis with the points that are commanded along it and with anchors where the face never moves. Visemes and
 * expressions are still key models; the field bends what they show. Source: Zhu 2006 section 4.3, eq. 4.1 to
 * 4.4, used for motion instead of shape; Lin et al. 2001 section 5.2.
 */
#include <math.h>
#include <string.h>

#include "bank/face.h"
#include "bank/face_graph.h"
#include "bank/gauss.h"
#include "base/mem.h"

enum { SPACE = 5 }; /* x, y, z, which side of the mouth, which side of an eye */
enum { ANCHORS = 24, CENTRES_MAX = FAP_POINT_COUNT + ANCHORS };
static const double least_pivot = 1e-3; /* below it two centres are one */
static const float farthest_mm = 200;   /* targets that contradict each other do not fling the skin further */

typedef struct state {
    int count, point_count; /* centres: feature points first, then anchors */
    int point[FAP_POINT_COUNT];
    float centre[CENTRES_MAX][SPACE], stiffness[CENTRES_MAX];
    uint32_t anchor[ANCHORS];
    float (*side)[SPACE - 3];                 /* [vertex_count] */
    float *kernel;                            /* [count][stride]: eq. 4.2 at every vertex */
    float pull[FAP_POINT_COUNT][CENTRES_MAX]; /* the same at the feature points */
    float anchor_pull[ANCHORS][CENTRES_MAX];
    uint16_t *block;                             /* [stride / FAP_BLOCK]: all of them */
    float strength[3][CENTRES_MAX];              /* W of eq. 4.1, this frame's */
    double matrix[CENTRES_MAX][CENTRES_MAX + 1]; /* work */
} state;

/* --- made at open --- */

/*
 * Straight lines alone glue lips and lids together: an upper lip is nearer to the lower one than to its own corners. So
 * each vertex also has a height above the slit in a dimension of its own, from how far it is along the surface
 * to either edge: the furthest at the edges, nought at the corners, fading with distance. The kernel stays Hardy's and the
 * equations stay solvable.
 */
static const struct slit {
    float apart_mm;
    const char *upper[3], *lower[3];
} slits[SPACE - 3] = {
    { 40, { "2.2", "2.6", "2.7" }, { "2.3", "2.8", "2.9" } },
    { 20, { "3.1", "3.2" }, { "3.3", "3.4" } },
};
static const float slit_reach_mm = 120;

/* Distances along the surface from the points named; @p out has one a vertex. */
static int flood(fap_graph *graph, const fap_face *face, const char *const names[3], float *out)
{
    uint32_t source[3], count = 0;

    for (int i = 0; i < 3 && names[i]; i++) {
        const int p = fap_point_by_name(names[i]);
        if (face->solvable[p])
            source[count++] = fap_bank_point_get(face->bank, p)->vertex[0];
    }
    fap_graph_flood(graph, source, count, slit_reach_mm);
    for (uint32_t v = 0; v < face->mesh->vertex_count; v++)
        out[v] = fminf(slit_reach_mm, graph->distance[graph->weld[v]]);
    return count > 0;
}

static void take_sides(state *s, fap_graph *graph, const fap_face *face, float *up, float *low)
{
    for (int i = 0; i < SPACE - 3; i++) {
        if (!flood(graph, face, slits[i].upper, up) || !flood(graph, face, slits[i].lower, low))
            continue;
        for (uint32_t v = 0; v < face->mesh->vertex_count; v++)
            s->side[v][i] = slits[i].apart_mm / 2 * (low[v] - up[v]) / (low[v] + up[v] + 0.01f);
    }
}

static int find_sides(state *s, const fap_face *face)
{
    const uint32_t n = face->mesh->vertex_count;
    float *up = fap_mem_calloc(&face->alloc, n, sizeof *up),
          *low = fap_mem_calloc(&face->alloc, n, sizeof *low);
    fap_graph graph;

    s->side = fap_mem_calloc(&face->alloc, n, sizeof *s->side);
    const int failed = fap_graph_open(&graph, face->bank, &face->alloc) || !up || !low || !s->side;
    if (!failed)
        take_sides(s, &graph, face, up, low);
    fap_graph_close(&graph, &face->alloc);
    fap_mem_free(&face->alloc, up);
    fap_mem_free(&face->alloc, low);
    return failed;
}

static void place(const state *s, const fap_face *face, uint32_t v, float out[SPACE])
{
    for (size_t axis = 0; axis < 3; axis++)
        out[axis] = face->mesh->position[axis * face->mesh->stride + v];
    memcpy(out + 3, s->side[v], sizeof s->side[v]);
}

static void place_point(const state *s, const fap_face *face, int p, float out[SPACE])
{
    const fap_bank_point *b = fap_bank_point_get(face->bank, p);

    memcpy(out, face->neutral[p], sizeof face->neutral[p]);
    for (int i = 0; i < SPACE - 3; i++)
        out[3 + i] = b->vertex_count ? s->side[b->vertex[0]][i] : 0;
}

static float distance(const float a[SPACE], const float b[SPACE])
{
    float square = 0;

    for (int i = 0; i < SPACE; i++)
        square += (a[i] - b[i]) * (a[i] - b[i]);
    return sqrtf(square);
}

static int on_skin(const fap_face *face, int p)
{
    const fap_bank_point *b = fap_bank_point_get(face->bank, p);
    return face->solvable[p] && face->mesh->part[b->vertex[0]] == FAP_PART_SKIN;
}

static void list_centres(state *s, const fap_face *face)
{
    for (int p = 0; p < FAP_POINT_COUNT; p++)
        if (on_skin(face, p)) {
            place_point(s, face, p, s->centre[s->count]);
            s->point[s->count++] = p;
        }
    s->point_count = s->count;
}

static void mark_moving(const fap_face *face, uint8_t *moving)
{
    for (int k = 0; k < face->key_count; k++)
        for (uint32_t b = 0; b < face->key[k]->block_count; b++)
            for (int i = 0; i < 3 * FAP_BLOCK; i++)
                if (face->key[k]->delta[(size_t)b * 3 * FAP_BLOCK + (size_t)i])
                    moving[(uint32_t)face->key[k]->block[b] * FAP_BLOCK + (uint32_t)i % FAP_BLOCK] = 1;
}

/* Skin that no key moves, each anchor as far as can be from the centres there are. */
static void add_anchors(state *s, const fap_face *face, const uint8_t *moving, float *nearest)
{
    const fap_mesh *mesh = face->mesh;
    float at[SPACE];

    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        nearest[v] = INFINITY;
    for (int c = 0, found = 1; found && s->count < s->point_count + ANCHORS; c = s->count - 1) {
        uint32_t best = 0;
        found = 0;
        for (uint32_t v = 0; v < mesh->vertex_count; v++) {
            place(s, face, v, at);
            for (int i = c ? c : 0; i < s->count; i++)
                nearest[v] = fminf(nearest[v], distance(at, s->centre[i]));
            if (moving[v] || mesh->part[v] != FAP_PART_SKIN || nearest[v] < 1 || isinf(nearest[v]))
                continue;
            best = !found || nearest[v] > nearest[best] ? v : best;
            found = 1;
        }
        if (found) {
            s->anchor[s->count - s->point_count] = best;
            place(s, face, best, s->centre[s->count++]);
        }
    }
}

static int find_anchors(state *s, const fap_face *face)
{
    uint8_t *moving = fap_mem_calloc(&face->alloc, face->mesh->stride, 1);
    float *nearest = fap_mem_calloc(&face->alloc, face->mesh->stride, sizeof *nearest);
    const int failed = !moving || !nearest;

    if (!failed) {
        mark_moving(face, moving);
        add_anchors(s, face, moving, nearest);
    }
    fap_mem_free(&face->alloc, moving);
    fap_mem_free(&face->alloc, nearest);
    return failed;
}

/* Eq. 4.3: each centre is as soft as its nearest neighbour is far. */
static void find_stiffness(state *s)
{
    for (int i = 0; i < s->count; i++) {
        float least = INFINITY;
        for (int j = 0; j < s->count; j++)
            if (j != i)
                least = fminf(least, distance(s->centre[i], s->centre[j]));
        s->stiffness[i] = isinf(least) ? 1 : fmaxf(least, 0.1f);
    }
}

/* Eq. 4.2 */
static float hardy(const state *s, int c, const float at[SPACE])
{
    const float d = distance(at, s->centre[c]);
    return sqrtf(d * d + s->stiffness[c] * s->stiffness[c]);
}

/* Lower teeth and tongue go where the chin goes; eyes and upper teeth stay. */
static float kernel_at(const state *s, const fap_face *face, int c, uint32_t v)
{
    float at[SPACE];

    switch (face->mesh->part[v]) {
    case FAP_PART_TEETH_LOWER:
    case FAP_PART_TONGUE: place_point(s, face, face->chin_row / 3, at); return hardy(s, c, at);
    case FAP_PART_SKIN:
    case FAP_PART_LASHES: place(s, face, face->follows[v], at); return hardy(s, c, at);
    default: return 0;
    }
}

static void fill_kernel(state *s, const fap_face *face, int c)
{
    float *kernel = s->kernel + (size_t)c * face->mesh->stride;

    for (uint32_t v = 0; v < face->mesh->vertex_count; v++)
        kernel[v] = kernel_at(s, face, c, v);
    for (int i = 0; i < s->point_count; i++) {
        const fap_bank_point *b = fap_bank_point_get(face->bank, s->point[i]);
        for (uint32_t k = 0; k < b->vertex_count; k++)
            s->pull[i][c] += kernel[b->vertex[k]] / (float)b->vertex_count;
    }
    for (int i = 0; i < s->count - s->point_count; i++)
        s->anchor_pull[i][c] = kernel[s->anchor[i]];
}

static int open_rbf(void *user, const fap_face *face)
{
    state *s = user;
    const uint32_t stride = face->mesh->stride;

    if (find_sides(s, face))
        return 1;
    list_centres(s, face);
    if (find_anchors(s, face))
        return 1;
    s->kernel = fap_mem_calloc(&face->alloc, (size_t)(s->count + 1) * stride, sizeof *s->kernel);
    s->block = fap_mem_calloc(&face->alloc, stride / FAP_BLOCK, sizeof *s->block);
    if (!s->kernel || !s->block)
        return 1;
    find_stiffness(s);
    for (uint32_t b = 0; b < stride / FAP_BLOCK; b++)
        s->block[b] = (uint16_t)b;
    for (int c = 0; c < s->count; c++)
        fill_kernel(s, face, c);
    return 0;
}

static void close_rbf(void *user, const fap_face *face)
{
    state *s = user;

    fap_mem_free(&face->alloc, s->side);
    fap_mem_free(&face->alloc, s->kernel);
    fap_mem_free(&face->alloc, s->block);
}

/* --- this frame --- */

/*
 * Eyes, brows, nose, ears and hair line stay where they are when nobody speaks of them; lips, chin and cheeks go along.
 * Without that a jaw let down alone drew the lids down with it.
 */
static int stays(const fap_face *face, int p)
{
    const int group = fap_point_get(p)->group;
    const uint8_t *w = face->wanted[p];

    return !w[0] && !w[1] && !w[2] && group != 2 && group != 5 && group != 8;
}

/* Where a centre has to go along an axis. */
static float way_of(const state *s, const fap_face *face, int c, int axis)
{
    const int point = c < s->point_count ? s->point[c] : -1, row = 3 * point + axis;

    if (point < 0 || !face->wanted[point][axis])
        return 0;
    return fap_blend_row_target(face, row) - fap_face_row_motion(face, row, face->weight);
}

/* Eq. 4.4 along one axis: commanded points where they should go, anchors where they are. */
static int set_equations(state *s, const fap_face *face, int axis, int *list)
{
    int n = 0;

    for (int c = 0; c < s->count; c++)
        if (c >= s->point_count || face->wanted[s->point[c]][axis] || stays(face, s->point[c]))
            list[n++] = c;
    for (int i = 0; i < n; i++) {
        const float *pull =
            list[i] >= s->point_count ? s->anchor_pull[list[i] - s->point_count] : s->pull[list[i]];
        for (int j = 0; j < n; j++)
            s->matrix[i][j] = pull[list[j]];
        s->matrix[i][n] = way_of(s, face, list[i], axis);
    }
    return n;
}

/*
 * One point in the middle cannot say how the edge of a lid runs: spread by the kernel it made a tent with the eye in
 * sight on both sides. A lid that closes is the bank's blink as far as that goes; the field does the rest.
 */
static void lower_lids(fap_face *face)
{
    for (int right = 0; right < 2; right++) {
        const int key = face->known.blink[right], p = face->slit[FAP_LIP_SLITS + right][0];
        const float full = key >= 0 ? face->key[key]->point_mm[p][1] : 0;
        if (face->wanted[p][1] && full < 0)
            face->weight[key] = fminf(1.1f, fmaxf(0, fap_blend_row_target(face, 3 * p + 1) / full));
    }
}

static void solve_rbf(void *user, fap_face *face)
{
    state *s = user;
    int list[CENTRES_MAX];
    double x[CENTRES_MAX];

    for (int i = 0; i < face->base_count; i++)
        face->weight[face->base_key[i]] = face->base_weight[i];
    lower_lids(face);
    memset(s->strength, 0, sizeof s->strength);
    for (int axis = 0; axis < 3; axis++) {
        const int n = set_equations(s, face, axis, list);
        fap_gauss_solve(s->matrix[0], CENTRES_MAX + 1, n, least_pivot, x);
        for (int i = 0; i < n; i++)
            s->strength[axis][list[i]] = (float)x[i];
    }
}

static void stay_near(const fap_face *face, float *position)
{
    const float *rest = face->mesh->position;

    for (size_t i = 0; i < 3 * (size_t)face->mesh->stride; i++)
        position[i] = fminf(rest[i] + farthest_mm, fmaxf(rest[i] - farthest_mm, position[i]));
}

static void shape_rbf(void *user, fap_face *face, float *position)
{
    const state *s = user;
    const uint32_t stride = face->mesh->stride;

    for (int c = 0; c < s->count; c++) {
        const float w[3] = { s->strength[0][c], s->strength[1][c], s->strength[2][c] };
        if (w[0] != 0 || w[1] != 0 || w[2] != 0)
            face->dsp.add_field(position, stride, s->block, s->kernel + (size_t)c * stride,
                                stride / FAP_BLOCK, w);
    }
    stay_near(face, position);
}

const fap_blend_method fap_blend_rbf = {
    .name = "rbf",
    .summary = "feature points alone, spread by Hardy's multiquadrics",
    .state_size = sizeof(state),
    .open = open_rbf,
    .close = close_rbf,
    .solve = solve_rbf,
    .shape = shape_rbf,
};
