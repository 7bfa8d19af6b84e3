/* SPDX-License-Identifier: BSD-2-Clause */
/* The list of figures. A new one is a row here and a function beside the others. */
#include <stddef.h>

#include "bench.h"

static const char faces[] = "../shared/data/faces/ict";
static const char takes[] = "../shared/data/takes";
static const char gap_takes[] = "../shared/data/takes/optical_animface";
static const char held_out[] =
    "RMS, 20 held-out mixes of six shapes, half of them with one the bank lacks; face 190 mm high";

const bench_figure bench_figures[] = {
    { "encode_x_realtime", "x", bench_encode_x_realtime,
      "tests/assets/demo_take.c3d: 56 markers at 120 Hz, read and encoded at 25",
      "tests/assets/demo_take.c3d" },
    { "encode_x_realtime_c3d", "x", bench_encode_x_realtime_c3d,
      "optical_animface/jaw_60hz.c3d: 41 markers at 60 Hz; file in memory to frames, as above, to 25 Hz",
      takes },
    { "encode_x_realtime_openface", "x", bench_encode_x_realtime_openface,
      "openface/openfacer_lara_0001-0600.csv: 68 points at 30 Hz", takes },
    { "encode_x_realtime_mediapipe", "x", bench_encode_x_realtime_mediapipe,
      "mediapipe/wolfgang_facemesh478_24fps.csv: 478 points at 24 Hz", takes },
    { "encode_x_realtime_livelink", "x", bench_encode_x_realtime_livelink,
      "livelink/alex_rom_3.csv: 61 coefficients at 30 Hz", takes },
    { "read_mb_s_c3d", "MB/s", bench_read_mb_s_c3d,
      "optical_animface/jaw_60hz.c3d, 1.0 MB: file to take in memory, the fastest of half a second",
      gap_takes },
    { "read_mb_s_trc", "MB/s", bench_read_mb_s_trc, "optical_animface/jaw_60hz.trc, 1.9 MB of text",
      gap_takes },
    { "read_mb_s_csv", "MB/s", bench_read_mb_s_csv,
      "optical_animface/eyebrows_60hz_nexus.csv, 0.9 MB of text", gap_takes },
    { "read_c3d_x_ezc3d", "x", bench_read_c3d_x_ezc3d,
      "the same C3D by ezc3d's library, in the same run; at least 3",
      "ezc3d for python3 (skipped), or the take" },
#define X(frames, text)                                                                                      \
    { "gap_fill_error_mm_" #frames, "mm", bench_gap_fill_error_mm_##frames,                                  \
      text " of one marker hidden, refilled: mean over 41 markers of two takes at 60 Hz, 4 gaps a marker",   \
      gap_takes },
    X(5, "5 frames") X(30, "30 frames") X(120, "120 frames")
#undef X
        { "gap_fill_error_mm_hardly", "mm", bench_gap_fill_error_mm_hardly,
          "a marker in sight for 0.5 s at either end only: mean over the axes that have a FAP, one marker "
          "after the other",
          gap_takes },
    { "head_residual_mm", "mm", bench_head_residual_mm,
      "real takes of markers: RMS of the rigid ones about their places, head motion out. Below "
      "by take, and "
      "of one made up, with 0.1 mm of noise along each axis, whose cap slips by 8 mm while the face "
      "talks",
      takes },
    { "reencode_error_mm", "mm", bench_reencode_error_mm,
      "real takes to FAPs, played by the default face, whose skin is measured where the markers are "
      "glued: mean over markers "
      "of feature points, frames and axes that have a FAP. Below by take",
      takes },
    { "reencode_axes_mm", "mm", bench_reencode_axes_mm,
      "the same along the axes for which there is no FAP: what FAPs cannot say", takes },
    { "reencode_quant_mm", "mm", bench_reencode_quant_mm,
      "what coding adds along the axes that have a FAP: the farthest, fap_quant 1; at most 0.2", takes },
    { "mirror_rms_mm", "mm", bench_mirror_rms_mm,
      "54 dots of 3 mm, two mirrors, 640x480, noise and a hand before the mouth, against the truth; the "
      "paper's is 1.95",
      "" },
    { "mirror_max_mm", "mm", bench_mirror_max_mm, "the worst of all dots and pictures; the paper's is 2.94",
      "" },
    { "mirror_placed_share", "", bench_mirror_placed_share,
      "of all dots and pictures; many are in one view only", "" },
    { "track_fps", "pictures/s", bench_track_fps,
      "all dots in all views, 640x480, following alone; the paper's is 30", "" },
    { "offscreen_fps_640x480_52k", "frames/s", bench_offscreen_fps_52k,
      "ICT-FaceKit, 52,220 triangles, every vertex moved, smoothed, read back; at least 40 where two cores "
      "are free",
      faces },
    { "offscreen_fps_512_default", "frames/s", bench_offscreen_fps_default,
      "build/default.fbank, 19 FAPs moving, 512 x 512, smoothed, read back", "OpenGL" },
    { "render_overhead_ratio", "x", bench_render_overhead_ratio,
      "pose, send, draw, read against a bare clear, draw, read of the unmoved mesh with the same shaders and "
      "smoothing; at most 1.15. Below, against one lamp and no smoothing",
      "OSMesa" },
    { "startup_ms", "ms", bench_startup_ms,
      "from starting fapplay to its end, with one picture of 512 x 512 written as PNG; default face",
      "OpenGL" },
    { "video_x_realtime", "x", bench_video_x_realtime,
      "fapplay of the demo take, default face, 512 x 512 mp4 with sound, from start to end of the process",
      "ffmpeg" },
    { "av_offset_ms", "ms", bench_av_offset_ms,
      "a minute of 66 FAPs moving at 25 Hz with its sound, SDL's dummy driver, 512 x 512 offscreen: the "
      "largest "
      "difference between the sound's position and the time of the picture when it is there",
      "SDL2, libsndfile or OpenGL" },
    { "seek_ms", "ms", bench_seek_ms,
      "the same, playing: from a seek until its picture is there; median of 51",
      "SDL2, libsndfile or OpenGL" },
    { "gpio_trigger_ms", "ms", bench_gpio_trigger_ms,
      "edge to first frame posed, median; emulated machine (QEMU without KVM, gpio-sim), no picture drawn",
      "QEMU and a kernel for it (scripts/packages-ci.txt)" },
    { "ascii_parse_fps", "frames/s", bench_ascii_parse_fps,
      "60,000 frames of 58 FAPs, from memory; at least 1000000", "" },
    { "ascii_write_fps", "frames/s", bench_ascii_write_fps, "the same frames, into memory", "" },
    { "fba_decode_fps", "frames/s", bench_fba_decode_fps,
      "the streams named below at fap_quant 1, I plane every 250 frames; at least 300000", "a take" },
    { "fba_encode_fps", "frames/s", bench_fba_encode_fps, "the same; at least 300000", "a take" },
    { "fba_decode_fps_58", "frames/s", bench_fba_decode_fps_58,
      "58 FAPs that never rest: 6,000 frames of sines", "" },
    { "fba_encode_fps_58", "frames/s", bench_fba_encode_fps_58, "the same", "" },
    { "fba_kbps_q1", "kbit/s", bench_fba_kbps_q1,
      "fap_quant 1, I plane every 250 frames; median of the streams below", "a take" },
    { "fba_kbps_q4", "kbit/s", bench_fba_kbps_q4, "the same, fap_quant 4", "a take" },
    { "fba_kbps_q8", "kbit/s", bench_fba_kbps_q8, "the same, fap_quant 8", "a take" },
    { "gzip_kbps", "kbit/s", bench_gzip_kbps,
      "the same streams as .fap text, as libfap writes it, gzip -9; median", "zlib" },
    { "xz_kbps", "kbit/s", bench_xz_kbps, "the same, xz -9e", "the program xz" },
    { "fba_kbps_2k_error_mm", "mm", bench_fba_kbps_2k_error_mm,
      "2,000 bit/s: mean error of all places commanded, default face; median. Below also what was used",
      "a take" },
    { "fba_2k_window_bits", "bits", bench_fba_2k_window_bits,
      "2,000 bit/s, sines too: most bits in any 2 s of any stream, counted in what was decoded; at most 4000",
      "a take" },
    { "loss_error_mm_0", "mm", bench_loss_error_mm_0,
      "fap_quant 1, I plane every second, every plane a unit, nothing lost: mean error, default face; median",
      "a take" },
    { "loss_error_mm_5", "mm", bench_loss_error_mm_5, "the same, 5 % of the units lost at random, 20 seeds",
      "a take" },
    { "loss_error_mm_10", "mm", bench_loss_error_mm_10, "the same, 10 %", "a take" },
    { "loss_error_mm_20", "mm", bench_loss_error_mm_20, "the same, 20 %", "a take" },
    { "rtp_kbps_on_wire", "kbit/s", bench_rtp_kbps_on_wire,
      "0.5 mm, no look-ahead, 25 fps, a packet a frame, IPv4, UDP and RTP headers counted; median",
      "a take" },
    { "rtp_kbps_on_wire_aggregate_4", "kbit/s", bench_rtp_kbps_on_wire_aggregate_4,
      "the same, four frames a packet", "a take" },
    { "net_loss_error_mm_1", "mm", bench_net_loss_error_mm_1,
      "the same, 1 % of packets lost and each 20 to 50 ms on the way, planes repeated while loss is "
      "reported: mean error, "
      "default face; median",
      "a take" },
    { "net_loss_error_mm_5", "mm", bench_net_loss_error_mm_5, "the same, 5 %", "a take" },
    { "net_loss_error_mm_10", "mm", bench_net_loss_error_mm_10, "the same, 10 %", "a take" },
    { "net_loss_error_mm_20", "mm", bench_net_loss_error_mm_20, "the same, 20 %", "a take" },
    { "decoder_state_bytes", "bytes", bench_decoder_state_bytes,
      "allocated by fap_decoder_open() with default options; at most 65536", "memory" },
    { "libfap_text_bytes", "bytes", bench_libfap_text_bytes,
      "the decoder alone, -Os, code and constants, by a partial link from decoder.h's functions", "ld" },
#define X(name, blend, regions, residual)                                                                    \
    { "fidelity_mm_" #name, "mm", bench_fidelity_mm_##name, held_out, faces },                               \
        { "fidelity_max_mm_" #name, "mm", bench_fidelity_max_mm_##name, "the farthest vertex of all",        \
          faces },                                                                                           \
        { "fidelity_fap_mm_" #name, "mm", bench_fidelity_fap_mm_##name, "RMS, the same faces from FAPs",     \
          faces },
    BENCH_FIDELITY(X)
#undef X
        { "fitness_zhu_midpoint", "cosine", bench_fitness_zhu_midpoint,
          "20 unseen mixes of three keys x 10 seeds, all feature points; Zhu 2006 has 0.960 on scans",
          "a face" },
    { "fitness_zhu_line", "cosine", bench_fitness_zhu_line, "the same; 0.970 there", "a face" },
    { "fitness_zhu_blx", "cosine", bench_fitness_zhu_blx, "the same; 0.962 there", "a face" },
    { "fitness_zhu2", "cosine", bench_fitness_zhu2, "left and right; 0.960 -> 0.972 there", "a face" },
    { "fitness_zhu4", "cosine", bench_fitness_zhu4, "four regions; 0.981 there", "a face" },
    { "fitness_ga", "cosine", bench_fitness_ga, "the same by the default method", "a face" },
    { "blend_us_zhu", "us", bench_blend_us_zhu, "66 FAPs moving to a surface, default face, no normals",
      "a face" },
    { "blend_us_zhu4", "us", bench_blend_us_zhu4, "the same, four regions", "a face" },
    { "blend_us_ga", "us", bench_blend_us_ga, "the same by the default method", "a face" },
    { "blend_us_ga4", "us", bench_blend_us_ga4, "the same, four regions", "a face" },
    { "blend_us_qp", "us", bench_blend_us_qp, "the same by least squares alone", "a face" },
    { "fat_us", "us", bench_fat_us, "the same by face animation tables alone", "a face" },
    { "fat_mm", "mm", bench_fat_mm,
      "these tables against least squares, 100 mixes of four units, all FAPs; mean of the vertices that move",
      "a face" },
    { "qp_us_50x60", "us", bench_qp_us_50x60,
      "50 weights within 0 to 1, 180 rows, inner products made once; slope at the answer within 1e-6; at "
      "most 50",
      "an exact answer" },
    { "pose_us_26k", "us", bench_pose_us_26k,
      "66 FAPs moving, default method, normals, 26,719 vertices of ICT-FaceKit; at most 200", faces },
    { "keys_us_26k", "us", bench_keys_us_26k,
      "the same from weights of keys, without solver and residual: all that libraries without FAPs do",
      faces },
    { "pose_us_default", "us", bench_pose_us_default, "the same on the default face", "a face" },
    { "temporal_jitter_mm", "mm", bench_temporal_jitter_mm,
      "RMS from frame to frame over the default face, noise of 0.1 mm RMS on every axis of every point",
      "a face" },
    { "temporal_jitter_held_mm", "mm", bench_temporal_jitter_held_mm,
      "the same with temporal_mm2 100 and without the residual", "a face" },
    { "pca_ccr_1", "share", bench_pca_ccr_1,
      "of the variance of six visemes (PP, FF, aa, E, oh, ou) in one component; Yano et al. have 0.776 of "
      "their six",
      "a face" },
    { "pca_ccr_2", "share", bench_pca_ccr_2, "the same in two; 0.903", "a face" },
    { "pca_ccr_3", "share", bench_pca_ccr_3, "the same in three; 0.956", "a face" },
    { "arkit_fap_mm", "mm", bench_arkit_fap_mm,
      "FAPs to ARKit's 52 coefficients and back: RMS over all places commanded, all real streams and the "
      "demo "
      "take, default face; median. Below, of all streams together, the same by FAP group",
      "a take" },
    { "arkit_face_mm", "mm", bench_arkit_face_mm,
      "the same of the face as shown, visemes and expressions too: mean distance of the vertices that move "
      "by 0.1 mm or "
      "more; median",
      "a take" },
    { "arkit_us", "us", bench_arkit_us, "a frame of FAPs to coefficients, demo take", "a take" },
    { "arkit_roundtrip_error", "share", bench_arkit_roundtrip_error,
      "ARKit's 52 coefficients to FAPs and back: mean absolute error of a coefficient; three Live Link takes "
      "at their own "
      "rate, mean of the takes",
      takes },
    { "arkit_roundtrip_mm", "mm", bench_arkit_roundtrip_mm,
      "the same on the default face: mean distance of the vertices that move by 0.1 mm or more; every tenth "
      "frame",
      takes },
    { "arkit_roundtrip_ict_mm", "mm", bench_arkit_roundtrip_ict_mm,
      "the same on ICT-FaceKit, moved by its own shapes and not by FAPs; face 190 mm high", faces },
    { "arkit_played_ict_mm", "mm", bench_arkit_played_ict_mm,
      "coefficients to FAPs to ICT-FaceKit as a bank, against its own shapes: what a player shows of them; "
      "EyeLook and "
      "MouthClose left out",
      faces },
    { "glb_worst_mm", "mm", bench_glb_worst_mm,
      "fapplay -o take.glb of the demo take, default face: the farthest vertex of all key frames", "a take" },
#define X(name, method)                                                                                      \
    { "fit_s_" #name, "s", bench_fit_s_##name,                                                               \
      "ICT-FaceKit's 9,409 vertices onto 3 scans of 33,000 triangles with 0.2 mm of noise, a tenth of them " \
      "missing, 68 "                                                                                         \
      "landmarks 1 mm "                                                                                      \
      "off along each axis; mean. The best other known: 13.5",                                               \
      faces },                                                                                               \
        { "fit_surface_rms_mm_" #name, "mm", bench_fit_surface_rms_mm_##name,                                \
          "from the true surface; others: 0.29 to 0.43", faces },                                            \
        { "fit_correspondence_rms_mm_" #name, "mm", bench_fit_correspondence_rms_mm_##name,                  \
          "each vertex from its true place; others: 1.2 to 1.8", faces },                                    \
        { "fit_folds_" #name, "edges", bench_fit_folds_##name,                                               \
          "folded past a right angle, and not so on the person; mean of 28,000", faces },                    \
        { "fit_wrong_lip_" #name, "vertices", bench_fit_wrong_lip_##name,                                    \
          "of lips or lids, on the other one; mean", faces },                                                \
        { "fit_wrong_lip_clear_" #name, "vertices", bench_fit_wrong_lip_clear_##name,                        \
          "of these, nearer to the other one by more than the scan's noise of 0.2 mm", faces },
    BENCH_REGISTRATION(X)
#undef X
        { "fit_700k_s", "s", bench_fit_700k_s, "auto, the same face onto 700,000 triangles", faces },
    { "retarget_us", "us", bench_retarget_us,
      "a motion of the default face's 21,129 vertices on another head of its structure", "a face" },
    { "retarget_error_mm", "mm", bench_retarget_error_mm,
      "there and back, one structure: RMS over feature points and key models", "a face" },
    { "retarget_other_error_mm", "mm", bench_retarget_other_error_mm,
      "ICT-FaceKit's shapes through the default face and back: RMS of vertices that move by 1 mm or more",
      faces },
    { NULL, NULL, NULL, NULL, NULL },
};
