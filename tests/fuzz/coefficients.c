/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Any bytes as a take of coefficients: the first byte chooses a head that a reader looks for. What is read is encoded and
 * written as well, and all of it again with one allocation that fails.
 */
#include <stdlib.h>
#include <string.h>

#include <fap/studio/coefficients.h>

#include "tests/fuzz/alloc.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static const char *const heads[] = {
    "Timecode,BlendShapeCount,EyeBlinkLeft,JawOpen,MouthClose,HeadYaw,LeftEyeYaw\n",
    "time,jawOpen,eyeBlink_L,mouthClose,jawLeft,tongueOut,cheekPuff\n",
    "frame,timestamp,confidence,success,face_id,pose_Rx,pose_Ry,pose_Rz,gaze_angle_x,gaze_angle_y,AU01_r,AU45_r\n",
    "{\"names\":[\"jawOpen\",\"eyeBlinkLeft\"],\"frames\":[{\"weights\":",
    "{\"facsNames\":[\"jawOpen\",\"mouthClose\"],\"weightMat\":[",
    ""
};

enum { HEADS = sizeof heads / sizeof *heads };

static int count_bytes(void *user, const void *data, size_t size)
{
    (void)data;
    *(size_t *)user += size;
    return 0;
}

static fap_err use(const fap_coefficients *take, unsigned choice)
{
    fap_coefficients_config cfg;
    char where[FAP_ERROR_TEXT_SIZE];
    fap_performance *p;
    size_t written = 0;

    fap_coefficients_config_init(&cfg);
    cfg.rest = (fap_coefficients_rest)(choice % 3);
    cfg.fill = (fap_fill)(choice / 3 % 3);
    const fap_err err = fap_coefficients_encode(&p, take, &cfg, where);
    if ((err == FAP_OK) != (p != NULL))
        abort();
    fap_performance_close(&p);
    if (fap_coefficients_write_livelink(take, &(fap_writer){ count_bytes, &written }) == FAP_OK && !written)
        abort();
    return err;
}

static fap_err read_all(const void *data, size_t size, unsigned choice, fuzz_memory *m)
{
    char where[FAP_ERROR_TEXT_SIZE];
    fap_coefficients *take;
    fap_take_config cfg;

    fap_take_config_init(&cfg);
    cfg.alloc = fuzz_allocator(m);
    fap_err err = fap_coefficients_read(&take, data, size, &cfg, where);
    if ((err == FAP_OK) != (take != NULL) || !memchr(where, '\0', sizeof where))
        abort();
    /* What hundreds of thousands of absent frames become is slow, and nothing new. */
    if (take && take->frame_count < 2000 && (take->rate_hz <= 0 || take->rate_hz >= 10))
        err = use(take, choice);
    fap_coefficients_close(&take);
    fuzz_memory_check(m);
    return err;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_memory all = { 0 };

    if (!size)
        return 0;
    const char *head = heads[data[0] % HEADS];
    const size_t head_size = strlen(head), total = head_size + size - 1;
    uint8_t *bytes = malloc(total + 1);
    if (!bytes)
        return 0;
    memcpy(bytes, head, head_size);
    memcpy(bytes + head_size, data + 1, size - 1);
    const fap_err whole = read_all(bytes, total, data[0] / HEADS, &all);
    if (all.asked) {
        const long n = 1 + (long)(size % (size_t)all.asked);
        fuzz_memory_error(whole, read_all(bytes, total, data[0] / HEADS, &(fuzz_memory){ .fail_at = n }));
    }
    free(bytes);
    return 0;
}
