/* SPDX-License-Identifier: BSD-2-Clause */
/* Any bytes as the files of a range image: the camera, a float map, a grey PNG. What is read is meshed. */
#include <stdint.h>
#include <stdlib.h>

#include <fap/studio/range.h>

#include "databank/range/depth_png.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void mesh(float *depth, uint32_t columns, uint32_t rows)
{
    static const fap_range_camera camera = { 100, 100, 1, 1, 1, "d", "" };
    const fap_range_image im = { .columns = columns, .rows = rows, .depth = depth };
    fap_surface *s = NULL;

    if (fap_range_surface(&s, &im, &camera, NULL) == FAP_OK)
        for (uint32_t t = 0; t < s->triangle_count; t++)
            for (int c = 0; c < 3; c++)
                if (s->triangle[t][c] >= s->vertex_count)
                    abort();
    fap_surface_close(&s);
    free(depth);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fap_range_camera camera;
    char where[FAP_ERROR_TEXT_SIZE];
    uint32_t columns, rows;
    float *depth;

    if (fap_range_camera_read(&camera, data, size, where) == FAP_OK && !(camera.fx > 0))
        abort();
    if (fap_range_read_pfm(&depth, &columns, &rows, data, size, NULL) == FAP_OK)
        mesh(depth, columns, rows);
    if (depth_png_read(&depth, &columns, &rows, data, size) == FAP_OK)
        mesh(depth, columns, rows);
    return 0;
}
