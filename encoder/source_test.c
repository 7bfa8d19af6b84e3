/* SPDX-License-Identifier: BSD-2-Clause */
/* Frames on their way from a stream to an output. */
#include "tests/test.h"

#include <stdlib.h>
#include <string.h>

#include "encoder/source.h"

static int put_bytes(void *user, const void *data, size_t size)
{
    frame_source *src = user;
    uint8_t *grown = realloc((uint8_t *)(uintptr_t)src->data, src->size + size);

    if (!grown)
        return 1;
    memcpy(grown + src->size, data, size);
    src->data = grown;
    src->size += size;
    return 0;
}

static fap_frame jaw_at(int64_t number, int value)
{
    fap_frame f = { .number = number, .pts_us = number * 40000 };

    f.state[3] = FAP_CODED;
    f.value[3] = value;
    return f;
}

/* The jaw at 10, 20, 30 in frames 0, 1 and 5 of 25 a second. */
static frame_source make_stream(void)
{
    static const int number[] = { 0, 1, 5 };
    frame_source src = { .rate_hz = 25 };
    const fap_writer out = { put_bytes, &src };
    const fap_ascii_header header = { .rate_hz = 25 };
    fap_encoder_config cfg;
    fap_encoder_stats stats;
    stream_writer w;

    fap_encoder_config_init(&cfg);
    cfg.quant = 0;
    assert_int_equal(stream_writer_open(&w, &out, &header, &cfg), FAP_OK);
    for (int i = 0; i < 3; i++) {
        const fap_frame f = jaw_at(number[i], 10 * (i + 1));
        assert_int_equal(stream_writer_put(&w, &f), FAP_OK);
    }
    assert_int_equal(stream_writer_close(&w, &stats), FAP_OK);
    return src;
}

static void drop(frame_source *src)
{
    free((uint8_t *)(uintptr_t)src->data);
}

TEST(source, gives_a_stream_its_own_frames)
{
    frame_source src = make_stream();
    fap_frame *frames;
    size_t count;

    assert_int_equal(frame_source_load(&src, &frames, &count), FAP_OK);
    assert_int_equal(count, 3);
    assert_int_equal(frames[2].pts_us, 200000);
    free(frames);
    drop(&src);
}

TEST(source, holds_the_face_over_frames_that_were_skipped)
{
    static const int value[] = { 10, 20, 20, 20, 20, 30 };
    frame_source src = make_stream();
    fap_frame *frames;
    size_t count;
    int64_t counted;

    src.fill = 1;
    assert_int_equal(frame_source_load(&src, &frames, &count), FAP_OK);
    assert_int_equal(frame_source_count(&src, &counted), FAP_OK);
    assert_int_equal(count, 6);
    assert_int_equal(counted, 6);
    for (int i = 0; i < 6; i++) {
        assert_int_equal(frames[i].value[3], value[i]);
        assert_int_equal(frames[i].state[3], FAP_CODED);
        assert_int_equal(frames[i].pts_us, i * 40000);
    }
    free(frames);
    drop(&src);
}

static fap_err refuse(void *user, const fap_frame *frame)
{
    (void)frame;
    return ++*(int *)user == 2 ? FAP_E_IO : FAP_OK;
}

TEST(source, ends_where_the_taker_fails)
{
    frame_source src = make_stream();
    int taken = 0;

    assert_int_equal(frame_source_each(&src, refuse, &taken), FAP_E_IO);
    assert_int_equal(taken, 2);
    drop(&src);
}

TEST(source, gives_frames_in_memory_as_they_are)
{
    fap_frame two[2] = { jaw_at(0, 1), jaw_at(7, 2) };
    const frame_source src = { .frames = two, .count = 2, .rate_hz = 25 };
    fap_frame *frames;
    size_t count;

    two[1].state[4] = FAP_HELD;
    assert_int_equal(frame_source_load(&src, &frames, &count), FAP_OK);
    assert_int_equal(count, 2);
    assert_memory_equal(frames, two, sizeof two);
    free(frames);
}
