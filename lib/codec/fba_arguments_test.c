/* SPDX-License-Identifier: BSD-2-Clause */
/* What callers of the FBA decoder do wrong is refused and harms nobody. */
#include "tests/test.h"

#include <string.h>

#include <fap/decoder.h>

#include "codec/bits.h"

static fap_err open_with(int default_bound, int symbol_memory, size_t struct_size)
{
    fap_decoder_config cfg;
    fap_decoder *d;

    fap_decoder_config_init(&cfg);
    cfg.default_bound = default_bound;
    cfg.symbol_memory = symbol_memory;
    cfg.struct_size = struct_size ? struct_size : cfg.struct_size;
    const fap_err err = fap_decoder_open(&d, &cfg);
    assert_true((err == FAP_OK) == (d != NULL));
    fap_decoder_close(&d);
    return err;
}

TEST(fba_arguments, options_out_of_their_range_are_refused)
{
    assert_int_equal(open_with(1860, 0, 0), FAP_OK);
    assert_int_equal(open_with(1861, 0, 0), FAP_E_ARG);
    assert_int_equal(open_with(-1, 0, 0), FAP_E_ARG);
    assert_int_equal(open_with(0, 65534, 0), FAP_OK);
    assert_int_equal(open_with(0, 65535, 0), FAP_E_ARG);
    assert_int_equal(open_with(0, -1, 0), FAP_E_ARG);
    assert_int_equal(open_with(0, 0, sizeof(size_t)), FAP_E_ARG);
    assert_int_equal(open_with(0, 0, sizeof(fap_decoder_config) + 8), FAP_OK); /* a program of the future */
    assert_int_equal(fap_decoder_open(NULL, NULL), FAP_E_ARG);
}

TEST(fba_arguments, nothing_where_something_must_be_is_refused)
{
    static const uint8_t unit[4] = { 0, 0, 1, 0xB1 };
    fap_decoder *d;
    fap_frame f;

    assert_int_equal(fap_decoder_open(&d, NULL), FAP_OK);
    assert_int_equal(fap_decoder_send(NULL, unit, sizeof unit), FAP_E_ARG);
    assert_int_equal(fap_decoder_send(d, unit, 0), FAP_E_ARG);
    assert_int_equal(fap_decoder_send(d, NULL, 4), FAP_E_ARG);
    assert_int_equal(fap_decoder_send(d, unit, SIZE_MAX / 2), FAP_E_ARG);
    assert_int_equal(fap_decoder_receive(NULL, &f), FAP_E_ARG);
    assert_int_equal(fap_decoder_receive(d, NULL), FAP_E_ARG);
    assert_string_equal(fap_decoder_last_error(NULL), "");
    assert_string_equal(fap_decoder_last_error(d), "");
    assert_int_equal(fap_decoder_send(d, unit, sizeof unit), FAP_OK);
    assert_int_equal(fap_decoder_receive(d, &f), FAP_E_END);
    fap_decoder_close(&d);
    fap_decoder_close(&d);
    fap_decoder_close(NULL);
}

TEST(fba_arguments, a_reader_that_is_fine_has_nothing_to_say)
{
    static const uint8_t byte = 0x80;
    fap_bits b;

    fap_bits_init(&b, &byte, 1);
    assert_string_equal(fap_bits_why(&b), "");
    fap_bits_marker(&b);
    assert_string_equal(fap_bits_why(&b), "");
    fap_bits_marker(&b);
    assert_string_equal(fap_bits_why(&b), "a marker bit is 0");
}
