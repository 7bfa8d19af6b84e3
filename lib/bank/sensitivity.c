/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * See sensitivity.h. Lengths become whole nanometres first; from there on everything is integers.
 * Source: ISO/IEC 14496-2, Annex C, Table C-1 and FAPU definition.
 */
#include <string.h>

#include <fap/sensitivity.h>

#include "bank/sensitivity.h"
#include "base/bitops.h"
#include "param/frame.h"

enum {
    AU_PER_RADIAN = 100000,
    FAPU_PARTS = 1024,
    PLACES =
        FAP_POINT_COUNT + 4, /* feature points (3.5 3.6 eyeballs, 7.1 head), pupils, viseme, expression */
};

/* Lengths on a face, nanometres. */
typedef struct measures {
    int64_t unit[FAP_UNIT_AU]; /* by fap_unit */
    int64_t eye_radius, tongue_half, head[3];
    int64_t viseme, expression; /* largest motion at full strength */
} measures;

static int64_t rounded_ratio(int64_t a, int64_t b)
{
    return (a + b / 2) / b;
}

/* One digit of base 4 a step; without branches, for nobody can foretell the digits. */
uint64_t fap_isqrt(uint64_t v)
{
    const uint32_t upper = (uint32_t)(v >> 32), half = upper ? upper : (uint32_t)v | 1;
    const int first = (31 - fap_leading_zeros(half)) / 2 * 2 + (upper ? 32 : 0);
    uint64_t root = 0;

    for (uint64_t bit = (uint64_t)1 << first; bit; bit >>= 2) {
        const uint64_t trial = root + bit, taken = 0 - (uint64_t)(v >= trial);
        root = (root >> 1) + (bit & taken);
        v -= trial & taken;
    }
    return root;
}

static uint32_t unit_nm(const measures *m, const fap_info *info)
{
    switch (info->motion) {
    case FAP_MOTION_SIZE: return (uint32_t)rounded_ratio(m->unit[FAP_UNIT_IRISD], 2 * FAPU_PARTS);
    case FAP_MOTION_CURL: return (uint32_t)rounded_ratio(m->tongue_half, AU_PER_RADIAN);
    case FAP_MOTION_PITCH:
    case FAP_MOTION_YAW:
    case FAP_MOTION_ROLL:
        return (uint32_t)rounded_ratio(
            info->group == fap_info_get(48)->group ? m->head[info->motion - FAP_MOTION_YAW] : m->eye_radius,
            AU_PER_RADIAN);
    default: return (uint32_t)rounded_ratio(m->unit[info->unit], FAPU_PARTS);
    }
}

static void from_measures(const measures *m, fap_sensitivity *out)
{
    *out = (fap_sensitivity){ { 0 } };
    out->nm[1] = (uint32_t)rounded_ratio(m->viseme, FRAME_STRENGTH_MAX);
    out->nm[2] = (uint32_t)rounded_ratio(m->expression, FRAME_STRENGTH_MAX);
    for (int fap = 3; fap <= FAP_COUNT; fap++)
        out->nm[fap] = unit_nm(m, fap_info_get(fap));
    for (int fap = 1; fap <= FAP_COUNT; fap++) /* whatever a bank says, an error is an error */
        out->nm[fap] = out->nm[fap] ? out->nm[fap] : 1;
}

/*
 * UNVERIFIED: adult means, from memory of the anthropometric literature: iris 11.7 mm (Rufer 2005), pupils 63 mm
 * apart (Dodgson 2004), mouth 52 mm wide, eyes to base of the nose 45 mm, from there to the mouth 21 mm (Farkas
 * 1994), eyeball 24 mm across. Levers from the top of the spine and the motions at full strength are those of the
 * built-in face, rounded.
 */
void fap_sensitivity_typical(fap_sensitivity *out)
{
    static const measures face = {
        .unit = { 0, 11700000, 63000000, 45000000, 21000000, 52000000 },
        .eye_radius = 12000000,
        .tongue_half = 16000000,
        .head = { 115000000, 150000000, 140000000 }, /* yaw: the nose; pitch, roll: the crown */
        .viseme = 12000000,
        .expression = 12000000,
    };

    from_measures(&face, out);
}

