/* SPDX-License-Identifier: BSD-2-Clause */
/* The built-in face as a file, to be damaged by tests. */
#ifndef LIB_SHAPE_BANK_FILE_TEST_H
#define LIB_SHAPE_BANK_FILE_TEST_H

#include <fap/bank.h>

#include "shape/bytes.h"

/* With that many principal components; 0: none. For the caller to free. */
fap_bytes test_bank_file(int components);
/* For fap_writer: @p user is a fap_bytes. */
int test_bank_take(void *user, const void *data, size_t size);
/* What loading says; the bank is closed. */
fap_err test_bank_load(const uint8_t *data, size_t size);
/* A chunk's place in the table, and its bytes; a test without the chunk fails. */
uint8_t *test_bank_entry(fap_bytes *file, const char *tag);
uint8_t *test_bank_chunk(fap_bytes *file, const char *tag);
/* Makes every checksum right again, so that a test reaches the check behind it. */
void test_bank_seal(fap_bytes *file);
uint32_t test_get32(const uint8_t *p);
void test_put32(uint8_t *p, uint32_t v);

#endif
