/* SPDX-License-Identifier: BSD-2-Clause */
/* See warp.h. */
#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "registration/warp.h"

enum { AFFINE = 4 };

static double distance2(const double a[3], const double b[3], int axes)
{
    double sum = 0;

    for (int i = 0; i < axes; i++)
        sum += (a[i] - b[i]) * (a[i] - b[i]);
    return sum;
}

static int axes_of(const warp *w)
{
    return w->kernel == WARP_THIN_PLATE ? 2 : 3;
}

static double kernel_at(const warp *w, uint32_t i, const double at[3])
{
    const double r2 = distance2(w->centre[i], at, axes_of(w));

    switch (w->kernel) {
    case WARP_HARDY: return sqrt(r2 + w->stiffness[i] * w->stiffness[i]);
    case WARP_THIN_PLATE: return r2 > 0 ? r2 * log(r2) / 2 : 0;
    default: return sqrt(r2);
    }
}

/* Eq. 4.3. */
static void find_stiffness(warp *w)
{
    for (uint32_t i = 0; i < w->count; i++) {
        double least = INFINITY;
        for (uint32_t k = 0; k < w->count; k++)
            if (k != i)
                least = fmin(least, distance2(w->centre[i], w->centre[k], 3));
        w->stiffness[i] = isfinite(least) ? sqrt(least) : 0;
    }
}

/* What keeps the slack from pulling the wrong way: these kernels are negative definite beside their affine part. */
static double slack_sign(warp_kernel kernel)
{
    return kernel == WARP_THIN_PLATE ? 1 : -1;
}

/* Rows: the centres, then the affine part's four conditions; columns the same, then three right sides. */
static void fill(const warp *w, double *m, uint32_t stride, const double (*move)[3], const double *weight,
                 double slack)
{
    const uint32_t n = w->count;
    const int axes = axes_of(w);

    for (uint32_t i = 0; i < n; i++) {
        double *row = m + (size_t)i * stride;
        for (uint32_t k = 0; k < n; k++)
            row[k] = kernel_at(w, k, w->centre[i]);
        row[i] += slack_sign(w->kernel) * slack / (weight ? weight[i] : 1);
        for (int a = 0; a <= axes; a++) {
            const double value = a ? w->centre[i][a - 1] : 1;
            row[n + (uint32_t)a] = value;
            m[(size_t)(n + (uint32_t)a) * stride + i] = value;
        }
        memcpy(row + n + AFFINE, move[i], sizeof move[i]);
    }
    if (axes == 2) /* z has no part in a plane */
        m[(size_t)(n + 3) * stride + n + 3] = 1;
}

/* Rows change places so that the largest of what is left stands on the diagonal; 0: there is none. */
static int eliminate(double *m, uint32_t stride, uint32_t size)
{
    for (uint32_t c = 0; c < size; c++) {
        uint32_t best = c;
        for (uint32_t r = c + 1; r < size; r++)
            if (fabs(m[(size_t)r * stride + c]) > fabs(m[(size_t)best * stride + c]))
                best = r;
        double *pivot = m + (size_t)c * stride, *other = m + (size_t)best * stride;
        if (!(fabs(other[c]) > 1e-10))
            return 0;
        for (uint32_t k = c; best != c && k < stride; k++) {
            const double kept = pivot[k];
            pivot[k] = other[k];
            other[k] = kept;
        }
        for (uint32_t r = c + 1; r < size; r++) {
            double *row = m + (size_t)r * stride;
            const double factor = row[c] / pivot[c];
            for (uint32_t k = c; factor != 0 && k < stride; k++)
                row[k] -= factor * pivot[k];
        }
    }
    return 1;
}

static void substitute(warp *w, const double *m, uint32_t stride, uint32_t size)
{
    for (uint32_t r = size; r-- > 0;) {
        const double *row = m + (size_t)r * stride;
        double *out = r < w->count ? w->weight[r] : w->affine[r - w->count];
        for (int a = 0; a < 3; a++) {
            double sum = row[size + (uint32_t)a];
            for (uint32_t k = r + 1; k < size; k++)
                sum -= row[k] * (k < w->count ? w->weight[k] : w->affine[k - w->count])[a];
            out[a] = sum / row[r];
        }
    }
}

fap_err warp_open(warp *w, warp_kernel kernel, const double (*centre)[3], const double (*move)[3],
                  const double *weight, uint32_t count, double slack, const fap_allocator *alloc)
{
    const uint32_t size = count + AFFINE, stride = size + 3;
    double *m = fap_mem_calloc(alloc, (size_t)size * stride, sizeof *m);

    *w = (warp){ .kernel = kernel,
                 .count = count,
                 .centre = fap_mem_calloc(alloc, count, sizeof *w->centre),
                 .stiffness = fap_mem_calloc(alloc, count, sizeof *w->stiffness),
                 .weight = fap_mem_calloc(alloc, count, sizeof *w->weight) };
    fap_err err = m && w->centre && w->stiffness && w->weight ? FAP_OK : FAP_E_NOMEM;
    if (err == FAP_OK) {
        memcpy(w->centre, centre, count * sizeof *centre);
        find_stiffness(w);
        fill(w, m, stride, move, weight, slack);
        err = eliminate(m, stride, size) ? FAP_OK : FAP_E_DATA;
    }
    if (err == FAP_OK)
        substitute(w, m, stride, size);
    else
        warp_close(w, alloc);
    fap_mem_free(alloc, m);
    return err;
}

void warp_close(warp *w, const fap_allocator *alloc)
{
    fap_mem_free(alloc, w->centre);
    fap_mem_free(alloc, w->stiffness);
    fap_mem_free(alloc, w->weight);
    *w = (warp){ 0 };
}

void warp_move(const warp *w, const double at[3], double move[3])
{
    for (int a = 0; a < 3; a++)
        move[a] =
            w->affine[0][a] + at[0] * w->affine[1][a] + at[1] * w->affine[2][a] + at[2] * w->affine[3][a];
    for (uint32_t i = 0; i < w->count; i++) {
        const double k = kernel_at(w, i, at);
        for (int a = 0; a < 3; a++)
            move[a] += k * w->weight[i][a];
    }
}
