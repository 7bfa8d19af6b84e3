/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Marker names to feature points. Three sources in falling order: the user's table, names that are feature
 * points themselves ("8.4", "FP8.4"), and the built-in set with the most hits. Sources of the sets:
 * fap_tables/markers.csv.
 */
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <fap/studio/markers.h>

#include "take/text.h"
#include "gen/markers.h"

#define POINT(group, index) group, index
#define NO_POINT            0, 0

enum {
    KIND_AT = FAP_MARKER_POINT,
    KIND_NEAR = FAP_MARKER_POINT | 128,
    KIND_RIGID = FAP_MARKER_RIGID,
    KIND_NONE = FAP_MARKER_IDLE,
    KIND_MOUTH = FAP_MARKER_MOUTH,
    KIND_BROW_LEFT = FAP_MARKER_BROW_LEFT,
    KIND_BROW_RIGHT = FAP_MARKER_BROW_RIGHT,
    KIND_INSIDE = FAP_MARKER_INSIDE | FAP_MARKER_IDLE,
};

static const struct marker_row {
    const char *set, *label;
    uint8_t group, index, kind;
} rows[] = {
#define X(...)                      ROW(__VA_ARGS__)
#define ROW(set, label, g, i, kind) { #set, label, g, i, KIND_##kind },
    MARKERS_ROWS(X)
#undef X
#undef ROW
};

enum { ROW_COUNT = sizeof rows / sizeof *rows };

static fap_err failed(char *where, fap_err err, const char *fmt, ...) __attribute__((format(printf, 3, 4)));

static fap_err failed(char *where, fap_err err, const char *fmt, ...)
{
    va_list args;

    if (!where)
        return err;
    va_start(args, fmt);
    vsnprintf(where, FAP_ERROR_TEXT_SIZE, fmt, args);
    va_end(args);
    return err;
}

/* Without the subject's prefix. */
static text short_name(const char *name)
{
    const char *colon = strrchr(name, ':');
    const char *start = colon && colon[1] ? colon + 1 : name;

    return (text){ start, strlen(start) };
}

/* --- giving roles --- */

static void add_source(fap_marker_source *s, uint32_t point, int near)
{
    for (int i = 0; i < s->count; i++)
        if (s->index[i] == (int16_t)point)
            return;
    if (s->count == FAP_MARKER_SOURCES)
        return;
    s->near = s->count ? s->near | near : near;
    s->index[s->count++] = (int16_t)point;
}

static void give_role(fap_markers *map, uint32_t point, int kind, int feature_point)
{
    map->used += !map->role[point];
    map->role[point] |= kind & 127;
    if (kind & FAP_MARKER_POINT)
        add_source(&map->point[feature_point], point, kind == KIND_NEAR);
}

/* --- names that are feature points --- */

/* "8.4", "FP8.4", "P 8.4", "FDP8.4"; -1 for anything else. */
static int direct_point(text name)
{
    char number[8];

    while (name.length && ((name.start[0] | 32) == 'f' || (name.start[0] | 32) == 'd' ||
                           (name.start[0] | 32) == 'p' || name.start[0] == ' ' || name.start[0] == '_'))
        name.start++, name.length--;
    if (!name.length || name.length >= sizeof number)
        return -1;
    memcpy(number, name.start, name.length);
    number[name.length] = '\0';
    return fap_point_by_name(number);
}

static void map_direct(fap_markers *map, const fap_take *take)
{
    for (uint32_t p = 0; p < take->point_count; p++) {
        const int feature_point = direct_point(short_name(take->name[p]));
        if (feature_point >= 0 && !map->role[p])
            give_role(map, p, KIND_AT, feature_point);
    }
}

/* --- the user's table --- */

static int parse_role(text t, int *kind, int *feature_point)
{
    *feature_point = -1;
    if (text_is(t, "rigid"))
        *kind = KIND_RIGID;
    else if (text_is(t, "none"))
        *kind = KIND_NONE;
    else {
        const int near = t.length && t.start[0] == '~';
        *kind = near ? KIND_NEAR : KIND_AT;
        *feature_point = direct_point((text){ t.start + near, t.length - (size_t)near });
        return *feature_point >= 0;
    }
    return 1;
}

/* Splits "LABEL,ROLE" at its last comma, semicolon or tab. */
static int split_pair(text line, text *label, text *role)
{
    for (size_t i = line.length; i-- > 0;)
        if (line.start[i] == ',' || line.start[i] == ';' || line.start[i] == '\t') {
            *label = text_trim((text){ line.start, i });
            *role = text_trim((text){ line.start + i + 1, line.length - i - 1 });
            return 1;
        }
    return 0;
}

static int same_text(text a, text b)
{
    char word[FAP_TAKE_NAME_SIZE];

    if (b.length >= sizeof word)
        return 0;
    memcpy(word, b.start, b.length);
    word[b.length] = '\0';
    return text_is(a, word);
}

static void map_label(fap_markers *map, const fap_take *take, text label, int kind, int feature_point)
{
    for (uint32_t p = 0; p < take->point_count; p++) {
        const text full = { take->name[p], strlen(take->name[p]) };
        if (same_text(full, label) || same_text(short_name(take->name[p]), label))
            give_role(map, p, kind, feature_point);
    }
}

