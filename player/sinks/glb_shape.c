/* SPDX-License-Identifier: BSD-2-Clause */
/* See glb_shape.h. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/jacobi.h"
#include "player/sinks/glb_shape.h"

enum { MOST_CORRECTIONS = 48, LEARNING_ROOM = 96 };
static const float tolerance_mm = 0.02f;
static const size_t most_memory = (size_t)256 << 20;

/* --- life --- */

int glb_shape_open(glb_shape *s, const fap_bank *bank, const glb_rig *rig)
{
    const fap_mesh *mesh = fap_bank_mesh(bank);

    *s = (glb_shape){ .bank = bank, .mesh = mesh, .rig = rig, .length = 3 * (size_t)mesh->stride };
    const size_t fit = most_memory / (s->length * sizeof(float));
    s->room = fit < LEARNING_ROOM ? (int)(fit > 2 ? fit : 2) : LEARNING_ROOM;
    const size_t room = (size_t)s->room;
    s->key_count = fap_bank_key_count(bank);
    s->correction = calloc(room * s->length, sizeof *s->correction);
    s->norm = calloc(room, sizeof *s->norm);
    s->gram = calloc(room * room, sizeof *s->gram);
    s->work = calloc(2 * room * room + 2 * room, sizeof *s->work);
    s->wanted = calloc(s->length, sizeof *s->wanted);
    s->rest = calloc(s->length, sizeof *s->rest);
    s->share = calloc((size_t)s->key_count + 1, sizeof *s->share);
    return s->share && s->correction && s->norm && s->gram && s->work && s->wanted && s->rest;
}

void glb_shape_close(glb_shape *s)
{
    free(s->correction);
    free(s->norm);
    free(s->gram);
    free(s->work);
    free(s->wanted);
    free(s->rest);
    free(s->share);
    *s = (glb_shape){ 0 };
}

/* --- key models --- */

static int is_eyeball(const glb_shape *s, uint32_t v)
{
    return s->rig->hold[v].joint[0] > JOINT_HEAD;
}

static void add_block(const fap_mesh *mesh, uint32_t block, const int16_t *delta, float scale, float *shape)
{
    for (size_t axis = 0; axis < 3; axis++)
        for (size_t i = 0; i < FAP_BLOCK; i++)
            shape[axis * mesh->stride + block * FAP_BLOCK + i] += scale * delta[axis * FAP_BLOCK + i];
}

static void add_key(const glb_shape *s, int k, float weight, float *shape)
{
    const fap_key *key = fap_bank_key_get(s->bank, k);

    for (uint32_t b = 0; weight != 0 && b < key->block_count; b++)
        add_block(s->mesh, key->block[b], key->delta + (size_t)b * 3 * FAP_BLOCK, weight * key->scale_mm,
                  shape);
}

/* Eyeballs are rigid: the player undoes what keys do to them, and so must targets. */
static void still_eyeballs(const glb_shape *s, float *shape)
{
    for (uint32_t v = 0; v < s->mesh->vertex_count; v++)
        for (size_t axis = 0; is_eyeball(s, v) && axis < 3; axis++)
            shape[axis * s->mesh->stride + v] = 0;
}

static void add_keys(const glb_shape *s, const float *weight, float *shape)
{
    for (int k = 0; k < s->key_count; k++)
        add_key(s, k, weight[k], shape);
    still_eyeballs(s, shape);
}

/* --- what is left --- */

/* s->wanted: motion of every vertex in coordinates that no joint has turned. */
static void free_of_joints(glb_shape *s, const float *position, const glb_affine affine[JOINT_COUNT])
{
    const size_t stride = s->mesh->stride;

    for (uint32_t v = 0; v < s->mesh->vertex_count; v++) {
        const glb_affine a = glb_rig_affine(s->rig, affine, v);
        const float p[3] = { position[v], position[stride + v], position[2 * stride + v] };
        float out[3];
        glb_affine_undo(&a, p, out);
        for (size_t axis = 0; axis < 3; axis++)
            s->wanted[axis * stride + v] = out[axis] - s->mesh->position[axis * stride + v];
    }
}

/* s->rest: what weights of keys leave of it. */
static void free_of_keys(glb_shape *s, const float *weight)
{
    memset(s->rest, 0, s->length * sizeof *s->rest);
    for (int k = 0; k < s->key_count; k++)
        s->share[k] = fminf(1, fmaxf(0, weight[k]));
    add_keys(s, s->share, s->rest);
    for (size_t i = 0; i < s->length; i++)
        s->rest[i] = s->wanted[i] - s->rest[i];
}

