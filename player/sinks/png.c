/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Pictures in files: one of the first frame of the range ("out.png"), or one of each ("out_%04d.png",
 * numbered like the frames). A sequence that cannot be finished is taken away again.
 */
#include <stdlib.h>
#include <unistd.h>

#include "common/tool.h"
#include "player/name_pattern.h"
#include "player/sinks/picture_file.h"
#include "player/sinks/sink.h"

enum { LEVEL_KEEP = 6, LEVEL_SEQUENCE = 1 };

typedef struct png_state {
    name_pattern pattern;
    int64_t from, written;
    int finished;
} png_state;

static int png_open(void *state, const sink_setup *setup, fault *f)
{
    png_state *s = state;

    s->from = setup->from;
    if (!name_pattern_parse(&s->pattern, setup->output))
        return fault_set(f, EXIT_USAGE, "%s: one %%d or %%0Nd is the number of the frame", setup->output);
    return 1;
}

static int png_show(void *state, const shown_frame *shown, fault *f)
{
    png_state *s = state;
    char *path = name_pattern_make(&s->pattern, shown->number);

    if (!path)
        return fault_set(f, EXIT_DATA, "out of memory");
    const int ok = picture_write(shown->picture, path, s->pattern.digits ? LEVEL_SEQUENCE : LEVEL_KEEP, f);
    s->written += ok;
    free(path);
    return ok;
}

static int png_finish(void *state, sink_result *result, fault *f)
{
    (void)result, (void)f;
    ((png_state *)state)->finished = 1;
    return 1;
}

static void png_close(void *state)
{
    png_state *s = state;

    for (int64_t i = 0; !s->finished && i < s->written; i++) {
        char *path = name_pattern_make(&s->pattern, s->from + i);
        if (path)
            unlink(path);
        free(path);
    }
}

const play_sink sink_png = {
    .name = "png",
    .summary = "NAME.png            one picture: frame A of --frames, else the middle one",
    .needs_picture = 1,
    .choice = SINK_FIRST_FRAME,
    .state_size = sizeof(png_state),
    .open = png_open,
    .show = png_show,
    .finish = png_finish,
    .close = png_close,
};

const play_sink sink_png_sequence = {
    .name = "png sequence",
    .summary = "NAME_%04d.png       a picture of every frame",
    .needs_picture = 1,
    .state_size = sizeof(png_state),
    .open = png_open,
    .show = png_show,
    .finish = png_finish,
    .close = png_close,
};
