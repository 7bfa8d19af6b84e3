/* SPDX-License-Identifier: BSD-2-Clause */
/* An interpolation table at work in the decoder. */
#include "tests/test.h"

#include <string.h>

#include <fap/decoder.h>

#include "codec/arith.h"
#include "codec/bits.h"

enum { LEVEL = 5, BOUND = 900 };

/* One I plane: FAP 31 of group 4 is sent, the others of the group have mask @p type. */
static size_t write_plane(uint8_t *data, size_t size, uint32_t type)
{
    fap_bit_writer w;
    arith_encoder a;
    const uint32_t symbols = 2 * BOUND + 1, above = symbols - 1 - (LEVEL + BOUND);

    fap_bit_writer_init(&w, data, size);
    fap_bits_put(&w, 32, 0x000001BA); /* fba_object_start_code */
    fap_bits_put(&w, 1, 1);           /* is_intra */
    fap_bits_put(&w, 2, 1);           /* fba_object_mask */
    fap_bits_put(&w, 3, 0);           /* is_frame_rate, is_time_code, skip_frames */
    fap_bits_put(&w, 5, 1);           /* fap_quant */
    for (int group = 1; group <= 10; group++) {
        fap_bits_put(&w, 1, 1);                     /* marker */
        fap_bits_put(&w, 2, group == 4 ? type : 0); /* fap_mask_type */
        fap_bits_put(&w, group == 4 ? 8 : 0, 0x80); /* FAP 31 */
    }
    fap_bits_put(&w, 6, 0); /* fba_suggested_gender, fba_object_coding_type, no new ranges */
    fap_arith_encoder_begin(&a, &w);
    fap_arith_encoder_put(&a, (arith_interval){ above, above + 1, symbols });
    fap_arith_encoder_end(&a);
    fap_bits_put_stuffing(&w);
    fap_bits_put(&w, 32, 0x000001B1);
    return (size_t)(w.at + 7) / 8;
}

static fap_frame decode(uint32_t type, const char *table)
{
    uint8_t data[64];
    fap_decoder_config cfg;
    fap_decoder *d;
    fap_fit *fit;
    fap_frame f;
    const size_t size = write_plane(data, sizeof data, type);

    assert_int_equal(fap_fit_parse(&fit, table, strlen(table), NULL, NULL), FAP_OK);
    fap_decoder_config_init(&cfg);
    cfg.fit = fit;
    assert_int_equal(fap_decoder_open(&d, &cfg), FAP_OK);
    assert_int_equal(fap_decoder_send(d, data, size), FAP_OK);
    assert_int_equal(fap_decoder_receive(d, &f), FAP_OK);
    fap_decoder_close(&d);
    fap_fit_close(&fit);
    return f;
}

static const char table[] = "fap-fit 1\nfrom f31\nf32 = -f31\nf35 = 2*f31\nf3 = f31\n";

TEST(fit, the_decoder_asks_the_table_first_where_the_stream_leaves_faps_to_it)
{
    const fap_frame f = decode(2, table);

    assert_int_equal(f.state[31], FAP_CODED);
    assert_int_equal(f.state[32], FAP_DERIVED);
    assert_int_equal(f.value[32], -f.value[31]); /* the other side would give the same sign */
    assert_int_equal(f.state[35], FAP_DERIVED);
    assert_int_equal(f.value[35], 2 * f.value[31]);
    assert_int_equal(f.value[36], 2 * f.value[31]); /* from 35, by the side */
    assert_int_equal(f.state[3], FAP_ABSENT);       /* nothing is left to the decoder in group 2 */
}

TEST(fit, the_decoder_derives_nothing_where_the_stream_says_hold)
{
    const fap_frame f = decode(1, table);

    assert_int_equal(f.state[31], FAP_CODED);
    assert_int_equal(f.state[32], FAP_ABSENT);
    assert_int_equal(f.state[35], FAP_ABSENT);
}
