/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * No example faces: planar bones between the feature points carry the skin. What lies across the slit of the mouth or of
 * an eye is masked by the way along the surface, so that no picture has to be painted for a face. Visemes and
 * expressions are still key models, and what the bones do is added to them. Source: Sanchez Lorenzo et al. 2003,
 * section 4 (eq. 1 to 12) and 5.2.
 */
#include <math.h>
#include <string.h>

#include "bank/bones.h"
#include "bank/face.h"
#include "bank/planar_bone.h"
#include "base/mem.h"

static const float radius_share = 0.8f; /* of a bone's shortest edge; the paper says "a fraction" */
static const float least_radius_mm = 12, lid_radius_mm = 8; /* on a face with its eyes typical_es_mm apart */
static const float typical_es_mm = 62;
static const float typical_share = 0.75f;                 /* of a parabola's height, half way out */
static const float detour_near = 1.2f, detour_far = 1.8f; /* way along the surface : straight line */
static const float least_weight = 1e-3f;
static const float farthest_mm = 100; /* bones turned over by absurd targets do not fling the skin further */

/* One bone's say in one vertex. */
typedef struct influence {
    fap_bone_place place;
    float weight;
    int bone;
} influence;

typedef struct state {
    int bone_count;
    uint8_t corner[FAP_BONES_MAX][3];
    fap_bone_between between[FAP_BONE_HYPOTHETICAL];
    float share[FAP_BONE_HYPOTHETICAL]; /* of the middle's way that they go, the end's the rest */
    float rest[FAP_BONE_CORNERS][3];
    uint32_t vertex[FAP_BONE_CORNERS]; /* one that is there */
    float radius[FAP_BONES_MAX];
    fap_planar_bone bone[FAP_BONES_MAX]; /* at rest, then this frame's */
    uint8_t moves[FAP_BONES_MAX];        /* in this frame */
    int follower_count;
    fap_bone_follower follower[FAP_BONES_MAX];
    uint32_t *start; /* [vertex_count + 1] */
    influence *list;
    float way[FAP_BONE_CORNERS][3]; /* of this frame */
} state;

/* --- made at open --- */

static void place_of(const fap_face *face, uint32_t v, float out[3])
{
    for (size_t axis = 0; axis < 3; axis++)
        out[axis] = face->mesh->position[axis * face->mesh->stride + v];
}

static float distance(const float a[3], const float b[3])
{
    const float x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
    return sqrtf(x * x + y * y + z * z);
}

static uint32_t nearest_skin(const fap_face *face, const float at[3])
{
    float least = INFINITY, p[3];
    uint32_t best = 0;

    for (uint32_t v = 0; v < face->mesh->vertex_count; v++) {
        if (face->mesh->part[v] != FAP_PART_SKIN)
            continue;
        place_of(face, v, p);
        if (distance(p, at) < least) {
            least = distance(p, at);
            best = v;
        }
    }
    return best;
}

static void mix(const float from[3], const float to[3], float share, float out[3])
{
    for (int axis = 0; axis < 3; axis++)
        out[axis] = from[axis] + share * (to[axis] - from[axis]);
}

/* Half way from the middle of a lid to the end of the eye, about as high as a parabola is there. */
static void find_hypothetical(state *s, const fap_face *face, int i)
{
    const int corner = FAP_POINT_COUNT + i;
    const float *m = s->rest[s->between[i].middle], *e = s->rest[s->between[i].end];
    float at[3];

    mix(e, m, typical_share, at);
    at[0] = 0.5f * (m[0] + e[0]);
    s->vertex[corner] = nearest_skin(face, at);
    place_of(face, s->vertex[corner], s->rest[corner]);
}

/* A lid shuts along its whole length where each place goes its share of the middle's way: as the eye is open there. */
static void find_share(state *s, int upper)
{
    const int lower = fap_bone_opposite(upper);
    const float open = s->rest[FAP_POINT_COUNT + upper][1] - s->rest[FAP_POINT_COUNT + lower][1];
    const float middle = s->rest[s->between[upper].middle][1] - s->rest[s->between[lower].middle][1];
    const float share = middle > 0 ? open / middle : typical_share;

    s->share[upper] = s->share[lower] = fminf(1.2f, fmaxf(0.5f, share));
}