/* --- of a bank --- */

static int64_t nanometres(float mm)
{
    const double nm = (double)mm * 1e6;

    if (!(nm > -2e9 && nm < 2e9)) /* two metres; not a number either */
        return nm < 0 ? -2000000000 : nm > 0 ? 2000000000 : 0;
    return (int64_t)(nm < 0 ? nm - 0.5 : nm + 0.5);
}

static int64_t longest(int64_t a, int64_t b)
{
    return a > b ? a : b;
}

static int64_t length(int64_t x, int64_t y, int64_t z)
{
    return (int64_t)fap_isqrt((uint64_t)(x * x) + (uint64_t)(y * y) + (uint64_t)(z * z));
}

/* Largest distance of a feature point from the axes of yaw (y), pitch (x) and roll (z). */
static void measure_head(const fap_bank *bank, int64_t head[3])
{
    const fap_bank_point *spine = fap_bank_point_get(bank, fap_point_index(7, 1));

    for (int point = 0; point < FAP_POINT_COUNT; point++) {
        const fap_bank_point *p = fap_bank_point_get(bank, point);
        int64_t d[3];
        for (int axis = 0; axis < 3; axis++)
            d[axis] = nanometres(p->position_mm[axis]) -
                      (spine->present ? nanometres(spine->position_mm[axis]) : 0);
        head[0] = longest(head[0], p->present ? length(d[0], 0, d[2]) : 0);
        head[1] = longest(head[1], p->present ? length(0, d[1], d[2]) : 0);
        head[2] = longest(head[2], p->present ? length(d[0], d[1], 0) : 0);
    }
}

static int64_t largest_motion(const fap_bank *bank, fap_key_kind kind)
{
    int64_t most = 0;

    for (int i = 0; i < fap_bank_key_count(bank); i++) {
        const fap_key *key = fap_bank_key_get(bank, i);
        for (int point = 0; key->kind == kind && point < FAP_POINT_COUNT; point++) {
            const float *mm = key->point_mm[point];
            most = longest(most, length(nanometres(mm[0]), nanometres(mm[1]), nanometres(mm[2])));
        }
    }
    return most;
}

/* Half the distance of the tongue's borders. */
static int64_t measure_tongue(const fap_bank *bank)
{
    const fap_bank_point *left = fap_bank_point_get(bank, fap_point_index(6, 3)),
                         *right = fap_bank_point_get(bank, fap_point_index(6, 4));
    const int64_t wide = nanometres(left->position_mm[0]) - nanometres(right->position_mm[0]);

    return left->present && right->present && wide > 0 ? wide / 2 : 0;
}

static int64_t measure_eyes(const fap_bank *bank)
{
    int64_t radius = 0;

    for (int right = 0; right < 2; right++) {
        float centre[3], mm;
        if (fap_bank_eye(bank, right, centre, &mm))
            radius = longest(radius, nanometres(mm));
    }
    return radius;
}

void fap_sensitivity_of_bank(const fap_bank *bank, fap_sensitivity *out)
{
    const fap_fapu *fapu = fap_bank_fapu(bank);
    measures m = {
        .unit = { 0, nanometres(fapu->irisd_mm), nanometres(fapu->es_mm), nanometres(fapu->ens_mm),
                  nanometres(fapu->mns_mm), nanometres(fapu->mw_mm) },
        .eye_radius = measure_eyes(bank),
        .tongue_half = measure_tongue(bank),
        .viseme = largest_motion(bank, FAP_KEY_VISEME),
        .expression = largest_motion(bank, FAP_KEY_EXPRESSION),
    };

    measure_head(bank, m.head);
    from_measures(&m, out);
}

/* --- two frames --- */

static int place_of(int fap)
{
    const fap_info *info = fap_info_get(fap);

    if (info->motion == FAP_MOTION_SIZE)
        return FAP_POINT_COUNT + (info->point == fap_info_get(29)->point ? 0 : 1);
    return fap < 3 ? FAP_POINT_COUNT + 1 + fap : info->point;
}

