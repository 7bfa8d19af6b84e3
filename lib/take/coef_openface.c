/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Action units, gaze and head of OpenFace 2.x tables, those without points too. Intensities AU.._r are 0 to 5, or 0 to 1 where
 * somebody has divided them; presence AU.._c counts only where a unit has no intensity. Gaze and head are those of the camera: the
 * eyes are turned into the head. Source: the columns of real exports; OpenFace's documentation of its angles, whose senses
 * were checked on these: people who turn their head away still look at the screen.
 */
#include <math.h>
#include <stdio.h>

#include "base/mem.h"
#include "take/coef.h"

enum { EYES = 4, HEAD = 3, MOST_UNITS = FAP_FACS_MAX_NUMBER };

static const double least_confidence = 0.75;
/* How much of AU45 shuts the lids depends on the person: blinks of three takes peak at 1.8, 2.5 and 3.5 of 5. */
static const double full = 5, least_blink = 1.5, most_blink = 3.5;
/* A unit that is only said to be there. */
static const double present_share = 0.5;

typedef struct table {
    text_lines body;
    int frame, time, confidence, success, face;
    int intensity[MOST_UNITS + 1], presence[MOST_UNITS + 1]; /* columns; -1: none */
    int gaze[2], pose[3];
    uint32_t channels;
    int has_gaze, has_head;
    text_row row;
} table;

static int column_of(const text_row *row, const char *name)
{
    for (size_t i = 0; i < row->count; i++)
        if (text_is(row->cell[i], name))
            return (int)i;
    return -1;
}

static int unit_column(const text_row *row, int unit, char kind)
{
    char name[16];

    snprintf(name, sizeof name, "AU%02d_%c", unit, kind);
    return column_of(row, name);
}

/* --- which table --- */

static int has_word(text line, const char *word)
{
    for (; line.length; line.start++, line.length--)
        if (text_starts(line, word))
            return 1;
    return 0;
}

static int openface_claims(const uint8_t *data, size_t size)
{
    text_lines lines = text_open(data, size);
    text line;

    return text_next(&lines, &line) && (has_word(line, "AU01_r") || has_word(line, "AU01_c")) ? 70 : 0;
}

/* OpenFace 3 calls eight units of its own AU01_r to AU08_r; the second has no 3 and no 8. */
static int is_third(const text_row *row)
{
    return unit_column(row, 3, 'r') >= 0 || unit_column(row, 8, 'r') >= 0;
}

static uint32_t find_units(table *t)
{
    uint32_t n = 0;

    for (int unit = 0; unit <= MOST_UNITS; unit++) {
        t->intensity[unit] = t->presence[unit] = -1;
        if (!fap_facs_name(unit))
            continue;
        t->intensity[unit] = unit_column(&t->row, unit, 'r');
        if (t->intensity[unit] < 0)
            t->presence[unit] = unit_column(&t->row, unit, 'c');
        n += t->intensity[unit] >= 0 || t->presence[unit] >= 0;
    }
    return n;
}

static void read_head(table *t)
{
    static const char *const gaze[] = { "gaze_angle_x", "gaze_angle_y" };
    static const char *const pose[] = { "pose_Rx", "pose_Ry", "pose_Rz" };

    t->frame = column_of(&t->row, "frame");
    t->time = column_of(&t->row, "timestamp");
    t->confidence = column_of(&t->row, "confidence");
    t->success = column_of(&t->row, "success");
    t->face = column_of(&t->row, "face_id");
    for (int i = 0; i < 2; i++)
        t->gaze[i] = column_of(&t->row, gaze[i]);
    for (int i = 0; i < 3; i++)
        t->pose[i] = column_of(&t->row, pose[i]);
    t->has_head = t->pose[0] >= 0 && t->pose[1] >= 0 && t->pose[2] >= 0;
    t->has_gaze = t->has_head && t->gaze[0] >= 0 && t->gaze[1] >= 0;
    t->channels = find_units(t) + (t->has_head ? HEAD : 0) + (t->has_gaze ? EYES : 0);
}

