/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The figures of "make bench". A figure is a function that measures; figures.c lists them in the order they are printed.
 */
#ifndef TESTS_BENCH_H
#define TESTS_BENCH_H

#include <fap/frame.h>

typedef struct bench_figure {
    const char *name, *unit;
    double (*measure)(void); /* negative: what it needs is not there */
    const char *remark;      /* what was measured, on which input */
    const char *needs;       /* what is missing when it cannot be measured */
} bench_figure;

extern const bench_figure bench_figures[]; /* ends with a NULL name */

/* A value of one stream, printed behind the figure being measured: "# stream NAME VALUE UNIT". */
void bench_note(const char *stream, double value, const char *unit);

/* The middle one of @p value[count], which is sorted; the mean of the two where count is even. */
double bench_median(double *value, int count);

/* Seconds on a monotonic clock. */
double bench_now_s(void);

/* Seconds of take encoded in a second. */
double bench_encode_x_realtime(void);
/* The same of real takes of four formats. */
double bench_encode_x_realtime_c3d(void);
double bench_encode_x_realtime_openface(void);
double bench_encode_x_realtime_mediapipe(void);
double bench_encode_x_realtime_livelink(void);
/* File to take, and how many times as fast as ezc3d reads the same C3D. */
double bench_read_mb_s_c3d(void);
double bench_read_mb_s_trc(void);
double bench_read_mb_s_csv(void);
double bench_read_c3d_x_ezc3d(void);

/* Dots in films of a face between mirrors: places against the truth, and pictures a second. */
double bench_mirror_rms_mm(void);
double bench_mirror_max_mm(void);
double bench_mirror_placed_share(void);
double bench_track_fps(void);

/* Millimetres off, where so many frames of a marker were hidden and refilled. */
double bench_gap_fill_error_mm_5(void);
double bench_gap_fill_error_mm_30(void);
double bench_gap_fill_error_mm_120(void);
/* The same of FAPs, where a marker is in sight for half a second at either end of the take. */
double bench_gap_fill_error_mm_hardly(void);

/* How far rigid markers still move when the head's motion is out. */
double bench_head_residual_mm(void);

/* Markers to FAPs to the default face to markers: along axes that have a FAP, along the others, and what coding adds. */
double bench_reencode_error_mm(void);
double bench_reencode_axes_mm(void);
double bench_reencode_quant_mm(void);

/* Pictures a second of a moving face, and what a frame costs against bare OpenGL; the player's first picture. */
double bench_offscreen_fps_52k(void);
double bench_offscreen_fps_default(void);
double bench_render_overhead_ratio(void);
double bench_startup_ms(void);
double bench_video_x_realtime(void);

/* The window's clock: how far picture and sound are apart, and how long a seek takes. */
double bench_av_offset_ms(void);
double bench_seek_ms(void);

/* Milliseconds from an edge of a GPIO line to the first frame. */
double bench_gpio_trigger_ms(void);

/* Frames of 58 FAPs that the .fap reader takes in a second. */
double bench_ascii_parse_fps(void);
double bench_ascii_write_fps(void);

/* Frames of real streams that the FBA codec writes and reads in a second; the same with 58 FAPs in motion. */
double bench_fba_decode_fps(void);
double bench_fba_encode_fps(void);
double bench_fba_decode_fps_58(void);
double bench_fba_encode_fps_58(void);
/* Kbit/s of real streams at three quantisers; the error at 2,000 bit/s, and the most bits in any 2 s there. */
double bench_fba_kbps_q1(void);
double bench_fba_kbps_q4(void);
double bench_fba_kbps_q8(void);
double bench_fba_kbps_2k_error_mm(void);
double bench_fba_2k_window_bits(void);
/* The same streams as text, packed by general tools. */
double bench_gzip_kbps(void);
double bench_xz_kbps(void);
/* Errors of feature points where units are lost. */
double bench_loss_error_mm_0(void);
double bench_loss_error_mm_5(void);
double bench_loss_error_mm_10(void);
double bench_loss_error_mm_20(void);
double bench_rtp_kbps_on_wire(void);
double bench_rtp_kbps_on_wire_aggregate_4(void);
double bench_net_loss_error_mm_1(void);
double bench_net_loss_error_mm_5(void);
double bench_net_loss_error_mm_10(void);
double bench_net_loss_error_mm_20(void);
/* What a decoder with default options allocates. */
double bench_decoder_state_bytes(void);
double bench_libfap_text_bytes(void);

