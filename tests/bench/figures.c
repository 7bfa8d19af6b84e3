/* SPDX-License-Identifier: BSD-2-Clause */
/* The list of figures. A new one is a row here and a function beside the others. */
#include <stddef.h>

#include "bench.h"

const bench_figure bench_figures[] = {
    { "encode_x_realtime", "x", bench_encode_x_realtime,
      "tests/assets/demo_take.c3d: 56 markers at 120 Hz, read and encoded at 25",
      "tests/assets/demo_take.c3d" },
    { "play_fps_512", "frames/s", bench_play_fps,
      "build/default.fbank, 19 FAPs moving, 512 x 512, 4 samples, read back", "OSMesa" },
    { "render_overhead", "x", bench_render_overhead, "the same against drawing the same mesh unmoved",
      "OSMesa" },
    { "ascii_parse_fps", "frames/s", bench_ascii_parse_fps, "60,000 frames of 58 FAPs, from memory", "" },
    { NULL, NULL, NULL, NULL, NULL },
};