static void name_channels(const table *t, fap_coefficients *take)
{
    uint32_t n = 0;

    for (int unit = 0; unit <= MOST_UNITS; unit++)
        if (t->intensity[unit] >= 0 || t->presence[unit] >= 0)
            take->channel[n++] = (uint8_t)(FAP_CHANNEL_AU + unit);
    for (int i = 0; t->has_head && i < HEAD; i++)
        take->channel[n++] = (uint8_t)(FAP_CHANNEL_ANGLE + FAP_ARKIT_HEAD_YAW + i);
    if (!t->has_gaze)
        return;
    take->channel[n++] = FAP_CHANNEL_ANGLE + FAP_ARKIT_LEFT_EYE_YAW;
    take->channel[n++] = FAP_CHANNEL_ANGLE + FAP_ARKIT_LEFT_EYE_PITCH;
    take->channel[n++] = FAP_CHANNEL_ANGLE + FAP_ARKIT_RIGHT_EYE_YAW;
    take->channel[n++] = FAP_CHANNEL_ANGLE + FAP_ARKIT_RIGHT_EYE_PITCH;
}

/* --- angles --- */

static int number_in(const table *t, int column, double *value)
{
    return column >= 0 && text_number(text_cell(&t->row, (size_t)column), value) == TEXT_NUMBER;
}

/*
 * R = Rx(a) Ry(b) Rz(c) of the camera's axes (x to the person's left, y down, z away). Turned over into y up and z to the
 * camera, the senses of b and c change.
 */
static void head_of(const double pose[3], double r[3][3])
{
    const double ca = cos(pose[0]), sa = sin(pose[0]), cb = cos(-pose[1]), sb = sin(-pose[1]);
    const double cc = cos(-pose[2]), sc = sin(-pose[2]);
    const double turned[3][3] = { { cb * cc, -cb * sc, sb },
                                  { ca * sc + sa * sb * cc, ca * cc - sa * sb * sc, -sa * cb },
                                  { sa * sc - ca * sb * cc, sa * cc + ca * sb * sc, ca * cb } };

    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            r[i][k] = turned[i][k];
}

/* The same turn as yaw, then pitch, then roll: ARKit's senses, see fap/arkit.h. */
static void set_head(coef_rows *rows, int64_t row, uint32_t column, double r[3][3])
{
    coef_set(rows, row, column, atan2(r[0][2], r[2][2]));
    coef_set(rows, row, column + 1, asin(fmax(-1, fmin(1, r[1][2]))));
    coef_set(rows, row, column + 2, atan2(r[1][0], r[1][1]));
}

/* Where the eyes look, in the head: yaw to the face's right, pitch down. */
static void set_gaze(const table *t, coef_rows *rows, int64_t row, uint32_t column, double r[3][3])
{
    double x, y, in_head[3];

    if (!number_in(t, t->gaze[0], &x) || !number_in(t, t->gaze[1], &y))
        return;
    const double look[3] = { tan(x), -tan(y), 1 };
    for (int i = 0; i < 3; i++)
        in_head[i] = r[0][i] * look[0] + r[1][i] * look[1] + r[2][i] * look[2];
    for (uint32_t eye = 0; eye < 2; eye++) {
        coef_set(rows, row, column + 2 * eye, -atan2(in_head[0], in_head[2]));
        coef_set(rows, row, column + 2 * eye + 1, -atan2(in_head[1], hypot(in_head[0], in_head[2])));
    }
}

/* --- rows --- */

static int is_trusted(const table *t)
{
    double v;

    return !(number_in(t, t->confidence, &v) && v < least_confidence) &&
           !(number_in(t, t->success, &v) && v == 0);
}

static void read_units(const table *t, coef_rows *rows, int64_t row)
{
    uint32_t column = 0;
    double v;

    for (int unit = 0; unit <= MOST_UNITS; unit++) {
        if (t->intensity[unit] < 0 && t->presence[unit] < 0)
            continue;
        if (number_in(t, t->intensity[unit], &v))
            coef_set(rows, row, column, v);
        else if (number_in(t, t->presence[unit], &v))
            coef_set(rows, row, column, v * present_share * full);
        column++;
    }
}

static void read_angles(const table *t, coef_rows *rows, int64_t row)
{
    const uint32_t column = t->channels - (t->has_gaze ? EYES : 0) - HEAD;
    double pose[3], r[3][3];

    if (!t->has_head || !number_in(t, t->pose[0], &pose[0]) || !number_in(t, t->pose[1], &pose[1]) ||
        !number_in(t, t->pose[2], &pose[2]))
        return;
    head_of(pose, r);
    set_head(rows, row, column, r);
    if (t->has_gaze)
        set_gaze(t, rows, row, column + HEAD, r);
}

