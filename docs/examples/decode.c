/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * A receiver: packets on standard input, a byte count of 16 bits in front of each, 0 for one that was lost. Prints the
 * jaw of every frame, and whether it was sent or predicted.
 *   cc -Iinclude docs/examples/decode.c build/release/libfap.a -lm -o decode && ./encode | ./decode
 */
#include <stdio.h>
#include <stdlib.h>

#include <fap/fap.h>

enum { MAX_PACKET = 65535, OPEN_JAW = 3 };

static void show(const fap_frame *frame)
{
    const char *const state[] = { "never sent", "sent", "held", "derived", "predicted" };

    printf("%6.2f s  open_jaw %5d  %s\n", (double)frame->pts_us * 1e-6, (int)frame->value[OPEN_JAW],
           state[frame->state[OPEN_JAW]]);
}

/* Every frame of one packet. After an error the next frames are predicted until an I plane comes: nothing to do. */
static void receive_all(fap_decoder *decoder)
{
    fap_frame frame;
    fap_err err;

    while ((err = fap_decoder_receive(decoder, &frame)) != FAP_E_AGAIN && err != FAP_E_END)
        if (err == FAP_OK)
            show(&frame);
        else
            fprintf(stderr, "decode: %s\n", fap_decoder_last_error(decoder));
}

static int read_size(void)
{
    const int high = getchar(), low = getchar();

    return low == EOF ? -1 : high << 8 | low;
}

int main(void)
{
    static uint8_t packet[MAX_PACKET];
    fap_decoder *decoder;
    int size;

    fap_err err = fap_decoder_open(&decoder, NULL); /* 64 KiB, and no allocation from here on */
    while (!err && (size = read_size()) >= 0) {
        if (fread(packet, 1, (size_t)size, stdin) != (size_t)size)
            err = FAP_E_DATA;
        else
            err = size ? fap_decoder_send(decoder, packet, (size_t)size) : fap_decoder_send(decoder, NULL, 0);
        if (!err)
            receive_all(decoder);
    }
    if (err)
        fprintf(stderr, "decode: %s\n", fap_strerror(err));
    fap_decoder_close(&decoder);
    return err != FAP_OK;
}
