/* SPDX-License-Identifier: BSD-2-Clause */
/* A contact sheet: some moments, evenly spread over the range, in one picture with their times. */
#include <math.h>
#include <stdio.h>

#include "common/tool.h"
#include "player/sinks/picture_file.h"
#include "player/sinks/sheet.h"
#include "player/sinks/sink.h"

enum { LEVEL_KEEP = 6 };

typedef struct sheet_state {
    const sink_setup *setup;
    image sheet;
    int columns, shown;
} sheet_state;

void sheet_label(char *out, size_t room, double time_s)
{
    const long long cs = llround(time_s * 100);
    const int hours = (int)(cs / 360000), minutes = (int)(cs / 6000 % 60);
    const double seconds = (double)(cs % 6000) / 100;

    if (hours)
        snprintf(out, room, "%d:%02d:%05.2f", hours, minutes, seconds);
    else if (minutes)
        snprintf(out, room, "%d:%05.2f", minutes, seconds);
    else
        snprintf(out, room, "%.2f s", seconds);
}

static int sheet_open(void *state, const sink_setup *setup, fault *f)
{
    sheet_state *s = state;
    int rows;

    s->setup = setup;
    image_sheet_grid((int)setup->count, &s->columns, &rows);
    if (image_create(&s->sheet, s->columns * setup->width, rows * setup->height))
        return fault_set(f, EXIT_USAGE,
                         "a sheet of %d x %d pictures of %d x %d pixels is too large; try a smaller --size",
                         s->columns, rows, setup->width, setup->height);
    return 1;
}

static int sheet_show(void *state, const shown_frame *shown, fault *f)
{
    static const uint8_t ink[3] = { 32, 34, 38 };
    sheet_state *s = state;
    const int x = s->shown % s->columns * s->setup->width, y = s->shown / s->columns * s->setup->height;
    const int scale = s->setup->width >= 320 ? s->setup->width / 160 : 1;
    char label[32];

    (void)f;
    image_blit(&s->sheet, shown->picture, x, y);
    sheet_label(label, sizeof label, shown->time_s);
    image_text(&s->sheet, x + 4 * scale, y + 4 * scale, scale, ink, label);
    s->shown++;
    return 1;
}

static int sheet_finish(void *state, sink_result *result, fault *f)
{
    sheet_state *s = state;

    (void)result;
    return picture_write(&s->sheet, s->setup->output, LEVEL_KEEP, f);
}

static void sheet_close(void *state)
{
    image_free(&((sheet_state *)state)->sheet);
}

const play_sink sink_sheet = {
    .name = "sheet",
    .summary = "--sheet N -o NAME.png   N moments in one picture",
    .needs_picture = 1,
    .choice = SINK_MOMENTS,
    .state_size = sizeof(sheet_state),
    .open = sheet_open,
    .show = sheet_show,
    .finish = sheet_finish,
    .close = sheet_close,
};
