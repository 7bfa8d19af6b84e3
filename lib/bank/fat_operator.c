/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * See fat_operator.h. Weights of all keys are taken as independent and equally wide; lambda keeps what the keys can hardly
 * tell apart from being blown up. Source: Gauss and Markov (linear estimate of a part from a part).
 */
#include <math.h>
#include <string.h>

#include "bank/fat_operator.h"
#include "base/mem.h"

/* Square millimetres to a full weight squared. Mean error of mixtures against the solver: see docs/fat.md. */
static const double lambda_mm2 = 4;
static const float rare_close = 0.3f; /* lips seldom close over an open jaw: this much of a full weight */

static int is_row(const fap_face *face, const fap_info *info)
{
    return info->motion >= FAP_MOTION_X && info->motion <= FAP_MOTION_Z && info->point >= 0 &&
           face->solvable[info->point];
}

static void list_rows(fat_operator *op, const fap_face *face)
{
    for (int fap = 3; fap <= FAP_COUNT; fap++) {
        const fap_info *info = fap_info_get(fap);
        if (!is_row(face, info))
            continue;
        const int i = op->row_count++;
        op->fap[i] = (uint8_t)fap;
        op->point[i] = (uint8_t)info->point;
        op->axis[i] = (uint8_t)(info->motion - FAP_MOTION_X);
        op->sign[i] = info->sign;
        op->step_mm[i] = fap_fapu_step(fap_bank_fapu(face->bank), (fap_unit)info->unit);
    }
}

static int has_units(const fap_face *face)
{
    for (int k = 0; k < face->key_count; k++)
        if (face->key[k]->kind == FAP_KEY_UNIT)
            return 1;
    return 0;
}

/* Gaze has FAPs of its own, and tables of its own. */
static int is_gaze(const fap_face *face, int k)
{
    const fap_face_keys *n = &face->known;

    for (int side = 0; side < 2; side++)
        if (k == n->look_up[side] || k == n->look_down[side] || k == n->look_in[side] ||
            k == n->look_out[side])
            return 1;
    return 0;
}

/* Lips close over a jaw that is open, never over one that is shut: the two are one variable. */
static int closes_over_jaw(const fap_face *face, int k)
{
    return k == face->known.mouth_close && face->known.jaw_open >= 0;
}

static void fill_effects(fat_operator *op, const fap_face *face)
{
    const int units = has_units(face);

    for (int i = 0; i < op->row_count; i++) {
        const float *motion =
            face->motion + (size_t)(3 * op->point[i] + op->axis[i]) * (size_t)face->key_count;
        float *effect = op->effect + (size_t)i * (size_t)op->key_count;
        for (int k = 0; k < op->key_count; k++) {
            if ((units && face->key[k]->kind != FAP_KEY_UNIT) || is_gaze(face, k))
                continue;
            effect[k] = op->sign[i] * (closes_over_jaw(face, k)
                                           ? rare_close * (motion[k] + motion[face->known.jaw_open])
                                           : motion[k]);
        }
    }
}

static void fill_covariance(fat_operator *op)
{
    for (int i = 0; i < op->row_count; i++)
        for (int j = 0; j < op->row_count; j++) {
            const float *a = op->effect + (size_t)i * (size_t)op->key_count;
            const float *b = op->effect + (size_t)j * (size_t)op->key_count;
            double sum = i == j ? lambda_mm2 : 0;
            for (int k = 0; k < op->key_count; k++)
                sum += (double)a[k] * b[k];
            op->covariance[i][j] = sum;
        }
}

/* S = L L'. It is never singular, thanks to lambda. */
static void factorise(fat_operator *op)
{
    for (int i = 0; i < op->row_count; i++)
        for (int j = 0; j <= i; j++) {
            double sum = op->covariance[i][j];
            for (int k = 0; k < j; k++)
                sum -= op->factor[i][k] * op->factor[j][k];
            op->factor[i][j] = i == j ? sqrt(fmax(sum, 1e-9)) : sum / op->factor[j][j];
        }
}

int fat_operator_open(fat_operator *op, const fap_face *face)
{
    memset(op, 0, sizeof *op);
    op->key_count = face->key_count;
    list_rows(op, face);
    op->effect =
        fap_mem_calloc(&face->alloc, (size_t)(op->row_count + 1) * (size_t)op->key_count, sizeof *op->effect);
    if (!op->effect)
        return 1;
    fill_effects(op, face);
    fill_covariance(op);
    factorise(op);
    return 0;
}

void fat_operator_close(fat_operator *op, const fap_face *face)
{
    fap_mem_free(&face->alloc, op->effect);
    op->effect = NULL;
}

/* x = S^-1 e */
static void solve(const fat_operator *op, int row, double x[FAP_COUNT])
{
    for (int i = 0; i < op->row_count; i++) {
        x[i] = i == row;
        for (int k = 0; k < i; k++)
            x[i] -= op->factor[i][k] * x[k];
        x[i] /= op->factor[i][i];
    }
    for (int i = op->row_count - 1; i >= 0; i--) {
        for (int k = i + 1; k < op->row_count; k++)
            x[i] -= op->factor[k][i] * x[k];
        x[i] /= op->factor[i][i];
    }
}

void fat_operator_weights(const fat_operator *op, const fap_face *face, int row, float *weight)
{
    double x[FAP_COUNT];

    solve(op, row, x);
    for (int k = 0; k < op->key_count; k++) {
        double sum = 0;
        for (int i = 0; i < op->row_count; i++)
            sum += x[i] * op->effect[(size_t)i * (size_t)op->key_count + (size_t)k];
        weight[k] = (float)sum;
    }
    for (int k = 0; k < op->key_count; k++)
        if (closes_over_jaw(face, k)) {
            weight[k] *= rare_close;
            weight[face->known.jaw_open] += weight[k];
        }
}

int fat_operator_row(const fat_operator *op, int fap)
{
    for (int i = 0; i < op->row_count; i++)
        if (op->fap[i] == fap)
            return i;
    return -1;
}

double fat_operator_share(const fat_operator *op, int row, int leader, double *alike)
{
    const double both = op->covariance[row][leader], own = op->covariance[row][row],
                 other = op->covariance[leader][leader];

    *alike = both / sqrt(own * other);
    return both / other;
}
