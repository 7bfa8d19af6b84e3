/* SPDX-License-Identifier: BSD-2-Clause */
/* All sinks, and which name asks for which. */
#include <string.h>
#include <strings.h>

#include "player/name_pattern.h"
#include "player/sinks/sink.h"

const play_sink *const play_sinks[] = {
    &sink_png,   &sink_png_sequence, &sink_video, &sink_csv, &sink_glb,
    &sink_sheet, &sink_golden,       &sink_null,  &sink_y4m, NULL,
};

static const struct {
    const char *extension;
    const play_sink *one, *many; /* many: the name has a number in it */
} by_extension[] = {
    { ".png", &sink_png, &sink_png_sequence },
    { ".mp4", &sink_video, NULL },
    { ".webm", &sink_video, NULL },
    { ".mkv", &sink_video, NULL },
    { ".webp", &sink_video, NULL },
    { ".gif", &sink_video, NULL },
    { ".y4m", &sink_y4m, NULL },
    { ".csv", &sink_csv, NULL },
    { ".glb", &sink_glb, NULL },
    { ".null", &sink_null, NULL },
};

const play_sink *sink_by_name(const char *output)
{
    const char *dot = strrchr(output, '.');
    name_pattern pattern;

    if (!strcmp(output, "null"))
        return &sink_null;
    if (!strcmp(output, "-"))
        return &sink_csv; /* the one format that a pipe is good for */
    if (!dot || strchr(dot, '/') || !name_pattern_parse(&pattern, output))
        return NULL;
    for (size_t i = 0; i < sizeof by_extension / sizeof *by_extension; i++)
        if (!strcasecmp(dot, by_extension[i].extension))
            return pattern.digits ? by_extension[i].many : by_extension[i].one;
    return NULL;
}
