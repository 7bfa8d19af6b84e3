/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * OpenFace 2.x tables: 68 points in millimetres, in the camera's frame (y down, z away), called 0 to 67 here.
 * X_5 is millimetres and x_5 pixels, so case counts. Rows that the tracker does not trust are missing. Where the eyes look is told
 * as an angle; here it becomes two points on balls behind the lids, the pupils. Of several faces the one with most rows is taken.
 * Source: the columns of real exports of several releases.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "take/grid.h"

enum { POINTS = 68, MAX_FACES = 32 };

static const double least_confidence = 0.75;

/* The eyes as the picture has them from left to right: the first is the subject's right one. */
static const struct eye {
    const char *pupil, *gaze[3];
    const char *corner[2];
} eyes[2] = {
    { "pupil_r", { "gaze_0_x", "gaze_0_y", "gaze_0_z" }, { "36", "39" } },
    { "pupil_l", { "gaze_1_x", "gaze_1_y", "gaze_1_z" }, { "42", "45" } },
};

/* Of an adult's eyeball. */
static const double eyeball_radius_mm = 12;

static int is_exactly(text t, const char *word)
{
    for (size_t i = 0; i < t.length; i++)
        if (!word[i] || t.start[i] != word[i]) /* a cell may hold NULs of its own */
            return 0;
    return word[t.length] == '\0';
}

/* Column of X_5 and its kin, the row's length where there is none. */
static size_t column_of(const text_row *row, const char *name)
{
    size_t column = 0;

    while (column < row->count && !is_exactly(row->cell[column], name))
        column++;
    return column;
}

static int openface_claims(const uint8_t *data, size_t size)
{
    text_lines lines = text_open(data, size);
    text line;
    int has_point = 0, has_confidence = 0;

    if (!text_next(&lines, &line))
        return 0;
    for (; line.length; line.start++, line.length--) {
        has_point |= text_starts(line, "X_67") && *line.start == 'X';
        has_confidence |= text_starts(line, "confidence");
    }
    return has_point && has_confidence ? 80 : 0;
}

static void add_points(take_grid *g)
{
    for (int i = 0; i < POINTS; i++) {
        char name[3][16];
        size_t column[3];
        for (int axis = 0; axis < 3; axis++) {
            snprintf(name[axis], sizeof name[axis], "%c_%d", 'X' + axis, i);
            column[axis] = column_of(&g->row, name[axis]);
        }
        if (column[0] < g->row.count && column[1] < g->row.count && column[2] < g->row.count)
            grid_add(g, (text){ g->row.cell[column[0]].start + 2, g->row.cell[column[0]].length - 2 },
                     column[0], column[1], column[2]);
    }
}

static int optional(const text_row *row, const char *name)
{
    const size_t column = column_of(row, name);
    return column < row->count ? (int)column : -1;
}

/* --- eyes --- */

/* Where each eye looks, or both; until the rows are read the columns stand in for a point. 0: the file does not say. */
static int add_gaze(take_grid *g)
{
    const int angle[2] = { optional(&g->row, "gaze_angle_x"), optional(&g->row, "gaze_angle_y") };
    int vectors = 0;

    for (int i = 0; i < 2; i++) {
        int column[3], known = 1;
        for (int axis = 0; axis < 3; axis++) {
            column[axis] = optional(&g->row, eyes[i].gaze[axis]);
            known &= column[axis] >= 0;
        }
        vectors += known;
        if (!known && (angle[0] < 0 || angle[1] < 0))
            return 0;
        const text name = { eyes[i].pupil, strlen(eyes[i].pupil) };
        if (known)
            grid_add(g, name, (size_t)column[0], (size_t)column[1], (size_t)column[2]);
        else
            grid_add(g, name, (size_t)angle[0], (size_t)angle[1], (size_t)angle[1]);
    }
    return vectors == 2 ? 3 : 2;
}

/* What was read as a place is a vector, or two angles of the camera's frame, which the grid has mirrored: x right, y up. */
static int look(const float *v, int numbers, double out[3])
{
    if (numbers == 2) {
        out[0] = tan((double)v[0]);
        out[1] = tan((double)v[1]);
        out[2] = 1;
    } else {
        for (int axis = 0; axis < 3; axis++)
            out[axis] = (double)v[axis];
    }
    const double length = sqrt(out[0] * out[0] + out[1] * out[1] + out[2] * out[2]);
    for (int axis = 0; axis < 3; axis++)
        out[axis] *= eyeball_radius_mm / length;
    return length > 0.1 && isfinite(length); /* a tracker without an eye writes zeros */
}

