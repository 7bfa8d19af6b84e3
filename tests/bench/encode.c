/* SPDX-License-Identifier: BSD-2-Clause */
/* How fast a take becomes FAPs: from the file's bytes in memory to the frames. */
#include <stdlib.h>

#include <fap/studio/capture.h>

#include "bench.h"
#include "common/file.h"

/* Seconds of take that one encoding covers; 0 on failure. */
static double encode(const uint8_t *take_data, size_t take_size, const uint8_t *map, size_t map_size)
{
    fap_capture_config cfg;
    fap_capture *capture = NULL;
    fap_take *take = NULL;
    double length_s = 0;

    fap_capture_config_init(&cfg);
    cfg.markers = (const char *)map;
    cfg.markers_size = map_size;
    if (fap_take_read(&take, take_data, take_size, NULL, NULL) == FAP_OK &&
        fap_capture_encode(&capture, take, &cfg, NULL) == FAP_OK)
        length_s = fap_capture_report_get(capture)->take_length_s;
    fap_capture_close(&capture);
    fap_take_close(&take);
    return length_s;
}

double bench_encode_x_realtime(void)
{
    uint8_t *take = NULL, *map = NULL;
    size_t take_size, map_size;
    double ratio = -1;

    if (file_read("tests/assets/demo_take.c3d", 1 << 26, &take, &take_size) == FAP_OK &&
        file_read("tests/assets/demo_markers.csv", 1 << 20, &map, &map_size) == FAP_OK) {
        const double start = bench_now_s();
        double encoded_s = 0;
        do
            encoded_s += encode(take, take_size, map, map_size);
        while (encoded_s > 0 && bench_now_s() - start < 1);
        if (encoded_s > 0)
            ratio = encoded_s / (bench_now_s() - start);
    }
    free(map);
    free(take);
    return ratio;
}
