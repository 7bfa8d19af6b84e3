/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * FACS, visemes and expressions as ARKit's coefficients: weighted sums of the tables' rows. See fap/facs.h.
 */
#include <math.h>
#include <string.h>

#include <fap/facs.h>

#include "gen/facs.h"
#include "gen/facs_expressions.h"
#include "gen/facs_units.h"
#include "gen/key_models.h"
#include "param/arkit.h"

static const char *const names[FAP_FACS_MAX_NUMBER + 1] = {
#define X(unit, label, name) [unit] = name,
    FACS_UNITS_ROWS(X)
#undef X
};

static const struct share {
    uint8_t unit, shape, percent;
} shares[] = {
#define X(unit, shape, percent) { unit, SHAPE_##shape, percent },
    FACS_ROWS(X)
#undef X
};

static const struct recipe {
    uint8_t expression, unit, percent;
} recipes[] = {
#define X(expression, unit, percent) { expression, unit, percent },
    FACS_EXPRESSIONS_ROWS(X)
#undef X
};

enum { VISEME, EXPRESSION, EXTRA };

static const struct key {
    uint8_t kind, number;
    const char *shape;
    uint8_t percent;
} keys[] = {
#define X(kind, number, name, shape, percent) { kind, number, shape, percent },
    KEY_MODELS_ROWS(X)
#undef X
};

#define COUNT(array) (sizeof(array) / sizeof *(array))

const char *fap_facs_name(int unit)
{
    return unit >= 0 && unit <= FAP_FACS_MAX_NUMBER ? names[unit] : NULL;
}

float fap_facs_share(int unit, int shape)
{
    for (size_t i = 0; i < COUNT(shares); i++)
        if (shares[i].unit == unit && shares[i].shape == shape)
            return shares[i].percent / 100.0f;
    return 0;
}

static float number(float value)
{
    return isfinite(value) ? value : 0;
}

void fap_facs_to_arkit(const fap_facs *in, fap_arkit *out)
{
    memset(out->shape, 0, sizeof out->shape);
    for (size_t i = 0; i < COUNT(shares); i++)
        out->shape[shares[i].shape] += number(in->unit[shares[i].unit]) * shares[i].percent / 100;
    for (int s = 0; s < FAP_ARKIT_COUNT; s++)
        out->shape[s] = fminf(1, out->shape[s]);
}

/* --- coefficients to units --- */

typedef struct fit {
    float share[FAP_FACS_MAX_NUMBER + 1][FAP_ARKIT_COUNT];
    float square[FAP_FACS_MAX_NUMBER + 1]; /* 0: no such unit */
    float left[FAP_ARKIT_COUNT];           /* what no unit explains yet */
} fit;

static void fill(fit *f, const fap_arkit *in)
{
    memset(f, 0, sizeof *f);
    for (size_t i = 0; i < COUNT(shares); i++) {
        const float share = shares[i].percent / 100.0f;
        f->share[shares[i].unit][shares[i].shape] = share;
        f->square[shares[i].unit] += share * share;
    }
    for (int s = 0; s < FAP_ARKIT_COUNT; s++)
        f->left[s] = number(in->shape[s]);
}

/* The best value of one unit while the others stay; how far that moved it. */
static float improve(fit *f, int unit, float *value)
{
    const float *share = f->share[unit];
    float sum = 0;

    for (int s = 0; s < FAP_ARKIT_COUNT; s++)
        sum += share[s] * f->left[s];
    const float better = fminf(1, fmaxf(0, *value + sum / f->square[unit])), step = better - *value;
    for (int s = 0; s < FAP_ARKIT_COUNT; s++)
        f->left[s] -= step * share[s];
    *value = better;
    return fabsf(step);
}

/* One unit after the other: few share a shape, so that a handful of rounds does. */
void fap_facs_from_arkit(const fap_arkit *in, fap_facs *out)
{
    enum { MOST_ROUNDS = 200 };
    fit f;

    memset(out, 0, sizeof *out);
    fill(&f, in);
    for (int round = 0; round < MOST_ROUNDS; round++) {
        float farthest = 0;
        for (int unit = 0; unit <= FAP_FACS_MAX_NUMBER; unit++)
            if (f.square[unit] > 0)
                farthest = fmaxf(farthest, improve(&f, unit, &out->unit[unit]));
        if (farthest < 1e-5f)
            return;
    }
}

/* --- visemes and expressions --- */

/* The tongue's own units are nobody's coefficient. */
static void sum_keys(int kind, int n, fap_arkit *out)
{
    memset(out->shape, 0, sizeof out->shape);
    for (size_t i = 0; i < COUNT(keys); i++) {
        const int shape = fap_arkit_by_name(keys[i].shape);
        if (keys[i].kind == kind && keys[i].number == n && shape >= 0)
            out->shape[shape] += keys[i].percent / 100.0f;
    }
}

void fap_viseme_to_arkit(int viseme, fap_arkit *out)
{
    sum_keys(VISEME, viseme, out);
}

void fap_expression_to_arkit(int expression, fap_arkit *out)
{
    sum_keys(EXPRESSION, expression, out);
}

void fap_expression_to_facs(int expression, fap_facs *out)
{
    memset(out, 0, sizeof *out);
    for (size_t i = 0; i < COUNT(recipes); i++)
        if (recipes[i].expression == expression)
            out->unit[recipes[i].unit] = recipes[i].percent / 100.0f;
}