/* Microseconds from FAPs to a face, by each method; with normals, on the default face and on 26,719 vertices. */
double bench_blend_us_zhu(void);
double bench_blend_us_zhu4(void);
double bench_blend_us_qp(void);
double bench_blend_us_ga(void);
double bench_blend_us_ga4(void);
double bench_pose_us_default(void);
double bench_pose_us_26k(void);
double bench_keys_us_26k(void);
double bench_qp_us_50x60(void);
/* Face animation tables: mean distance from the solver, and a pose. */
double bench_fat_mm(void);
double bench_fat_us(void);
/* Mean cosine reached on 20 mixes of three keys, over 10 seeds (Zhu 2006, table 3.1 and section 3.4.2). */
double bench_fitness_zhu_midpoint(void);
double bench_fitness_zhu_line(void);
double bench_fitness_zhu_blx(void);
double bench_fitness_zhu2(void);
double bench_fitness_zhu4(void);
double bench_fitness_ga(void);
double bench_temporal_jitter_mm(void);
double bench_temporal_jitter_held_mm(void);
double bench_pca_ccr_1(void);
double bench_pca_ccr_2(void);
double bench_pca_ccr_3(void);

/* FAPs to ARKit's coefficients and back: what is lost, at the feature points and on the face; and how long it takes. */
double bench_arkit_fap_mm(void);
double bench_arkit_face_mm(void);
double bench_arkit_us(void);
/* ARKit's coefficients to FAPs and back, on real takes: as coefficients, on the default face, on ICT-FaceKit's shapes. */
double bench_arkit_roundtrip_error(void);
double bench_arkit_roundtrip_mm(void);
double bench_arkit_roundtrip_ict_mm(void);
/* Coefficients to FAPs to ICT-FaceKit as a bank, against its shapes. */
double bench_arkit_played_ict_mm(void);

/* The farthest vertex of a glTF export from the player's. */
double bench_glb_worst_mm(void);

/* Frame @p t of smooth motion: every @p step-th FAP from 3 on. */
void bench_wave(fap_frame *frame, int t, int step);

/* Seconds with as many triangles as a laser scanner makes. */
double bench_fit_700k_s(void);

/* Motions on another face and back: of one structure, and through another. */
double bench_retarget_us(void);
double bench_retarget_error_mm(void);
double bench_retarget_other_error_mm(void);

/* A face laid onto scans whose truth is known; X(name, method). */
#define BENCH_REGISTRATION(X)                                                                                \
    X(auto, FAP_REGISTER_AUTO)                                                                               \
    X(zhu, FAP_REGISTER_ZHU) X(yano, FAP_REGISTER_YANO) X(lorenzo, FAP_REGISTER_LORENZO)
#define X(name, method)                                                                                      \
    double bench_fit_s_##name(void);                                                                         \
    double bench_fit_surface_rms_mm_##name(void);                                                            \
    double bench_fit_correspondence_rms_mm_##name(void);                                                     \
    double bench_fit_folds_##name(void);                                                                     \
    double bench_fit_wrong_lip_##name(void);                                                                 \
    double bench_fit_wrong_lip_clear_##name(void);
BENCH_REGISTRATION(X)
#undef X

/* X(name, method, regions, residual): RMS in millimetres from feature points, the worst vertex, RMS from FAPs. */
#define BENCH_FIDELITY(X)                                                                                    \
    X(rbf, FAP_BLEND_RBF, 1, 0)                                                                              \
    X(bones, FAP_BLEND_BONES, 1, 0)                                                                          \
    X(zhu, FAP_BLEND_ZHU, 1, 0)                                                                              \
    X(zhu2, FAP_BLEND_ZHU, 2, 0)                                                                             \
    X(zhu4, FAP_BLEND_ZHU, 4, 0)                                                                             \
    X(pca, FAP_BLEND_PCA, 1, 1)                                                                              \
    X(qp, FAP_BLEND_QP, 1, 1)                                                                                \
    X(ga, FAP_BLEND_GA, 1, 1)                                                                                \
    X(ga4, FAP_BLEND_GA, 4, 1)                                                                               \
    X(fat, FAP_BLEND_FAT, 1, 1)
#define X(name, blend, regions, residual)                                                                    \
    double bench_fidelity_mm_##name(void);                                                                   \
    double bench_fidelity_max_mm_##name(void);                                                               \
    double bench_fidelity_fap_mm_##name(void);
BENCH_FIDELITY(X)
#undef X

#endif
