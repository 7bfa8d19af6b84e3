/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * A live sender: every frame becomes a packet at once, a byte count of 16 bits in front of each. One packet gets
 * lost on its way, which is a count of 0; docs/examples/decode.c is the other end.
 *   cc -Iinclude docs/examples/encode.c build/release/libfap.a -lm -o encode && ./encode | ./decode
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include <fap/fap.h>

/* Where your capture comes in. */
static void watch(fap_frame *frame, int number)
{
    *frame = (fap_frame){ .number = number, .pts_us = number * INT64_C(40000) };
    frame->state[3] = frame->state[49] = FAP_CODED; /* open_jaw, head_yaw */
    frame->value[3] = (int32_t)(200 + 200 * sin(number * 0.5));
    frame->value[49] = (int32_t)(20000 * sin(number * 0.1));
}

static void send_packet(const uint8_t *data, size_t size, int lost)
{
    putchar((int)(lost ? 0 : size >> 8));
    putchar((int)(lost ? 0 : size & 255));
    if (!lost)
        fwrite(data, 1, size, stdout);
}

/* Frames in, packets out, until the encoder wants the next frame. */
static fap_err drain(fap_encoder *encoder, uint8_t *packet, int lost)
{
    size_t size;
    fap_err err;

    while ((err = fap_encoder_receive(encoder, packet, fap_encoder_bound(encoder), &size)) == FAP_OK)
        if (size) /* a frame that is skipped has none */
            send_packet(packet, size, lost);
    return err == FAP_E_AGAIN || err == FAP_E_END ? FAP_OK : err;
}

int main(void)
{
    fap_encoder_config cfg;
    fap_encoder *encoder;
    fap_frame frame;

    fap_encoder_config_init(&cfg);
    cfg.look_ahead = 0; /* live: nothing is held back */
    cfg.intra = 25;     /* whoever lost a packet waits a second at most */
    cfg.mode = FAP_ENCODE_BITRATE;
    cfg.bitrate_bps = 4000;
    fap_err err = fap_encoder_open(&encoder, &cfg);
    uint8_t *packet = err ? NULL : malloc(fap_encoder_bound(encoder));
    if (!err && !packet)
        err = FAP_E_NOMEM;
    for (int number = 0; !err && number < 100; number++) {
        watch(&frame, number);
        err = fap_encoder_send(encoder, &frame);
        if (!err)
            err = drain(encoder, packet, number == 40);
    }
    if (!err) {
        fap_encoder_flush(encoder);
        err = drain(encoder, packet, 0);
        fprintf(stderr, "encode: %lld bytes for 4 s\n", (long long)fap_encoder_get_stats(encoder).bytes);
    }
    if (err)
        fprintf(stderr, "encode: %s\n", fap_strerror(err));
    free(packet);
    fap_encoder_close(&encoder);
    return err != FAP_OK;
}
