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
    { "fba_decode_fps", "frames/s", bench_fba_decode_fps,
      "the takes named above at fap_quant 1, I plane every 250 frames; at least 300000", "a take" },
    { "fba_encode_fps", "frames/s", bench_fba_encode_fps, "the same; at least 300000", "a take" },
    { "fba_decode_fps_58", "frames/s", bench_fba_decode_fps_58,
      "58 FAPs that never rest: 6,000 frames of sines", "" },
    { "fba_encode_fps_58", "frames/s", bench_fba_encode_fps_58, "the same", "" },
    { "decoder_state_bytes", "bytes", bench_decoder_state_bytes,
      "allocated by fap_decoder_open() with default options; at most 65536", "memory" },
    { "libfap_text_bytes", "bytes", bench_libfap_text_bytes,
      "the decoder alone, -Os, code and constants, by a partial link from decoder.h's functions", "ld" },
    { "pose_ga_us", "us", bench_face_ga_us, "66 FAPs moving, default face, without normals", "a face" },
    { "pose_qp_us", "us", bench_face_qp_us, "the same by least squares alone", "a face" },
    { "pose_zhu_us", "us", bench_face_zhu_us, "the same by the thesis's GA", "a face" },
    { "pose_normals_us", "us", bench_face_normals_us, "vertex normals on top", "a face" },
    { "zhu_fitness_midpoint", "cosine", bench_zhu_fitness_midpoint,
      "20 unseen mixes of keys x 10 seeds; Zhu 2006 has 0.960 on scans", "a face" },
    { "zhu_fitness_line", "cosine", bench_zhu_fitness_line, "the same; 0.970 there", "a face" },
    { "zhu_fitness_blx", "cosine", bench_zhu_fitness_blx, "the same; 0.962 there", "a face" },
    { "ga_fitness", "cosine", bench_ga_fitness, "the same by the default method", "a face" },
    { NULL, NULL, NULL, NULL, NULL },
};