static void put_pupil(fap_take *take, uint32_t frame, uint32_t pupil, const int corner[2], int numbers)
{
    const float *gaze = fap_take_sample(take, frame, pupil);
    const float *a = fap_take_sample(take, frame, (uint32_t)corner[0]);
    const float *b = fap_take_sample(take, frame, (uint32_t)corner[1]);
    double to[3];
    float at[3] = { NAN, NAN, NAN }; /* missing */

    if (gaze && a && b && look(gaze, numbers, to))
        for (int axis = 0; axis < 3; axis++)
            at[axis] = (a[axis] + b[axis]) / 2 + (float)to[axis];
    fap_take_set(take, frame, pupil, at);
}

static void put_pupils(fap_take *take, int numbers)
{
    for (int i = 0; i < 2; i++) {
        const int pupil = fap_take_find(take, eyes[i].pupil);
        const int corner[2] = { fap_take_find(take, eyes[i].corner[0]),
                                fap_take_find(take, eyes[i].corner[1]) };
        for (uint32_t f = 0; pupil >= 0 && corner[0] >= 0 && corner[1] >= 0 && f < take->frame_count; f++)
            put_pupil(take, f, (uint32_t)pupil, corner, numbers);
    }
}

/* Without the corners of an eye its pupil has no place. */
static int has_corners(const take_grid *g)
{
    int found = 0;

    for (uint32_t p = 0; p < g->point_count; p++)
        for (int i = 0; i < 4; i++)
            found += text_is(g->point[p].name, eyes[i / 2].corner[i % 2]);
    return found == 4;
}

/* --- faces --- */

/* Rows of several people are interleaved; the grid keeps to the one with most rows. Returns how many others there are. */
static unsigned choose_face(take_grid *g)
{
    uint32_t rows[MAX_FACES] = { 0 };
    text_lines lines = g->body;
    unsigned best = 0, faces = 0;
    text line;
    double v;

    g->owner_column = optional(&g->row, "face_id");
    while (g->owner_column >= 0 && text_next(&lines, &line)) {
        text_split(line, g->separator, &g->row);
        if (text_number(text_cell(&g->row, (size_t)g->owner_column), &v) == TEXT_NUMBER && v >= 0 &&
            v < MAX_FACES)
            rows[(unsigned)v]++;
    }
    for (unsigned i = 0; i < MAX_FACES; i++) {
        best = rows[i] > rows[best] ? i : best;
        faces += rows[i] > 0;
    }
    g->owner = best;
    if (faces < 2)
        g->owner_column = -1;
    return faces > 1 ? faces - 1 : 0;
}

/* --- reading --- */

static void find_columns(take_grid *g)
{
    g->separator = ',';
    g->frame_column = optional(&g->row, "frame");
    g->time_column = optional(&g->row, "timestamp");
    g->filter[0].column = optional(&g->row, "confidence");
    g->filter[0].least = least_confidence;
    g->filter[1].column = optional(&g->row, "success");
    g->filter[1].least = 1;
    g->mm_per_unit = 1;
    g->scale[1] = g->scale[2] = -1;
    add_points(g);
}

static fap_err openface_read(take_source *src, fap_take **take)
{
    text_lines lines = text_open(src->data, src->size);
    take_grid *g = grid_open(src);
    text line;

    if (!g || !text_next(&lines, &line)) {
        grid_close(src, g);
        return g ? take_fail(src, FAP_E_SYNTAX, "openface: no head line") : FAP_E_NOMEM;
    }
    text_split(line, ',', &g->row);
    find_columns(g);
    const int gaze = has_corners(g) ? add_gaze(g) : 0;
    g->body = lines;
    const unsigned others = choose_face(g);
    const double face = g->owner;
    const fap_err err = grid_read(src, g, "openface", take);
    grid_close(src, g);
    if (err != FAP_OK)
        return err;
    if (gaze)
        put_pupils(*take, gaze);
    if (others)
        take_note(*take, "%u faces; number %g has most rows and is taken", others + 1, face);
    return FAP_OK;
}

const take_driver take_driver_openface = { "openface", openface_claims, openface_read };