static int64_t difference(int64_t a, int64_t b)
{
    return a < b ? b - a : a - b;
}

/* Of two mixes, each two numbers with their weights. */
static int64_t mix_distance(const uint8_t number[4], const int weight[4])
{
    int more[FAP_VISEME_COUNT + 1] = { 0 };
    int64_t sum = 0;

    for (int i = 0; i < 4; i++)
        if (number[i] <= FAP_VISEME_COUNT)
            more[number[i]] += i < 2 ? weight[i] : -weight[i];
    for (int i = 1; i <= FAP_VISEME_COUNT; i++)
        sum += difference(more[i], 0);
    return sum;
}

int64_t fap_viseme_distance(const fap_viseme *a, const fap_viseme *b)
{
    return mix_distance(
        (const uint8_t[]){ a->select1, a->select2, b->select1, b->select2 },
        (const int[]){ a->blend, FRAME_STRENGTH_MAX - a->blend, b->blend, FRAME_STRENGTH_MAX - b->blend });
}

int64_t fap_expression_distance(const fap_expression *a, const fap_expression *b)
{
    return mix_distance((const uint8_t[]){ a->select1, a->select2, b->select1, b->select2 },
                        (const int[]){ a->intensity1, a->intensity2, b->intensity1, b->intensity2 });
}

static int64_t units_apart(const fap_frame *want, const fap_frame *got, int fap)
{
    static const fap_viseme no_viseme;
    static const fap_expression no_expression;
    const int known = got->state[fap] != FAP_ABSENT;

    if (fap == 1)
        return fap_viseme_distance(&want->viseme, known ? &got->viseme : &no_viseme);
    if (fap == 2)
        return fap_expression_distance(&want->expression, known ? &got->expression : &no_expression);
    return difference(want->value[fap], known ? got->value[fap] : 0);
}

/* Nanometres along one FAP's axis, at most two metres: squares of three are added. */
static uint64_t axis_error(const fap_sensitivity *s, const fap_frame *want, const fap_frame *got, int fap)
{
    const uint64_t nm = (uint64_t)units_apart(want, got, fap) * s->nm[fap];
    return nm < INT32_MAX ? nm : INT32_MAX;
}

/* What is wrong at one place, along all its axes that are commanded. */
typedef struct place_error {
    uint64_t square;
    uint32_t nm; /* along the last one */
    uint8_t axes, fap;
} place_error;

static void add_axis(place_error *p, uint64_t nm, int fap)
{
    p->square += nm * nm;
    p->nm = (uint32_t)nm;
    p->axes++;
    p->fap = (uint8_t)fap;
}

static void add_place(fap_frame_error *e, const place_error *p)
{
    const uint64_t nm = p->axes > 1 ? fap_isqrt(p->square) : p->nm;

    e->items++;
    e->sum_nm += nm;
    if (nm > e->max_nm) {
        e->max_nm = (uint32_t)nm;
        e->max_fap = p->fap;
    }
}

void fap_sensitivity_compare(const fap_sensitivity *s, const fap_frame *want, const fap_frame *got,
                             fap_frame_error *out)
{
    place_error place[PLACES] = { { 0 } };

    for (int fap = 1; fap <= FAP_COUNT; fap++)
        if (want->state[fap] != FAP_ABSENT)
            add_axis(&place[place_of(fap)], axis_error(s, want, got, fap), fap);
    *out = (fap_frame_error){ 0 };
    for (int i = 0; i < PLACES; i++)
        if (place[i].axes)
            add_place(out, &place[i]);
    if (out->items)
        out->mean_nm = (uint32_t)rounded_ratio((int64_t)out->sum_nm, out->items);
}

uint32_t fap_sensitivity_error_nm(const fap_sensitivity *s, const fap_frame *want, const fap_frame *got)
{
    fap_frame_error e;

    fap_sensitivity_compare(s, want, got, &e);
    return e.mean_nm;
}
