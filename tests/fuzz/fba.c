/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Any bytes through the FBA decoder; what comes out goes through the encoder, whose stream must decode to
 * what the encoder says it holds. The first byte chooses the options.
 */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <fap/decoder.h>
#include <fap/encoder.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { MAX_FRAMES = 64, MAX_CALLS = 100000 };

static void check(int true_or_bug)
{
    if (!true_or_bug)
        abort();
}

static void compare(const fap_frame *got, const fap_frame *want)
{
    for (int fap = 1; fap <= FAP_COUNT; fap++)
        if (want->state[fap] == FAP_CODED)
            check(got->state[fap] == FAP_CODED && (fap < 3 || got->value[fap] == want->value[fap]));
    check(want->state[1] != FAP_CODED || !memcmp(&got->viseme, &want->viseme, sizeof got->viseme));
    check(want->state[2] != FAP_CODED ||
          !memcmp(&got->expression, &want->expression, sizeof got->expression));
}

static void check_packets(fap_encoder *e, fap_decoder *d, uint8_t *out, size_t room)
{
    size_t size;
    int count;
    fap_frame f;

    while (fap_encoder_receive(e, out, room, &size) == FAP_OK) {
        const fap_frame *want = fap_encoder_reconstruction(e, &count);
        check(fap_decoder_send(d, out, size) == FAP_OK);
        for (int i = 0; i < count; i++) {
            check(fap_decoder_receive(d, &f) == FAP_OK);
            compare(&f, &want[i]);
        }
        check(fap_decoder_receive(d, &f) == (count ? FAP_E_AGAIN : FAP_E_END));
    }
}

static void encode(const fap_frame *frame, int count, unsigned options)
{
    fap_encoder_config cfg;
    fap_encoder *e;
    fap_decoder *d;

    fap_encoder_config_init(&cfg);
    cfg.quant = options & 31;
    cfg.intra = MAX_FRAMES / 4;
    cfg.plane_codes = options >> 5 & 1;
    check(fap_encoder_open(&e, &cfg) == FAP_OK && fap_decoder_open(&d, NULL) == FAP_OK);
    const size_t room = fap_encoder_bound(e);
    uint8_t *out = malloc(room);
    check(out != NULL);
    for (int i = 0; i < count; i++) {
        fap_err err;
        while ((err = fap_encoder_send(e, &frame[i])) == FAP_E_AGAIN)
            check_packets(e, d, out, room);
        check(err == FAP_OK || err == FAP_E_LIMIT);
    }
    fap_encoder_flush(e);
    check_packets(e, d, out, room);
    free(out);
    fap_encoder_close(&e);
    fap_decoder_close(&d);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static fap_frame frame[MAX_FRAMES];
    fap_decoder_config cfg;
    fap_decoder *d;
    fap_frame f;
    int count = 0;

    if (size < 2)
        return 0;
    fap_decoder_config_init(&cfg);
    cfg.strict = data[0] >> 7;
    cfg.default_bound = data[0] >> 6 & 1 ? 1020 : 0;
    check(fap_decoder_open(&d, &cfg) == FAP_OK);
    check(fap_decoder_send(d, data + 1, size - 1) == FAP_OK);
    for (int i = 0; i < MAX_CALLS; i++) {
        const fap_err err = fap_decoder_receive(d, &f);
        if (err == FAP_E_AGAIN || err == FAP_E_END)
            break;
        if (err == FAP_OK && count < MAX_FRAMES)
            frame[count++] = f;
    }
    fap_decoder_close(&d);
    encode(frame, count, data[0]);
    return 0;
}
