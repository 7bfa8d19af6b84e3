/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Any bytes as a marker table over a small take, and then the whole chain: whatever the table makes of the
 * markers must be encoded or refused.
 */
#include <stdio.h>
#include <stdlib.h>

#include <fap/studio/capture.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { POINTS = 10, FRAMES = 12 };

/* Places that also depend on the input, so that degenerate faces come up. */
static void fill(fap_take *take, const uint8_t *data, size_t size)
{
    for (uint32_t p = 0; p < POINTS; p++)
        snprintf(take->name[p], FAP_TAKE_NAME_SIZE, "%c", 'A' + (int)p);
    for (uint32_t f = 0; f < FRAMES; f++)
        for (uint32_t p = 0; p < POINTS; p++) {
            const unsigned b = size ? data[(f * POINTS + p) % size] : 0;
            const float v[3] = { (float)(p * 37 % 11) * 10 + (float)(b & 7), (float)(p * 53 % 13) * 10,
                                 (float)(b >> 4) };
            if (b != 'x')
                fap_take_set(take, f, p, v);
        }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char where[FAP_ERROR_TEXT_SIZE];
    fap_capture_config cfg;
    fap_capture *c;
    fap_take *take;

    if (fap_take_create(&take, POINTS, FRAMES, NULL) != FAP_OK)
        return 0;
    take->rate_hz = 25;
    fill(take, data, size);
    fap_capture_config_init(&cfg);
    cfg.markers = (const char *)data;
    cfg.markers_size = size;
    if (fap_capture_encode(&c, take, &cfg, where) == FAP_OK)
        fap_capture_close(&c);
    fap_take_close(&take);
    return 0;
}