static fap_err map_user(fap_markers *map, const fap_take *take, const char *csv, size_t size, char *where)
{
    text_lines lines = text_open((const uint8_t *)csv, size);
    text line, label, role;

    for (int kind, feature_point, first = 1; text_next(&lines, &line); first = 0) {
        line = text_trim(line);
        if (!line.length || line.start[0] == '#')
            continue;
        if (!split_pair(line, &label, &role))
            return failed(where, FAP_E_SYNTAX, "marker table, line %u: expected LABEL,POINT", lines.number);
        if (parse_role(role, &kind, &feature_point))
            map_label(map, take, label, kind, feature_point);
        else if (!first || (role.length && role.start[0] >= '0' && role.start[0] <= '9'))
            return failed(where, FAP_E_SYNTAX,
                          "marker table, line %u: '%.*s' is not a feature point, rigid or none", lines.number,
                          (int)(role.length < 40 ? role.length : 40), role.start);
    }
    return FAP_OK;
}

/* --- the built-in sets --- */

static int row_hits(const struct marker_row *row, const fap_take *take, uint32_t point)
{
    return text_is(short_name(take->name[point]), row->label);
}

static uint32_t count_hits(const char *set, const fap_take *take)
{
    uint32_t hits = 0;

    for (uint32_t p = 0; p < take->point_count; p++)
        for (int r = 0; r < ROW_COUNT; r++)
            if (!strcmp(rows[r].set, set) && row_hits(&rows[r], take, p)) {
                hits++;
                break;
            }
    return hits;
}

static int is_first_of_label(int row)
{
    for (int r = 0; r < row; r++)
        if (!strcmp(rows[r].set, rows[row].set) && !strcmp(rows[r].label, rows[row].label))
            return 0;
    return 1;
}

/* Numbers are anybody's names: they are landmarks only where all of a set's are there. */
static int is_complete(const char *set, uint32_t hits)
{
    uint32_t labels = 0;

    for (int r = 0; r < ROW_COUNT; r++) {
        if (strcmp(rows[r].set, set) != 0)
            continue;
        if (rows[r].label[0] < '0' || rows[r].label[0] > '9')
            return 1;
        labels += is_first_of_label(r) != 0;
    }
    return 10 * hits >= 9 * labels;
}

/* Fewer hits than this are chance: many laboratories have an "M1". */
static const char *best_set(const fap_take *take)
{
    enum { LEAST_HITS = 3 };
    const char *best = "";
    uint32_t most = LEAST_HITS - 1;

    for (int r = 0; r < ROW_COUNT; r++) {
        if (r && !strcmp(rows[r].set, rows[r - 1].set))
            continue;
        const uint32_t hits = count_hits(rows[r].set, take);
        if (hits > most && is_complete(rows[r].set, hits)) {
            most = hits;
            best = rows[r].set;
        }
    }
    return best;
}

static void map_built_in(fap_markers *map, const fap_take *take)
{
    map->set = best_set(take);
    for (uint32_t p = 0; p < take->point_count; p++) {
        if (map->role[p])
            continue;
        for (int r = 0; r < ROW_COUNT; r++)
            if (!strcmp(rows[r].set, map->set) && row_hits(&rows[r], take, p))
                give_role(map, p, rows[r].kind, fap_point_index(rows[r].group, rows[r].index));
    }
}

/* --- the whole --- */

static fap_err nothing_known(char *where, const fap_take *take)
{
    char names[160] = "";

    for (uint32_t p = 0; p < take->point_count && strlen(names) + FAP_TAKE_NAME_SIZE + 4 < sizeof names;
         p++) {
        const size_t used = strlen(names);
        snprintf(names + used, sizeof names - used, "%s%s", p ? ", " : "", take->name[p]);
    }
    return failed(where, FAP_E_NOT_FOUND,
                  "no marker is known; give --markers. The take has %u points: %s ...",
                  (unsigned)take->point_count, names);
}

fap_err fap_markers_map(fap_markers *out, const fap_take *take, const char *csv, size_t csv_size, char *where)
{
    memset(out, 0, sizeof *out);
    out->set = "";
    if (where)
        *where = '\0';
    if (csv) {
        const fap_err err = map_user(out, take, csv, csv_size, where);
        if (err != FAP_OK)
            return err;
    }
    map_direct(out, take);
    map_built_in(out, take);
    for (uint32_t p = 0; p < take->point_count; p++)
        if (out->role[p] & ~(FAP_MARKER_RIGID | FAP_MARKER_IDLE | FAP_MARKER_INSIDE))
            return FAP_OK;
    return nothing_known(where, take);
}

fap_err fap_markers_set_rigid(fap_markers *map, const fap_take *take, const char *names, char *where)
{
    for (uint32_t p = 0; p < take->point_count; p++)
        map->role[p] &= (uint8_t)~FAP_MARKER_RIGID;
    while (*names) {
        char name[FAP_TAKE_NAME_SIZE];
        const size_t length = strcspn(names, ",");
        snprintf(name, sizeof name, "%.*s", (int)(length < sizeof name ? length : sizeof name - 1), names);
        const int p = fap_take_find(take, name);
        if (p < 0)
            return failed(where, FAP_E_NOT_FOUND, "the take has no marker '%s' that could be rigid", name);
        map->role[p] |= FAP_MARKER_RIGID;
        names += length + (names[length] == ',');
    }
    return FAP_OK;
}
