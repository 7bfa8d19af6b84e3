/* SPDX-License-Identifier: BSD-2-Clause */
/* See overlay.h. */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/tool.h"
#include "encoder/track/overlay.h"

overlay overlay_of(const char *path, double rate_hz)
{
    return (overlay){ .path = path, .rate_hz = rate_hz, .pipe = { 0, -1 } };
}

static int start(overlay *o, fault *f)
{
    char size[32], rate[32], url[1024];

    snprintf(size, sizeof size, "%dx%d", o->width_px, o->height_px);
    snprintf(rate, sizeof rate, "%.9g", o->rate_hz);
    if (snprintf(url, sizeof url, "file:%s", o->file.temp) >= (int)sizeof url)
        return fault_set(f, EXIT_DATA, "%s: the name is too long", o->path);
    const char *const argv[] = { "ffmpeg",
                                 "-hide_banner",
                                 "-loglevel",
                                 "error",
                                 "-y",
                                 "-f",
                                 "rawvideo",
                                 "-pix_fmt",
                                 "rgb24",
                                 "-video_size",
                                 size,
                                 "-framerate",
                                 rate,
                                 "-i",
                                 "pipe:0",
                                 "-vf",
                                 "pad=ceil(iw/2)*2:ceil(ih/2)*2",
                                 "-c:v",
                                 "libx264",
                                 "-preset",
                                 "veryfast",
                                 "-crf",
                                 "18",
                                 "-pix_fmt",
                                 "yuv420p",
                                 "-f",
                                 "mp4",
                                 url,
                                 NULL };
    char *arguments[sizeof argv / sizeof *argv];
    for (size_t i = 0; i < sizeof argv / sizeof *argv; i++)
        arguments[i] = (char *)(uintptr_t)argv[i];
    const int err = child_pipe_start(&o->pipe, arguments, CHILD_READS);
    return err ? fault_set(f, EXIT_MISSING, "cannot start ffmpeg: %s", strerror(err)) : 1;
}

static int open_it(overlay *o, const fap_picture *picture, fault *f)
{
    o->width_px = picture->width_px;
    o->height_px = picture->height_px;
    o->rgb = malloc(3 * (size_t)o->width_px * (size_t)o->height_px);
    if (!o->rgb)
        return fault_set(f, EXIT_DATA, "out of memory");
    if (out_file_open(&o->file, o->path))
        return fault_set(f, EXIT_DATA, "%s: %s", o->path, strerror(errno));
    return start(o, f);
}

/* A ring a pixel and a half wide. */
static void draw_ring(overlay *o, const fap_track_point *p, double radius)
{
    static const uint8_t colours[3][3] = { { 60, 255, 60 }, { 255, 230, 0 }, { 255, 30, 30 } };
    const uint8_t *rgb = colours[p->state];
    const int reach = (int)ceil(radius) + 2, x0 = (int)lrint(p->x_px), y0 = (int)lrint(p->y_px);

    for (int y = y0 - reach; y <= y0 + reach; y++)
        for (int x = x0 - reach; x <= x0 + reach; x++) {
            if (x < 0 || y < 0 || x >= o->width_px || y >= o->height_px)
                continue;
            const double off = fabs(hypot(x - p->x_px, y - p->y_px) - radius),
                         share = fmin(fmax(1.25 - off, 0), 1);
            uint8_t *at = &o->rgb[3 * ((size_t)y * (size_t)o->width_px + (size_t)x)];
            for (int k = 0; k < 3; k++)
                at[k] = (uint8_t)lrint(at[k] + share * (rgb[k] - at[k]));
        }
}

int overlay_draw(overlay *o, const fap_picture *picture, const fap_tracker *t, int count, fault *f)
{
    if (!o->path || (!o->rgb && !open_it(o, picture, f)))
        return !o->path;
    const size_t row = 3 * (size_t)o->width_px;
    for (int y = 0; y < o->height_px; y++)
        memcpy(o->rgb + (size_t)y * row, picture->rgb + (size_t)y * picture->stride, row);
    for (int i = 0; i < count; i++)
        draw_ring(o, &fap_tracker_points(t)[i], fap_tracker_radius(t, i) + 2.5);
    return child_pipe_write(&o->pipe, o->rgb, row * (size_t)o->height_px)
               ? fault_set(f, EXIT_DATA, "%s: ffmpeg failed; its own words are above", o->path)
               : 1;
}

int overlay_finish(overlay *o, fault *f)
{
    if (!o->path || !o->pipe.pid)
        return 1;
    if (child_pipe_finish(&o->pipe))
        return fault_set(f, EXIT_DATA, "%s: ffmpeg failed; its own words are above", o->path);
    if (out_file_commit(&o->file))
        return fault_set(f, EXIT_DATA, "%s: %s", o->path, strerror(errno));
    return 1;
}

void overlay_close(overlay *o)
{
    child_pipe_abandon(&o->pipe);
    if (o->rgb)
        out_file_abandon(&o->file);
    free(o->rgb);
    o->rgb = NULL;
}