static void find_corners(state *s, const fap_face *face)
{
    for (int p = 0; p < FAP_POINT_COUNT; p++) {
        const fap_bank_point *b = fap_bank_point_get(face->bank, p);
        memcpy(s->rest[p], face->neutral[p], sizeof s->rest[p]);
        s->vertex[p] = b->vertex_count ? b->vertex[0] : 0;
    }
    fap_bones_hypothetical(s->between);
    for (int i = 0; i < FAP_BONE_HYPOTHETICAL; i++)
        find_hypothetical(s, face, i);
    for (int i = 0; i < FAP_BONE_HYPOTHETICAL; i++)
        if (fap_bone_opposite(i) > i)
            find_share(s, i);
}

/* A hypothetical corner is there when the points that it lies between are. */
static int on_skin(const state *s, const fap_face *face, int p)
{
    if (p >= FAP_POINT_COUNT)
        return on_skin(s, face, s->between[p - FAP_POINT_COUNT].middle) &&
               on_skin(s, face, s->between[p - FAP_POINT_COUNT].end);
    const fap_bank_point *b = fap_bank_point_get(face->bank, p);
    return b->present && b->vertex_count && face->mesh->part[b->vertex[0]] == FAP_PART_SKIN;
}

/* A bone with a corner on the edge of a lid. */
static int is_lid(const uint8_t corner[3])
{
    for (int i = 0; i < 3; i++) {
        const fap_point_info *p = corner[i] < FAP_POINT_COUNT ? fap_point_get(corner[i]) : NULL;
        if (!p || (p->group == 3 && p->index <= 4))
            return 1;
    }
    return 0;
}

static float radius_of(const state *s, int bone, float scale)
{
    const fap_planar_bone *b = &s->bone[bone];
    float shortest = INFINITY;

    if (is_lid(s->corner[bone]))
        return scale * lid_radius_mm;

    for (int i = 0; i < 3; i++)
        shortest = fminf(shortest, distance(b->corner[i], b->corner[(i + 1) % 3]));
    return fmaxf(radius_share * shortest, scale * least_radius_mm);
}

static int set_bone(state *s, int i)
{
    float corner[3][3];

    for (int c = 0; c < 3; c++)
        memcpy(corner[c], s->rest[s->corner[i][c]], sizeof corner[c]);
    return fap_planar_bone_set(&s->bone[i], (const float(*)[3])corner);
}

/* Triangles whose points the bank has. */
static void list_bones(state *s, const fap_face *face)
{
    uint8_t all[FAP_BONES_MAX][3];
    const int count = fap_bones_list(all);
    const float scale = fap_bank_fapu(face->bank)->es_mm / typical_es_mm;

    for (int i = 0; i < count; i++) {
        if (!on_skin(s, face, all[i][0]) || !on_skin(s, face, all[i][1]) || !on_skin(s, face, all[i][2]))
            continue;
        memcpy(s->corner[s->bone_count], all[i], sizeof all[i]);
        if (!set_bone(s, s->bone_count))
            continue;
        s->radius[s->bone_count] = radius_of(s, s->bone_count, scale);
        s->bone_count++;
    }
    s->follower_count = fap_bones_followers(s->follower);
}

static float nearest_corner(const fap_planar_bone *b, const float at[3])
{
    float least = INFINITY;

    for (int i = 0; i < 3; i++)
        least = fminf(least, distance(at, b->corner[i]));
    return least;
}

/* Section 4.3: 1 where the surface leads straight to the bone, 0 where it leads round a slit. */
static float mask(const fap_planar_bone *b, const float at[3], float way)
{
    const float line = nearest_corner(b, at) + 1; /* a millimetre is no detour */
    const float t = (way / line - detour_near) / (detour_far - detour_near);
    const float u = fminf(1, fmaxf(0, t));

    return 1 - u * u * (3 - 2 * u);
}

