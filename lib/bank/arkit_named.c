/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Coefficients to what MPEG-4 has names for: the viseme or mix of two, the expression or two, that comes nearest. All pairs
 * are tried; there are few. Near is meant in square millimetres of FAPs on a typical face. See fap/facs.h.
 */
#include <math.h>
#include <string.h>

#include <fap/facs.h>
#include <fap/tables.h>

#include "bank/arkit_fit.h"

/* A face that moves less than this has no name. */
static const double least_mm2 = 0.05;

enum { FULL = 63 };

static void faps_of(const fap_arkit_fit *f, const fap_arkit *in, float *faps)
{
    memset(faps, 0, (FAP_COUNT + 1) * sizeof *faps);
    for (int s = 0; s < FAP_ARKIT_COUNT; s++) {
        const float share = isfinite(in->shape[s]) ? in->shape[s] : 0;
        for (int fap = 3; share != 0 && fap <= FAP_COUNT; fap++)
            faps[fap] += share * f->value[s][fap];
    }
}

void arkit_fit_name(fap_arkit_fit *f)
{
    fap_arkit a;

    memset(&a, 0, sizeof a);
    for (int v = 0; v < ARKIT_VISEMES; v++) {
        fap_viseme_to_arkit(v, &a);
        faps_of(f, &a, f->viseme[v]);
    }
    for (int e = 0; e < ARKIT_EXPRESSIONS; e++) {
        fap_expression_to_arkit(e, &a);
        faps_of(f, &a, f->expression[e]);
    }
}

/* Jaw, chin, inner and outer lips, tongue. */
static int is_mouth(int fap)
{
    const int group = fap_info_get(fap)->group;
    return group == 2 || group == 6 || group == 8;
}

static double product(const fap_arkit_fit *f, const float *a, const float *b, int mouth_only)
{
    double sum = 0;

    for (int fap = 3; fap <= FAP_COUNT; fap++)
        if (!mouth_only || is_mouth(fap))
            sum += f->price[fap] * (double)a[fap] * (double)b[fap];
    return sum;
}

static double share(double x)
{
    return fmin(1, fmax(0, x));
}

/* All inner products of the names with one another, and with the face that is to be named. */
typedef struct products {
    int count;
    double own[ARKIT_VISEMES][ARKIT_VISEMES], with[ARKIT_VISEMES], square;
} products;

static void multiply(products *p, const fap_arkit_fit *f, const float (*name)[FAP_COUNT + 1], int count,
                     const float *face, int mouth_only)
{
    p->count = count;
    p->square = product(f, face, face, mouth_only);
    for (int i = 0; i < count; i++) {
        p->with[i] = product(f, name[i], face, mouth_only);
        for (int k = 0; k <= i; k++)
            p->own[i][k] = p->own[k][i] = product(f, name[i], name[k], mouth_only);
    }
}

/* What is left of the face beside a and b of names i and k. */
static double left(const products *p, int i, int k, double a, double b)
{
    return p->square - 2 * (a * p->with[i] + b * p->with[k]) + a * a * p->own[i][i] + b * b * p->own[k][k] +
           2 * a * b * p->own[i][k];
}

static float left_share(const products *p, double least)
{
    return (float)sqrt(fmax(0, least) / p->square);
}

/* --- visemes: a share of one and the rest of the other --- */

/* The best share of i beside k, 0 to 63. */
static int best_blend(const products *p, int i, int k)
{
    const double apart = p->own[i][i] + p->own[k][k] - 2 * p->own[i][k];
    const double along = p->with[i] - p->with[k] + p->own[k][k] - p->own[i][k];

    return apart > 0 ? (int)lround(FULL * share(along / apart)) : FULL;
}

float fap_arkit_to_viseme(fap_arkit_fit *fit, const fap_arkit *in, fap_viseme *out)
{
    float face[FAP_COUNT + 1];
    products p;
    double least;

    memset(out, 0, sizeof *out);
    out->blend = FULL;
    faps_of(fit, in, face);
    multiply(&p, fit, (const float(*)[FAP_COUNT + 1]) fit->viseme, ARKIT_VISEMES, face, 1);
    if (p.square < least_mm2)
        return 0;
    least = p.square;
    for (int i = 1; i < ARKIT_VISEMES; i++)
        for (int k = 0; k < i; k++) {
            const int blend = best_blend(&p, i, k);
            const double rest = left(&p, i, k, blend / (double)FULL, 1 - blend / (double)FULL);
            if (rest < least) {
                least = rest;
                out->select1 = (uint8_t)i;
                out->select2 = (uint8_t)k;
                out->blend = (uint8_t)blend;
            }
        }
    return left_share(&p, least);
}

/* --- expressions: so much of one and so much of another --- */

/* The best shares of i and k within 0 to 1. */
static void best_pair(const products *p, int i, int k, double *a, double *b)
{
    const double det = p->own[i][i] * p->own[k][k] - p->own[i][k] * p->own[i][k];

    *a = share(det > 0 ? (p->with[i] * p->own[k][k] - p->with[k] * p->own[i][k]) / det : 0);
    for (int round = 0; round < 2; round++) { /* where a limit was met the other one moves along it */
        *b = share((p->with[k] - *a * p->own[i][k]) / p->own[k][k]);
        *a = share((p->with[i] - *b * p->own[i][k]) / p->own[i][i]);
    }
}

float fap_arkit_to_expression(fap_arkit_fit *fit, const fap_arkit *in, fap_expression *out)
{
    float face[FAP_COUNT + 1];
    products p;

    memset(out, 0, sizeof *out);
    faps_of(fit, in, face);
    multiply(&p, fit, (const float(*)[FAP_COUNT + 1]) fit->expression, ARKIT_EXPRESSIONS, face, 0);
    if (p.square < least_mm2)
        return 0;
    double least = p.square;
    for (int i = 1; i < ARKIT_EXPRESSIONS; i++)
        for (int k = 1; k < ARKIT_EXPRESSIONS; k++) {
            double a, b;
            if (i == k)
                continue;
            best_pair(&p, i, k, &a, &b);
            const int one = (int)lround(FULL * a), two = (int)lround(FULL * b);
            const double rest = left(&p, i, k, one / (double)FULL, two / (double)FULL);
            if (one < two || rest >= least)
                continue;
            least = rest;
            *out = (fap_expression){ .select1 = (uint8_t)(one ? i : 0),
                                     .intensity1 = (uint8_t)one,
                                     .select2 = (uint8_t)(two ? k : 0),
                                     .intensity2 = (uint8_t)two };
        }
    return left_share(&p, least);
}