static double product(const float *a, const float *b, size_t n)
{
    double sum = 0;

    for (size_t i = 0; i < n; i++)
        sum += (double)a[i] * b[i];
    return sum;
}

static void add_scaled(float *out, const float *a, float scale, size_t n)
{
    for (size_t i = 0; i < n; i++)
        out[i] += scale * a[i];
}

static float square_at(const glb_shape *s, const float *shape, uint32_t v)
{
    const float x = shape[v], y = shape[s->mesh->stride + v], z = shape[2 * s->mesh->stride + v];
    return x * x + y * y + z * z;
}

static float farthest(const glb_shape *s, const float *shape)
{
    float most = 0;

    for (uint32_t v = 0; v < s->mesh->vertex_count; v++)
        most = fmaxf(most, square_at(s, shape, v));
    return sqrtf(most);
}

static float *correction_at(const glb_shape *s, int c)
{
    return s->correction + (size_t)c * s->length;
}

/* --- principal directions of what was seen --- */

/* Corrections become mixes of themselves: new c = sum of turn[c][i] * old i. */
static void mix_corrections(glb_shape *s, const double *turn, const int *order, int count)
{
    const int n = s->correction_count;
    float old[LEARNING_ROOM];

    for (size_t e = 0; e < s->length; e++) {
        for (int i = 0; i < n; i++)
            old[i] = correction_at(s, i)[e];
        for (int c = 0; c < count; c++) {
            const double *row = turn + (size_t)order[c] * (size_t)n;
            double sum = 0;
            for (int i = 0; i < n; i++)
                sum += row[i] * old[i];
            correction_at(s, c)[e] = (float)sum;
        }
    }
}

/* Indices of the diagonal, the largest first. */
static void sort_diagonal(const double *g, int n, int *order)
{
    for (int i = 0; i < n; i++) {
        int at = i;
        for (; at > 0 && g[(size_t)order[at - 1] * (size_t)(n + 1)] < g[(size_t)i * (size_t)(n + 1)]; at--)
            order[at] = order[at - 1];
        order[at] = i;
    }
}

/* Turns corrections so that the first do most, and keeps @most of them. */
static void turn_corrections(glb_shape *s, int most)
{
    const int n = s->correction_count, kept = n < most ? n : most;
    double *g = s->work, *turn = g + (size_t)n * (size_t)n;
    int order[LEARNING_ROOM];

    memset(turn, 0, (size_t)n * (size_t)n * sizeof *turn);
    for (int i = 0; i < n; i++)
        for (int k = 0; k < n; k++)
            g[i * n + k] = s->gram[i * s->room + k];
    fap_jacobi(g, turn, (size_t)n);
    sort_diagonal(g, n, order);
    mix_corrections(s, turn, order, kept);
    memset(s->gram, 0, (size_t)s->room * (size_t)s->room * sizeof *s->gram);
    for (int c = 0; c < kept; c++)
        s->gram[c * s->room + c] = g[(size_t)order[c] * (size_t)(n + 1)];
    s->correction_count = kept;
}

/* --- learning --- */

static void add_correction(glb_shape *s)
{
    const double length = sqrt(product(s->rest, s->rest, s->length));
    float *new = correction_at(s, s->correction_count++);

    memset(new, 0, s->length * sizeof *new);
    add_scaled(new, s->rest, (float)(1 / length), s->length);
}

/* Coefficients of s->rest, which loses what corrections say. */
static void project(glb_shape *s, double *coefficient)
{
    for (int c = 0; c < s->correction_count; c++) {
        coefficient[c] = product(s->rest, correction_at(s, c), s->length);
        add_scaled(s->rest, correction_at(s, c), -(float)coefficient[c], s->length);
    }
}

static void count_coefficients(glb_shape *s, const double *coefficient)
{
    for (int i = 0; i < s->correction_count; i++)
        for (int k = 0; k < s->correction_count; k++)
            s->gram[i * s->room + k] += coefficient[i] * coefficient[k];
}

