/* SPDX-License-Identifier: BSD-2-Clause */
/* Any bytes as what a person gives to the tracker: the table of dots when the first byte is even, else the camera. */
#include <fap/studio/tracks.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void read_dots(const uint8_t *data, size_t size)
{
    char where[FAP_ERROR_TEXT_SIZE];
    fap_track_dots dots;

    if (fap_track_dots_read(&dots, data, size, NULL, where) == FAP_OK)
        fap_track_dots_close(&dots);
}

static void read_camera(const uint8_t *data, size_t size)
{
    char where[FAP_ERROR_TEXT_SIZE];
    double ray[2], pixel[2];
    fap_camera cam;

    if (fap_camera_read(&cam, data, size, where) != FAP_OK)
        return;
    fap_camera_resize(&cam, 320, 240);
    fap_camera_ray(&cam, (const double[2]){ 3, 200 }, ray);
    (void)fap_camera_project(&cam, (const double[3]){ ray[0], ray[1], 1 }, pixel);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (size)
        (*data % 2 ? read_camera : read_dots)(data + 1, size - 1);
    return 0;
}
