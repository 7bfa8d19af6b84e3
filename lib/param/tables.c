/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The standard's tables as constant data and their look-ups. Rows come from fap_tables/NAME.csv through csv2c; what
 * follows from them (group starts, pairs both ways) is computed or checked here, not typed.
 * Source: ISO/IEC 14496-2, Annex C.
 */
#include <string.h>

#include <fap/fapu.h>
#include <fap/tables.h>

#include "gen/expressions.h"
#include "gen/faps.h"
#include "gen/groups.h"
#include "gen/pairs.h"
#include "gen/points.h"
#include "gen/profiles.h"
#include "gen/units.h"
#include "gen/visemes.h"
#include "param/tables.h"

#define POINT(group, index) POINT_##group##_##index
#define NO_POINT            (-1)

enum {
#define X(point, group, index, moved, mirror, description) point,
    POINTS_ROWS(X)
#undef X
        POINT_END
};
_Static_assert(POINT_END == FAP_POINT_COUNT, "points.csv has not 84 rows");

static const fap_point_info points[FAP_POINT_COUNT] = {
#define X(point, group, index, moved, mirror, description)                                                   \
    [point] = { #group "." #index, description, group, index, moved, mirror },
    POINTS_ROWS(X)
#undef X
};

static const fap_info faps[FAP_COUNT + 1] = {
#define X(fap, name, description, unit, motion, sign, bidirectional, point, point2, group, step, imin, imax, \
          pmin, pmax)                                                                                        \
    [fap] = { name,                                                                                          \
              description,                                                                                   \
              FAP_UNIT_##unit,                                                                               \
              FAP_MOTION_##motion,                                                                           \
              sign,                                                                                          \
              bidirectional,                                                                                 \
              point,                                                                                         \
              point2,                                                                                        \
              group,                                                                                         \
              step,                                                                                          \
              imin,                                                                                          \
              imax,                                                                                          \
              pmin,                                                                                          \
              pmax },
    FAPS_ROWS(X)
#undef X
};

static const struct group {
    uint8_t count;
} groups[FAP_GROUPS + 1] = {
#define X(group, name, count) [group] = { count },
    GROUPS_ROWS(X)
#undef X
};

enum { PAIR_SIDE, PAIR_LIP };

static const struct pair {
    uint8_t kind, a, b;
} pairs[] = {
#define X(kind, a, b) { PAIR_##kind, a, b },
    PAIRS_ROWS(X)
#undef X
};

static const struct unit_row {
    uint8_t unit;
    int8_t from, to;
    uint8_t axis;
} units[] = {
#define X(unit, from, to, axis, description) { FAP_UNIT_##unit, from, to, FAP_MOTION_##axis - FAP_MOTION_X },
    UNITS_ROWS(X)
#undef X
};

static const char *const viseme_names[FAP_VISEME_COUNT + 1][2] = {
#define X(viseme, name, phonemes, example) [viseme] = { name, phonemes },
    VISEMES_ROWS(X)
#undef X
};

static const char *const expression_names[FAP_EXPRESSION_COUNT + 1] = {
#define X(expression, name, look) [expression] = name,
    EXPRESSIONS_ROWS(X)
#undef X
};

static const int16_t profiles[FAP_EXPRESSION_COUNT + 1][FAP_COUNT + 1] = {
#define X(expression, fap, value) [expression][fap] = value,
    PROFILES_ROWS(X)
#undef X
};

const fap_info *fap_info_get(int fap)
{
    return fap >= 1 && fap <= FAP_COUNT ? &faps[fap] : NULL;
}

int fap_by_name(const char *name)
{
    for (int fap = 1; fap <= FAP_COUNT; fap++)
        if (!strcmp(faps[fap].name, name))
            return fap;
    return 0;
}

int fap_group_first(int group)
{
    if (group < 1 || group > FAP_GROUPS)
        return 0;
    int first = 1;
    for (int g = 1; g < group; g++)
        first += groups[g].count;
    return first;
}

int fap_group_count(int group)
{
    return group >= 1 && group <= FAP_GROUPS ? groups[group].count : 0;
}

static int paired(int kind, int fap)
{
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
        if (pairs[i].kind != kind)
            continue;
        if (pairs[i].a == fap)
            return pairs[i].b;
        if (pairs[i].b == fap)
            return pairs[i].a;
    }
    return 0;
}

int fap_mirror(int fap)
{
    return paired(PAIR_SIDE, fap);
}

int fap_lip_pair(int fap)
{
    return paired(PAIR_LIP, fap);
}

const fap_point_info *fap_point_get(int point)
{
    return point >= 0 && point < FAP_POINT_COUNT ? &points[point] : NULL;
}

int fap_point_index(int group, int index)
{
    for (int i = 0; i < FAP_POINT_COUNT; i++)
        if (points[i].group == group && points[i].index == index)
            return i;
    return -1;
}

int fap_point_by_name(const char *name)
{
    for (int i = 0; i < FAP_POINT_COUNT; i++)
        if (!strcmp(points[i].name, name))
            return i;
    return -1;
}

const char *fap_viseme_name(int viseme)
{
    return viseme >= 0 && viseme <= FAP_VISEME_COUNT ? viseme_names[viseme][0] : NULL;
}

const char *fap_viseme_phonemes(int viseme)
{
    return viseme >= 0 && viseme <= FAP_VISEME_COUNT ? viseme_names[viseme][1] : NULL;
}

const char *fap_expression_name(int expression)
{
    return expression >= 0 && expression <= FAP_EXPRESSION_COUNT ? expression_names[expression] : NULL;
}

int fap_expression_profile(int expression, int fap)
{
    if (expression < 1 || expression > FAP_EXPRESSION_COUNT || fap < 1 || fap > FAP_COUNT)
        return 0;
    return profiles[expression][fap];
}

float fap_unit_distance(const float point[FAP_POINT_COUNT][3], fap_unit unit)
{
    for (size_t i = 0; i < sizeof units / sizeof *units; i++)
        if (units[i].unit == unit)
            return point[units[i].from][units[i].axis] - point[units[i].to][units[i].axis];
    return 0;
}
