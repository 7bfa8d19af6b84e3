/* SPDX-License-Identifier: BSD-2-Clause */
/* How fast a take becomes FAPs: from the file's bytes in memory to the frames. */
#include <stdlib.h>

#include <fap/studio/capture.h>
#include <fap/studio/coefficients.h>

#include "bench.h"
#include "common/file.h"

/* A take, its map, and whether it is points. */
typedef struct input {
    uint8_t *take, *map;
    size_t take_size, map_size;
} input;

/* Seconds of take that one encoding covers; 0 on failure. */
static double encode_points(const input *in)
{
    fap_capture_config cfg;
    fap_capture *capture = NULL;
    fap_take *take = NULL;
    double length_s = 0;

    fap_capture_config_init(&cfg);
    cfg.markers = (const char *)in->map;
    cfg.markers_size = in->map_size;
    if (fap_take_read(&take, in->take, in->take_size, NULL, NULL) == FAP_OK &&
        fap_capture_encode(&capture, take, &cfg, NULL) == FAP_OK)
        length_s = fap_capture_report_get(capture)->take_length_s;
    fap_capture_close(&capture);
    fap_take_close(&take);
    return length_s;
}

static double encode_coefficients(const input *in)
{
    fap_performance *performance = NULL;
    fap_coefficients *take = NULL;
    double length_s = 0;

    if (fap_coefficients_read(&take, in->take, in->take_size, NULL, NULL) == FAP_OK &&
        fap_coefficients_encode(&performance, take, NULL, NULL) == FAP_OK)
        length_s = fap_performance_report(performance)->take_length_s;
    fap_performance_close(&performance);
    fap_coefficients_close(&take);
    return length_s;
}

/* Over at least a second of work. @p map_path may be NULL. */
static double ratio_of(const char *take_path, const char *map_path, double (*encode)(const input *in))
{
    input in = { NULL, NULL, 0, 0 };
    double ratio = -1;

    if (file_read(take_path, 1 << 26, &in.take, &in.take_size) == FAP_OK &&
        (!map_path || file_read(map_path, 1 << 20, &in.map, &in.map_size) == FAP_OK)) {
        const double start = bench_now_s();
        double encoded_s = 0, once_s;
        do
            encoded_s += once_s = encode(&in);
        while (once_s > 0 && bench_now_s() - start < 1);
        if (once_s > 0)
            ratio = encoded_s / (bench_now_s() - start);
    }
    free(in.map);
    free(in.take);
    return ratio;
}

double bench_encode_x_realtime(void)
{
    return ratio_of("tests/assets/demo_take.c3d", "tests/assets/demo_markers.csv", encode_points);
}

double bench_encode_x_realtime_c3d(void)
{
    return ratio_of("../shared/data/takes/optical_animface/jaw_60hz.c3d", NULL, encode_points);
}

double bench_encode_x_realtime_openface(void)
{
    return ratio_of("../shared/data/takes/openface/openfacer_lara_0001-0600.csv", NULL, encode_points);
}

double bench_encode_x_realtime_mediapipe(void)
{
    return ratio_of("../shared/data/takes/mediapipe/wolfgang_facemesh478_24fps.csv", NULL, encode_points);
}

double bench_encode_x_realtime_livelink(void)
{
    return ratio_of("../shared/data/takes/livelink/alex_rom_3.csv", NULL, encode_coefficients);
}
