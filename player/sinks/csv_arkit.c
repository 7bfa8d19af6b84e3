/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The table that Live Link Face writes: time code, 61, ARKit's 52 coefficients, nine angles in radians. The frame
 * number of the time code counts sixtieths of a second, as the app's own files do. Source: files of the app.
 */
#include <math.h>

#include <fap/arkit.h>

#include "player/sinks/csv.h"

static int open_arkit(void **state)
{
    fap_arkit_fit *fit;

    if (fap_arkit_fit_open(&fit, NULL) != FAP_OK)
        return 0;
    *state = fit;
    return 1;
}

static void close_arkit(void *state)
{
    fap_arkit_fit *fit = state;

    fap_arkit_fit_close(&fit);
}

static void put_arkit_names(FILE *out, const fap_bank *bank)
{
    (void)bank;
    fputs("Timecode,BlendShapeCount", out);
    for (int s = 0; s < FAP_ARKIT_COUNT; s++)
        fprintf(out, ",%s", fap_arkit_name(s));
    for (int a = 0; a < FAP_ARKIT_ANGLE_COUNT; a++)
        fprintf(out, ",%s", fap_arkit_angle_name(a));
}

static void put_time_code(FILE *out, double time_s)
{
    const long long thousandths = llround(time_s * 60000), s = thousandths / 60000;

    fprintf(out, "%02lld:%02lld:%02lld:%02lld.%03lld", s / 3600 % 24, s / 60 % 60, s % 60,
            thousandths / 1000 % 60, thousandths % 1000);
}

/* -0 is 0 for everybody but text. */
static void put_number(FILE *out, float value)
{
    fprintf(out, ",%.6f", fabsf(value) < 5e-7f ? 0.0 : (double)value);
}

/* The face as it is shown, visemes and expressions too. */
static void put_arkit(FILE *out, const char *head, const shown_frame *shown, const fap_bank *bank,
                      void *state)
{
    fap_frame frame = *shown->frame;
    fap_arkit arkit;

    (void)head;
    fap_face_complete(bank, shown->point, &frame);
    fap_arkit_from_faps(state, &frame, &arkit);
    put_time_code(out, shown->time_s);
    fprintf(out, ",%d", FAP_ARKIT_COUNT + FAP_ARKIT_ANGLE_COUNT);
    for (int s = 0; s < FAP_ARKIT_COUNT; s++)
        put_number(out, arkit.shape[s]);
    for (int a = 0; a < FAP_ARKIT_ANGLE_COUNT; a++)
        put_number(out, arkit.angle[a]);
    fputc('\n', out);
}

static double arkit_size(const fap_bank *bank)
{
    (void)bank;
    return 24 + 11.0 * (FAP_ARKIT_COUNT + FAP_ARKIT_ANGLE_COUNT);
}

const csv_kind csv_arkit = {
    .name = "arkit",
    .open = open_arkit,
    .close = close_arkit,
    .put_names = put_arkit_names,
    .put_frame = put_arkit,
    .frame_size = arkit_size,
};