static void flood(const state *s, fap_graph *g, int bone)
{
    const float inside =
        0.6f; /* of the longest edge: no place of a triangle is further from its nearest corner */
    const fap_planar_bone *b = &s->bone[bone];
    uint32_t source[3];
    float longest = 0;

    for (int i = 0; i < 3; i++) {
        longest = fmaxf(longest, distance(b->corner[i], b->corner[(i + 1) % 3]));
        source[i] = s->vertex[s->corner[bone][i]];
    }
    fap_graph_flood(g, source, 3, detour_far * (inside * longest + s->radius[bone]));
}

/* Weight of a bone at a vertex, and where it sees it; the graph holds the distances from that bone. */
static float see(const state *s, const fap_face *face, const fap_graph *g, int bone, uint32_t v,
                 fap_bone_place *place)
{
    const float way = g->distance[g->weld[v]];
    float at[3];

    if (face->mesh->part[v] != FAP_PART_SKIN || isinf(way))
        return 0;
    place_of(face, v, at);
    const float distance = fap_planar_bone_locate(&s->bone[bone], at, place);
    const float weight = fap_planar_bone_weight(distance, s->radius[bone]);
    return weight > least_weight ? weight * mask(&s->bone[bone], at, way) : 0;
}

/* Twice over all bones: once to count, once to fill in. */
static void look(state *s, const fap_face *face, fap_graph *g, uint32_t *fill)
{
    for (int bone = 0; bone < s->bone_count; bone++) {
        flood(s, g, bone);
        for (uint32_t v = 0; v < face->mesh->vertex_count; v++) {
            influence seen = { .bone = bone };
            seen.weight = see(s, face, g, bone, v, &seen.place);
            if (seen.weight <= least_weight)
                continue;
            if (fill)
                s->list[fill[v]++] = seen;
            else
                s->start[v + 1]++;
        }
    }
}

/* A lid that went with brow and cheek half of the way would not shut: where its own bones reach, they go first. */
static void let_lids_go_first(state *s, uint32_t v)
{
    float lid = 0;

    for (uint32_t i = s->start[v]; i < s->start[v + 1]; i++)
        if (is_lid(s->corner[s->list[i].bone]))
            lid = fmaxf(lid, s->list[i].weight);
    for (uint32_t i = s->start[v]; i < s->start[v + 1]; i++)
        if (!is_lid(s->corner[s->list[i].bone]))
            s->list[i].weight *= 1 - lid;
}

/* Eq. 11 needs weights that sum to one; what bones leave over stays where it is. */
static void share_out(state *s, uint32_t vertex_count)
{
    for (uint32_t v = 0; v < vertex_count; v++) {
        float sum = 0;
        let_lids_go_first(s, v);
        for (uint32_t i = s->start[v]; i < s->start[v + 1]; i++)
            sum += s->list[i].weight;
        for (uint32_t i = s->start[v]; i < s->start[v + 1] && sum > 1; i++)
            s->list[i].weight /= sum;
    }
}

static int list_influences(state *s, const fap_face *face, fap_graph *g)
{
    const uint32_t n = face->mesh->vertex_count;

    s->start = fap_mem_calloc(&face->alloc, (size_t)n + 1, sizeof *s->start);
    uint32_t *fill = fap_mem_calloc(&face->alloc, n, sizeof *fill);
    if (s->start && fill) {
        look(s, face, g, NULL);
        for (uint32_t v = 0; v < n; v++)
            s->start[v + 1] += s->start[v];
        memcpy(fill, s->start, n * sizeof *fill);
        s->list = fap_mem_calloc(&face->alloc, (size_t)s->start[n] + 1, sizeof *s->list);
    }
    if (s->list && fill) {
        look(s, face, g, fill);
        share_out(s, n);
    }
    fap_mem_free(&face->alloc, fill);
    return !s->list;
}

