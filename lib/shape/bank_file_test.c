/* SPDX-License-Identifier: BSD-2-Clause */
/* See bank_file_test.h. */
#include "shape/bank_file_test.h"

#include <string.h>

#include <fap/studio/bank_build.h>

#include "bank/format.h"
#include "tests/test.h"

int test_bank_take(void *user, const void *data, size_t size)
{
    fap_bytes_put(user, data, size);
    return ((fap_bytes *)user)->failed;
}

fap_bytes test_bank_file(int components)
{
    fap_bytes file = { 0 };
    const fap_writer w = { test_bank_take, &file };
    fap_bank *bank;
    fap_bank_builder *b;

    assert_int_equal(fap_bank_builtin(&bank, NULL), FAP_OK);
    assert_int_equal(fap_bank_builder_copy(&b, bank), FAP_OK);
    assert_int_equal(fap_bank_builder_basis(b, components), FAP_OK);
    assert_int_equal(fap_bank_builder_write(b, &w), FAP_OK);
    fap_bank_builder_close(&b);
    fap_bank_close(&bank);
    return file;
}

fap_err test_bank_load(const uint8_t *data, size_t size)
{
    fap_bank *bank;
    const fap_err err = fap_bank_load(&bank, data, size, NULL);

    assert_true((err == FAP_OK) == (bank != NULL));
    fap_bank_close(&bank);
    return err;
}

void test_put32(uint8_t *p, uint32_t v)
{
    for (int i = 0; i < 4; i++)
        p[i] = (uint8_t)(v >> 8 * i);
}

uint32_t test_get32(const uint8_t *p)
{
    return p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}

uint8_t *test_bank_entry(fap_bytes *file, const char *tag)
{
    for (uint32_t i = 0; i < test_get32(file->data + 12); i++)
        if (!memcmp(file->data + FBANK_HEAD_SIZE + i * FBANK_ENTRY_SIZE, tag, 4))
            return file->data + FBANK_HEAD_SIZE + i * FBANK_ENTRY_SIZE;
    fail();
    return NULL;
}

uint8_t *test_bank_chunk(fap_bytes *file, const char *tag)
{
    return file->data + test_get32(test_bank_entry(file, tag) + 4);
}

void test_bank_seal(fap_bytes *file)
{
    const uint32_t count = test_get32(file->data + 12);

    for (uint32_t i = 0; i < count; i++) {
        uint8_t *e = file->data + FBANK_HEAD_SIZE + i * FBANK_ENTRY_SIZE;
        if (test_get32(e + 4) <= file->size && test_get32(e + 8) <= file->size - test_get32(e + 4))
            test_put32(e + 12, fbank_crc32(file->data + test_get32(e + 4), test_get32(e + 8)));
    }
    test_put32(file->data + 20, fbank_crc32(file->data + FBANK_HEAD_SIZE, count * FBANK_ENTRY_SIZE));
}
