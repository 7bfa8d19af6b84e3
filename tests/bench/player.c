/* SPDX-License-Identifier: BSD-2-Clause */
/* How fast a face is posed and drawn offscreen, and what moving it costs beside drawing it still; both in one
 * run. */
#include <stdlib.h>

#include <fap/derive.h>
#include <fap/face.h>

#include "bench.h"
#include "player/render/renderer.h"
#include "takes.h"

enum { SIZE = 512, FRAMES = 120 };

typedef struct stage {
    fap_bank *bank;
    fap_face *face;
    renderer *renderer;
    float *position, *normal;
    image picture;
} stage;

static void close_stage(stage *s)
{
    image_free(&s->picture);
    renderer_destroy(&s->renderer);
    free(s->normal);
    free(s->position);
    fap_face_close(&s->face);
    fap_bank_close(&s->bank);
}

static int open_stage(stage *s)
{
    char where[FAP_ERROR_TEXT_SIZE];

    *s = (stage){ .bank = bench_bank() };
    if (!s->bank || fap_face_open(&s->face, s->bank, NULL) != FAP_OK)
        return 0;
    const size_t size = 3 * sizeof(float) * fap_face_stride(s->face);
    s->position = aligned_alloc(32, size);
    s->normal = aligned_alloc(32, size);
    return s->position && s->normal && image_create(&s->picture, SIZE, SIZE) == FAP_OK &&
           renderer_create(&s->renderer, NULL, s->bank, SIZE, SIZE, where) == FAP_OK;
}

/* A talking head's load: jaw, lips, brows, lids and head in motion. */
static void pose(stage *s, int i)
{
    static const int faps[] = { 3, 19, 20, 31, 32, 33, 34, 48, 49, 51, 52, 53, 54, 55, 56, 57, 58, 59, 60 };
    fap_frame frame = { 0 };

    for (size_t k = 0; k < sizeof faps / sizeof *faps; k++) {
        frame.state[faps[k]] = FAP_CODED;
        frame.value[faps[k]] = (i * (7 + (int)k)) % 240 - 60;
    }
    fap_derive(&frame);
    fap_face_pose(s->face, &frame, s->position, s->normal);
}

static double seconds_per_frame(stage *s, int moving)
{
    const render_scene scene = { s->position, s->normal, .view = render_view_of(CAMERA_FRONT) };

    pose(s, 0);
    const double start = bench_now_s();
    for (int i = 0; i < FRAMES; i++) {
        if (moving)
            pose(s, i);
        if (renderer_draw(s->renderer, &scene, &s->picture) != FAP_OK)
            return -1;
    }
    return (bench_now_s() - start) / FRAMES;
}

double bench_play_fps(void)
{
    stage s;
    const double moving = open_stage(&s) ? seconds_per_frame(&s, 1) : -1;

    close_stage(&s);
    return moving > 0 ? 1 / moving : -1;
}

double bench_render_overhead(void)
{
    stage s;
    double ratio = -1;

    if (open_stage(&s)) {
        const double still = seconds_per_frame(&s, 0), moving = seconds_per_frame(&s, 1);
        ratio = still > 0 && moving > 0 ? moving / still : -1;
    }
    close_stage(&s);
    return ratio;
}