static int open_bones(void *user, const fap_face *face)
{
    state *s = user;
    fap_graph graph;
    int failed = fap_graph_open(&graph, face->bank, &face->alloc);

    find_corners(s, face);
    list_bones(s, face);
    failed = failed || list_influences(s, face, &graph);
    fap_graph_close(&graph, &face->alloc);
    return failed;
}

static void close_bones(void *user, const fap_face *face)
{
    state *s = user;

    fap_mem_free(&face->alloc, s->start);
    fap_mem_free(&face->alloc, s->list);
}

/* --- this frame --- */

/* Commanded axes go where they should, others with the point they follow. */
static void find_ways(state *s, const fap_face *face)
{
    memset(s->way, 0, sizeof s->way);
    for (int r = 0; r < face->row_count; r++) {
        const int row = face->row[r];
        s->way[row / 3][row % 3] =
            fap_blend_row_target(face, row) - fap_face_row_motion(face, row, face->weight);
    }
    for (int i = 0; i < s->follower_count; i++) {
        const fap_bone_follower *f = &s->follower[i];
        for (int axis = 0; axis < 3; axis++)
            if (!face->wanted[f->point][axis] && s->way[f->point][axis] == 0)
                s->way[f->point][axis] = f->share * s->way[f->leader][axis];
    }
    for (int i = 0; i < FAP_BONE_HYPOTHETICAL; i++)
        mix(s->way[s->between[i].end], s->way[s->between[i].middle], s->share[i],
            s->way[FAP_POINT_COUNT + i]);
}

static void solve_bones(void *user, fap_face *face)
{
    for (int i = 0; i < face->base_count; i++)
        face->weight[face->base_key[i]] = face->base_weight[i];
    find_ways(user, face);
}

/* A bone that a frame folds to a line stays at rest. */
static void move_bones(state *s)
{
    for (int i = 0; i < s->bone_count; i++) {
        float corner[3][3];
        s->moves[i] = 0;
        for (int c = 0; c < 3; c++)
            for (int axis = 0; axis < 3; axis++) {
                const float way = s->way[s->corner[i][c]][axis];
                corner[c][axis] = s->rest[s->corner[i][c]][axis] + way;
                s->moves[i] |= way != 0;
            }
        if (!fap_planar_bone_set(&s->bone[i], (const float(*)[3])corner))
            set_bone(s, i);
    }
}

static void carry_vertex(const state *s, const fap_face *face, uint32_t v, float way[3])
{
    float rest[3];

    place_of(face, v, rest);
    memset(way, 0, 3 * sizeof *way);
    for (uint32_t i = s->start[v]; i < s->start[v + 1]; i++) {
        float at[3];
        if (!s->moves[s->list[i].bone])
            continue;
        fap_planar_bone_carry(&s->bone[s->list[i].bone], &s->list[i].place, at);
        for (int axis = 0; axis < 3; axis++)
            way[axis] += s->list[i].weight * (at[axis] - rest[axis]);
    }
    for (int axis = 0; axis < 3; axis++)
        way[axis] = fminf(farthest_mm, fmaxf(-farthest_mm, way[axis]));
}

static void shape_bones(void *user, fap_face *face, float *position)
{
    state *s = user;
    const float *chin = s->way[face->chin_row / 3];
    const size_t stride = face->mesh->stride;

    move_bones(s);
    for (uint32_t v = 0; v < face->mesh->vertex_count; v++) {
        const int part = face->mesh->part[v];
        float way[3] = { 0 };
        if (part == FAP_PART_TEETH_LOWER || part == FAP_PART_TONGUE)
            memcpy(way, chin, sizeof way);
        else
            carry_vertex(s, face, face->follows[v], way);
        for (size_t axis = 0; axis < 3; axis++)
            position[axis * stride + v] += way[axis];
    }
}

const fap_blend_method fap_blend_bones = {
    .name = "bones",
    .summary = "feature points alone, as corners of planar bones",
    .state_size = sizeof(state),
    .open = open_bones,
    .close = close_bones,
    .solve = solve_bones,
    .shape = shape_bones,
};
