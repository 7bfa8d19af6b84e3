/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Writes a take as TRC: millimetres, a row a frame, empty cells where a point is missing. Source: the layout of real files of Motion
 * Analysis's and OpenSim's programs.
 */
#include <stdio.h>

#include <fap/studio/take.h>

#include "take/text_out.h"

static void put_whole(text_out *o, uint32_t value)
{
    text_put_number(o, value, 0);
}

static void put_fields(text_out *o, const fap_take *take)
{
    text_put(o, "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNu"
                "mFrames\n");
    text_put_number(o, take->rate_hz, 6);
    text_put(o, "\t");
    text_put_number(o, take->rate_hz, 6);
    text_put(o, "\t");
    put_whole(o, take->frame_count);
    text_put(o, "\t");
    put_whole(o, take->point_count);
    text_put(o, "\tmm\t");
    text_put_number(o, take->rate_hz, 6);
    text_put(o, "\t1\t");
    put_whole(o, take->frame_count);
    text_put(o, "\n");
}

static void put_names(text_out *o, const fap_take *take)
{
    text_put(o, "Frame#\tTime");
    for (uint32_t i = 0; i < take->point_count; i++) {
        text_put(o, "\t");
        text_put_name(o, take->name[i], '\t');
        text_put(o, "\t\t");
    }
    text_put(o, "\n\t");
    for (uint32_t i = 1; i <= take->point_count; i++)
        for (int axis = 0; axis < 3; axis++) {
            static const char *const letter[3] = { "\tX", "\tY", "\tZ" };
            text_put(o, letter[axis]);
            put_whole(o, i);
        }
    text_put(o, "\n\n");
}

static void put_frame(text_out *o, const fap_take *take, uint32_t frame)
{
    put_whole(o, frame + 1);
    text_put(o, "\t");
    text_put_number(o, frame / take->rate_hz, 6);
    for (uint32_t i = 0; i < take->point_count; i++) {
        const float *at = fap_take_sample(take, frame, i);
        for (int axis = 0; axis < 3; axis++) {
            text_put(o, "\t");
            if (at)
                text_put_number(o, (double)at[axis], 5);
        }
    }
    text_put(o, "\n");
}

fap_err fap_take_write_trc(const fap_take *take, const char *title, const fap_writer *out)
{
    text_out o = { .to = out };

    if (!(take->rate_hz > 0))
        return FAP_E_ARG;
    text_put(&o, "PathFileType\t4\t(X/Y/Z)\t");
    text_put_name(&o, title, '\t');
    text_put(&o, "\n");
    put_fields(&o, take);
    put_names(&o, take);
    for (uint32_t f = 0; f < take->frame_count && !o.failed; f++)
        put_frame(&o, take, f);
    return o.failed ? FAP_E_IO : FAP_OK;
}