void glb_shape_learn(glb_shape *s, const float *position, const float *weight,
                     const glb_affine affine[JOINT_COUNT])
{
    double *coefficient = s->work + 2 * (size_t)s->room * (size_t)s->room, *again = coefficient + s->room;

    if (s->correction_count == s->room)
        turn_corrections(s, s->room / 2);
    free_of_joints(s, position, affine);
    free_of_keys(s, weight);
    project(s, coefficient);
    if (farthest(s, s->rest) > tolerance_mm) {
        project(s, again); /* twice is enough: rounding leaves corrections orthogonal */
        add_correction(s);
        coefficient[s->correction_count - 1] =
            product(s->rest, correction_at(s, s->correction_count - 1), s->length);
    }
    count_coefficients(s, coefficient);
}

/* Scaled so that no frame asks for more than 1 or less than -1: a shape of a size that can be looked at. */
static void scale_correction(glb_shape *s, int c)
{
    const float most = (float)sqrt(s->gram[c * s->room + c]);
    float *v = correction_at(s, c);

    for (size_t i = 0; i < s->length; i++)
        v[i] *= most;
    s->norm[c] = most * most;
}

/* No frame asks for more of a direction than the root of all frames' squares. */
static float reach_of(const glb_shape *s, int c)
{
    return (float)sqrt(s->gram[c * s->room + c]) * farthest(s, correction_at(s, c));
}

void glb_shape_settle(glb_shape *s)
{
    if (!s->correction_count)
        return;
    turn_corrections(s, MOST_CORRECTIONS);
    while (s->correction_count && reach_of(s, s->correction_count - 1) < tolerance_mm / 4)
        s->correction_count--;
    for (int c = 0; c < s->correction_count; c++)
        scale_correction(s, c);
}

/* --- fitting --- */

void glb_shape_fit(glb_shape *s, const float *position, const float *weight,
                   const glb_affine affine[JOINT_COUNT], float *target_weight, double *worst_mm,
                   double *square_mm2)
{
    double sum = 0;

    free_of_joints(s, position, affine);
    free_of_keys(s, weight);
    memcpy(target_weight, s->share, (size_t)s->key_count * sizeof *weight);
    for (int c = 0; c < s->correction_count; c++) {
        const float w = (float)(product(s->rest, correction_at(s, c), s->length) / s->norm[c]);
        target_weight[s->key_count + c] = w;
        add_scaled(s->rest, correction_at(s, c), -w, s->length);
    }
    for (uint32_t v = 0; v < s->mesh->vertex_count; v++)
        sum += square_at(s, s->rest, v);
    *worst_mm = farthest(s, s->rest);
    *square_mm2 = sum / s->mesh->vertex_count;
}

/* --- within 0 and 1 --- */

static void find_span(const float *weight, uint32_t frame_count, int target_count, float *least, float *span)
{
    float most = weight[0];

    *least = weight[0];
    for (uint32_t i = 1; i < frame_count; i++) {
        const float w = weight[(size_t)i * (size_t)target_count];
        *least = fminf(*least, w);
        most = fmaxf(most, w);
    }
    *span = most - *least;
}

void glb_shape_fold(glb_shape *s, float *weight, uint32_t frame_count, int target_count)
{
    memset(s->rest, 0, s->length * sizeof *s->rest);
    for (int c = 0; c < s->correction_count; c++) {
        float *of = weight + s->key_count + c, *v = correction_at(s, c), least, span;
        find_span(of, frame_count, target_count, &least, &span);
        add_scaled(s->rest, v, least, s->length);
        for (uint32_t i = 0; i < frame_count; i++) {
            float *w = of + (size_t)i * (size_t)target_count;
            *w = span > 0 ? fminf(1, (*w - least) / span) : 0;
        }
        for (size_t i = 0; i < s->length; i++)
            v[i] *= span;
    }
    for (uint32_t i = 0; s->correction_count && i < frame_count; i++)
        weight[(size_t)i * (size_t)target_count + (size_t)(target_count - 1)] = 1;
}

int glb_shape_target_count(const glb_shape *s)
{
    return s->key_count + s->correction_count + (s->correction_count > 0);
}

void glb_shape_target(const glb_shape *s, int target, float *motion)
{
    const int c = target - s->key_count;

    memset(motion, 0, s->length * sizeof *motion);
    if (c >= 0) {
        memcpy(motion, c < s->correction_count ? correction_at(s, c) : s->rest, s->length * sizeof *motion);
        return;
    }
    add_key(s, target, 1, motion);
    still_eyeballs(s, motion);
}