static void read_rows(table *t, coef_rows *rows)
{
    const int clock = t->time >= 0 ? t->time : t->frame;
    double first_face = 0, face, time;
    uint64_t others = 0;
    text line;

    rows->clock = t->time >= 0 ? COEF_CLOCK_SECONDS : t->frame >= 0 ? COEF_CLOCK_FRAMES : COEF_CLOCK_NONE;
    while (text_next(&t->body, &line)) {
        text_split(line, ',', &t->row);
        if (text_row_is_blank(&t->row) || (clock >= 0 && !number_in(t, clock, &time)))
            continue;
        if (number_in(t, t->face, &face)) {
            first_face = rows->count ? first_face : face;
            others += face != first_face;
            if (face != first_face)
                continue;
        }
        const int64_t row = coef_rows_add(rows, clock >= 0 ? time : rows->count, 0);
        if (!is_trusted(t))
            continue;
        read_units(t, rows, row);
        read_angles(t, rows, row);
    }
    if (others)
        coef_note(rows->take, "%llu rows are of other faces than %g and are left out",
                  (unsigned long long)others, first_face);
}

/* --- intensities --- */

static int is_unit(const fap_coefficients *t, size_t sample)
{
    return t->channel[sample % t->channel_count] >= FAP_CHANNEL_AU;
}

/* OpenFace writes 0 to 5 with two decimals. Nothing above 1 and more decimals: FACSvatar and others have divided by 5. */
static int is_divided(const fap_coefficients *t, size_t samples)
{
    int fine = 0;

    for (size_t i = 0; i < samples; i++) {
        const double v = (double)t->value[i];
        if (!is_unit(t, i))
            continue;
        if (v > 1.0001)
            return 0;
        fine |= fabs(v * 100 - nearbyint(v * 100)) > 0.01;
    }
    return fine;
}

static int is_blink(const fap_coefficients *t, size_t sample)
{
    return t->channel[sample % t->channel_count] == FAP_CHANNEL_AU + 45;
}

/* Everybody blinks: the highest there is counts as shut, unless it is too low to be one. */
static double full_blink(const fap_coefficients *t, size_t samples, double unit)
{
    double most = 0;

    for (size_t i = 0; i < samples; i++)
        if (is_blink(t, i))
            most = fmax(most, unit * (double)t->value[i]);
    return most < least_blink || most > most_blink ? most_blink : most;
}

static void scale_units(coef_rows *rows)
{
    fap_coefficients *t = rows->take;
    const size_t samples = (size_t)rows->count * t->channel_count;
    const int divided = is_divided(t, samples);
    const double unit = divided ? full : 1, blink = full_blink(t, samples, unit);

    for (size_t i = 0; i < samples; i++)
        if (is_unit(t, i))
            t->value[i] *= (float)(unit / (is_blink(t, i) ? blink : full));
    if (divided)
        coef_note(t, "intensities are at most 1, with more than two decimals: taken as divided by 5");
    if (fap_coefficients_find(t, FAP_CHANNEL_AU + 45) >= 0)
        coef_note(t, "AU45 of %.3g, of 5, is taken as lids that are shut", blink);
}

/* --- all --- */

static fap_err read_table(take_source *src, table *t, coef_rows *rows)
{
    text_lines count;
    uint64_t lines = 0;
    text line;

    t->body = text_open(src->data, src->size);
    if (!text_next(&t->body, &line))
        return take_fail(src, FAP_E_SYNTAX, "no head line");
    text_split(line, ',', &t->row);
    if (is_third(&t->row))
        return take_fail(
            src, FAP_E_UNSUPPORTED,
            "AU01_r to AU08_r of OpenFace 3 are other units than their names say: use OpenFace 2.2");
    read_head(t);
    for (count = t->body; text_next(&count, &line);)
        lines++;
    const fap_err err = coef_rows_open(src, rows, t->channels, lines);
    if (err != FAP_OK)
        return err;
    name_channels(t, rows->take);
    read_rows(t, rows);
    scale_units(rows);
    rows->snap = 0.002;
    return FAP_OK;
}

static fap_err openface_read(take_source *src, coef_rows *rows)
{
    table *t = fap_mem_calloc(&src->alloc, 1, sizeof *t);

    if (!t)
        return FAP_E_NOMEM;
    const fap_err err = read_table(src, t, rows);
    fap_mem_free(&src->alloc, t);
    return err;
}

const coef_driver coef_driver_openface = { "openface units", openface_claims, openface_read };
