/* SPDX-License-Identifier: BSD-2-Clause */
/* See faces_test.h. Named as a test, since it is linked with them alone. */
#include "tests/test.h"

#include <stdio.h>

#include "bank/faces_test.h"

static size_t read_file(void *user, void *buf, size_t size)
{
    return fread(buf, 1, size, user);
}

fap_bank *test_bank(int which)
{
    fap_bank *bank = NULL;

    if (which == BUILTIN) {
        assert_int_equal(fap_bank_builtin(&bank, NULL), FAP_OK);
        return bank;
    }
    FILE *f = fopen("build/default.fbank", "rb");
    if (!f) {
        fprintf(stderr, "SKIP: build/default.fbank is not there\n");
        skip();
    }
    const fap_reader reader = { read_file, f };
    const fap_err err = fap_bank_read(&bank, &reader, NULL);
    fclose(f);
    assert_int_equal(err, FAP_OK);
    return bank;
}
