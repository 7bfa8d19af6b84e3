/* SPDX-License-Identifier: BSD-2-Clause */
/* A camera's numbers from JSON. See <fap/studio/mirror.h>. */
#include <math.h>
#include <stdio.h>

#include <fap/studio/mirror.h>

#include "take/json_text.h"

enum { MATRIX = 9, MOST_PX = 1 << 16 };

/* Up to @most numbers of an array that was entered, row by row where it has rows; how many there were. */
static int read_items(json_text *j, double *out, int most, int depth)
{
    int count = 0, first = 1;

    while (json_text_next(j, ']', &first)) {
        if (depth && json_text_enter(j, '[')) {
            count += read_items(j, out + count, most - count, depth - 1);
            continue;
        }
        double v = 0;
        json_text_number(j, &v);
        if (count < most)
            out[count++] = v;
    }
    return count;
}

static int read_numbers(json_text *j, double *out, int most)
{
    if (json_text_enter(j, '['))
        return read_items(j, out, most, 1);
    json_text_skip(j);
    return 0;
}

/* OpenCV's matrices are objects with "data". */
static int read_matrix(json_text *j, double *out, int most)
{
    int count = 0, first = 1;
    text key;

    if (!json_text_enter(j, '{'))
        return read_numbers(j, out, most);
    while (json_text_next(j, '}', &first) && json_text_key(j, &key)) {
        if (text_is(key, "data"))
            count = read_numbers(j, out, most);
        else
            json_text_skip(j);
    }
    return count;
}

static void read_whole(json_text *j, int *out)
{
    double v;

    if (json_text_number(j, &v) && v >= 1 && v <= MOST_PX)
        *out = (int)v;
}

static void read_camera_matrix(json_text *j, fap_camera *cam)
{
    double m[MATRIX];

    if (read_matrix(j, m, MATRIX) < MATRIX)
        return;
    cam->fx_px = m[0];
    cam->cx_px = m[2];
    cam->fy_px = m[4];
    cam->cy_px = m[5];
}

static double *single_number(text key, fap_camera *cam)
{
    return text_is(key, "fx")   ? &cam->fx_px
           : text_is(key, "fy") ? &cam->fy_px
           : text_is(key, "cx") ? &cam->cx_px
           : text_is(key, "cy") ? &cam->cy_px
                                : NULL;
}

static void read_value(json_text *j, text key, fap_camera *cam)
{
    double *single = single_number(key, cam);

    if (single)
        json_text_number(j, single);
    else if (text_is(key, "width") || text_is(key, "image_width"))
        read_whole(j, &cam->width_px);
    else if (text_is(key, "height") || text_is(key, "image_height"))
        read_whole(j, &cam->height_px);
    else if (text_is(key, "k") || text_is(key, "distortion_coefficients"))
        read_matrix(j, cam->k, 5);
    else if (text_is(key, "camera_matrix"))
        read_camera_matrix(j, cam);
    else
        json_text_skip(j);
}

static const char *what_is_wrong(const fap_camera *c)
{
    if (c->width_px < 1 || c->height_px < 1)
        return "no width and height: of the pictures the camera was calibrated with, in pixels";
    if (!(c->fx_px > 1) || !(c->fy_px > 1) || c->fx_px > 1e6 || c->fy_px > 1e6)
        return "no focal length: fx and fy, in pixels";
    if (!(fabs(c->cx_px) < 1e6) || !(fabs(c->cy_px) < 1e6))
        return "no middle: cx and cy, in pixels";
    for (int i = 0; i < 5; i++)
        if (!(fabs(c->k[i]) < 100))
            return "k: a lens does not bend so much";
    return NULL;
}

fap_err fap_camera_read(fap_camera *cam, const void *data, size_t size, char *where)
{
    json_text j = json_text_open(data, size);
    fap_camera c = { .cx_px = NAN, .cy_px = NAN };
    int first = 1, is_object = json_text_enter(&j, '{');
    text key;

    while (is_object && json_text_next(&j, '}', &first) && json_text_key(&j, &key))
        read_value(&j, key, &c);
    if (!is_object || j.bad) {
        snprintf(where, FAP_ERROR_TEXT_SIZE,
                 "not a JSON object like {\"width\":640,\"height\":480,\"fx\":900,\"fy\":900,"
                 "\"cx\":320,\"cy\":240}");
        return FAP_E_SYNTAX;
    }
    const char *wrong = what_is_wrong(&c);
    if (wrong) {
        snprintf(where, FAP_ERROR_TEXT_SIZE, "%s", wrong);
        return FAP_E_DATA;
    }
    *cam = c;
    *where = '\0';
    return FAP_OK;
}
