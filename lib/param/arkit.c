/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * ARKit's names, and coefficients to FAPs: a weighted sum. The other way is lib/bank/arkit_fit.c. See fap/arkit.h.
 */
#include <ctype.h>
#include <math.h>
#include <string.h>

#include <fap/arkit.h>
#include <fap/tables.h>

#include "gen/arkit.h"
#include "gen/arkit_shapes.h"
#include "param/arkit.h"

_Static_assert(SHAPE_END == FAP_ARKIT_COUNT, "arkit_shapes.csv has not 52 rows");

static const char *const shape_names[FAP_ARKIT_COUNT] = {
#define X(shape, name) name,
    ARKIT_SHAPES_ROWS(X)
#undef X
};

static const char *const angle_names[FAP_ARKIT_ANGLE_COUNT] = {
    "HeadYaw",     "HeadPitch",   "HeadRoll",      "LeftEyeYaw",   "LeftEyePitch",
    "LeftEyeRoll", "RightEyeYaw", "RightEyePitch", "RightEyeRoll",
};

/* A shape's rows follow one another, shapes in their order. */
static const struct row {
    uint8_t shape, fap;
    int16_t value;
} rows[] = {
#define X(shape, fap, value) { SHAPE_##shape, fap, value },
    ARKIT_ROWS(X)
#undef X
};

enum { ROW_COUNT = sizeof rows / sizeof *rows };

const float fap_arkit_full_yaw_rad = 0.62f, fap_arkit_full_pitch_rad = 0.54f;

/* --- names --- */

const char *fap_arkit_name(int shape)
{
    return shape >= 0 && shape < FAP_ARKIT_COUNT ? shape_names[shape] : NULL;
}

const char *fap_arkit_angle_name(int angle)
{
    return angle >= 0 && angle < FAP_ARKIT_ANGLE_COUNT ? angle_names[angle] : NULL;
}

static int same_name(const char *a, const char *b)
{
    while (*a && tolower((unsigned char)*a) == tolower((unsigned char)*b)) {
        a++;
        b++;
    }
    return !*a && !*b;
}

int fap_arkit_by_name(const char *name)
{
    for (int s = 0; s < FAP_ARKIT_COUNT; s++)
        if (same_name(shape_names[s], name))
            return s;
    return -1;
}

int fap_arkit_value(int shape, int fap)
{
    for (int i = 0; i < ROW_COUNT; i++)
        if (rows[i].shape == shape && rows[i].fap == fap)
            return rows[i].value;
    return 0;
}

/* --- coefficients to FAPs --- */

static void set(fap_frame *frame, int fap, float value)
{
    const float far = 1e6f;

    frame->state[fap] = FAP_CODED;
    frame->value[fap] = (int32_t)lroundf(fminf(far, fmaxf(-far, value)));
}

static float number(float value)
{
    return isfinite(value) ? value : 0;
}

static void set_head(const fap_arkit *in, fap_frame *frame)
{
    set(frame, 48, -FAP_AU_PER_RAD * number(in->angle[FAP_ARKIT_HEAD_PITCH]));
    set(frame, 49, FAP_AU_PER_RAD * number(in->angle[FAP_ARKIT_HEAD_YAW]));
    set(frame, 50, FAP_AU_PER_RAD * number(in->angle[FAP_ARKIT_HEAD_ROLL]));
}

/* To the face's left. */
static float look_left(const fap_arkit *in, int right)
{
    const float *s = in->shape;
    const float yaw = number(in->angle[right ? FAP_ARKIT_RIGHT_EYE_YAW : FAP_ARKIT_LEFT_EYE_YAW]);
    const float shown = right ? number(s[SHAPE_EyeLookInRight]) - number(s[SHAPE_EyeLookOutRight])
                              : number(s[SHAPE_EyeLookOutLeft]) - number(s[SHAPE_EyeLookInLeft]);
    return in->has_eyes ? -yaw : fap_arkit_full_yaw_rad * shown;
}

static float look_down(const fap_arkit *in, int right)
{
    const float *s = in->shape;
    const float pitch = number(in->angle[right ? FAP_ARKIT_RIGHT_EYE_PITCH : FAP_ARKIT_LEFT_EYE_PITCH]);
    const float shown = right ? number(s[SHAPE_EyeLookDownRight]) - number(s[SHAPE_EyeLookUpRight])
                              : number(s[SHAPE_EyeLookDownLeft]) - number(s[SHAPE_EyeLookUpLeft]);
    return in->has_eyes ? pitch : fap_arkit_full_pitch_rad * shown;
}

void fap_arkit_to_faps(const fap_arkit *in, fap_frame *frame)
{
    float value[FAP_COUNT + 1] = { 0 };

    for (int fap = 1; fap <= FAP_COUNT; fap++) {
        frame->state[fap] = FAP_ABSENT;
        frame->value[fap] = 0;
    }
    for (int i = 0; i < ROW_COUNT; i++)
        value[rows[i].fap] += number(in->shape[rows[i].shape]) * rows[i].value;
    for (int i = 0; i < ROW_COUNT; i++)
        set(frame, rows[i].fap, value[rows[i].fap]);
    for (int right = 0; right < 2; right++) {
        set(frame, 23 + right, FAP_AU_PER_RAD * look_left(in, right));
        set(frame, 25 + right, FAP_AU_PER_RAD * look_down(in, right));
    }
    if (in->has_head)
        set_head(in, frame);
}
