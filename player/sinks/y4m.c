/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Uncompressed video that every encoder reads, into a file or a pipe: YUV4MPEG2, 4:2:0 with the colour of each four pixels
 * in their middle, BT.709 in the range of television as our films have it. The format cannot say which matrix, readers are
 * to be told.
 */
#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/file.h"
#include "common/tool.h"
#include "player/sinks/sink.h"
#include "player/sinks/y4m.h"

typedef struct y4m_state {
    const char *path;
    out_file file;
    y4m_picture picture;
} y4m_state;

/* --- rates as fractions --- */

y4m_rate y4m_rate_of(double hz)
{
    /* Television's 24000/1001 and its kin, then what has few decimals. */
    const double film = hz * 1001 / 1000;
    const int64_t most = 1000000;

    if (fabs(hz - rint(hz)) > 1e-9 && fabs(film - rint(film)) < 5e-4 * film / 30)
        return (y4m_rate){ 1000 * llrint(film), 1001 };
    for (int64_t below = 1; below < most; below *= 10)
        if (fabs(hz * (double)below - rint(hz * (double)below)) < 1e-6)
            return (y4m_rate){ llrint(hz * (double)below), below };
    return (y4m_rate){ llrint(hz * (double)most), most };
}

/* --- colours --- */

/* BT.709, 16 to 235 and 16 to 240, in 1/65536. */
static uint8_t luma(const uint8_t *p)
{
    return (uint8_t)((11966 * p[0] + 40254 * p[1] + 4064 * p[2] + (16 << 16) + 32768) >> 16);
}

/* Of the sums of four pixels. */
static uint8_t blue_chroma(const int rgb[3])
{
    return (uint8_t)((-6596 * rgb[0] - 22189 * rgb[1] + 28785 * rgb[2] + (128 << 18) + (1 << 17)) >> 18);
}

static uint8_t red_chroma(const int rgb[3])
{
    return (uint8_t)((28784 * rgb[0] - 26145 * rgb[1] - 2639 * rgb[2] + (128 << 18) + (1 << 17)) >> 18);
}

/* At odd sides the last pixel stands for its missing neighbour. */
static void sum_four(const image *im, int x, int y, int rgb[3])
{
    const int right = x + 1 < im->width ? x + 1 : x, below = y + 1 < im->height ? y + 1 : y;
    const size_t width = (size_t)im->width;
    const uint8_t *a = im->rgba + 4 * ((size_t)y * width + (size_t)x);
    const uint8_t *b = im->rgba + 4 * ((size_t)y * width + (size_t)right);
    const uint8_t *c = im->rgba + 4 * ((size_t)below * width + (size_t)x);
    const uint8_t *d = im->rgba + 4 * ((size_t)below * width + (size_t)right);

    for (int i = 0; i < 3; i++)
        rgb[i] = a[i] + b[i] + c[i] + d[i];
}

int y4m_picture_make(y4m_picture *p, int width, int height)
{
    const size_t half = (size_t)((width + 1) / 2) * (size_t)((height + 1) / 2);

    p->size = (size_t)width * (size_t)height + 2 * half;
    p->y = malloc(p->size);
    if (!p->y)
        return 0;
    p->u = p->y + (size_t)width * (size_t)height;
    p->v = p->u + half;
    return 1;
}

void y4m_picture_set(y4m_picture *p, const image *im)
{
    const size_t count = (size_t)im->width * (size_t)im->height;
    uint8_t *u = p->u, *v = p->v;
    int rgb[3];

    for (size_t i = 0; i < count; i++)
        p->y[i] = luma(im->rgba + 4 * i);
    for (int y = 0; y < im->height; y += 2)
        for (int x = 0; x < im->width; x += 2) {
            sum_four(im, x, y, rgb);
            *u++ = blue_chroma(rgb);
            *v++ = red_chroma(rgb);
        }
}

/* --- the sink --- */

static int failed(const y4m_state *s, fault *f)
{
    return fault_set(f, EXIT_DATA, "%s: %s", s->path, strerror(errno));
}

static int y4m_open(void *state, const sink_setup *setup, fault *f)
{
    y4m_state *s = state;
    const y4m_rate rate = y4m_rate_of(setup->rate_hz);

    s->path = setup->output;
    if (!y4m_picture_make(&s->picture, setup->width, setup->height))
        return fault_set(f, EXIT_DATA, "out of memory");
    if (out_file_open(&s->file, s->path))
        return failed(s, f);
    const int written = fprintf(
        s->file.stream, "YUV4MPEG2 W%d H%d F%" PRId64 ":%" PRId64 " Ip A1:1 C420jpeg XCOLORRANGE=LIMITED\n",
        setup->width, setup->height, rate.frames, rate.seconds);
    return written > 0 || failed(s, f);
}

static int y4m_show(void *state, const shown_frame *shown, fault *f)
{
    static const char frame[] = "FRAME\n";
    y4m_state *s = state;

    y4m_picture_set(&s->picture, shown->picture);
    return (fwrite(frame, sizeof frame - 1, 1, s->file.stream) == 1 &&
            fwrite(s->picture.y, s->picture.size, 1, s->file.stream) == 1) ||
           failed(s, f);
}

static int y4m_finish(void *state, sink_result *result, fault *f)
{
    y4m_state *s = state;

    (void)result;
    return out_file_commit(&s->file) ? failed(s, f) : 1;
}

static void y4m_close(void *state)
{
    y4m_state *s = state;

    out_file_abandon(&s->file);
    free(s->picture.y);
}

const play_sink sink_y4m = {
    .name = "video",
    .summary = "NAME.y4m       uncompressed video for encoders",
    .needs_picture = 1,
    .state_size = sizeof(y4m_state),
    .open = y4m_open,
    .show = y4m_show,
    .finish = y4m_finish,
    .close = y4m_close,
};
