/* SPDX-License-Identifier: BSD-2-Clause */
/* What the tests of takes share: bytes in memory, files of the test data, small made-up takes. */
#ifndef LIB_TAKE_TAKE_TEST_H
#define LIB_TAKE_TAKE_TEST_H

#include "tests/test.h"

#include <stdlib.h>
#include <string.h>

#include <fap/studio/take.h>

#include "common/file.h"

typedef struct test_bytes {
    uint8_t *data;
    size_t size, room;
} test_bytes;

static inline int test_bytes_write(void *user, const void *data, size_t size)
{
    test_bytes *b = user;

    if (b->size + size > b->room) {
        b->room = (b->size + size) * 2;
        b->data = realloc(b->data, b->room);
        assert_non_null(b->data);
    }
    if (size)
        memcpy(b->data + b->size, data, size);
    b->size += size;
    return 0;
}

static inline fap_writer test_bytes_writer(test_bytes *b)
{
    return (fap_writer){ test_bytes_write, b };
}

static inline fap_err test_read_text(fap_take **take, const char *text, char *where)
{
    return fap_take_read(take, text, strlen(text), NULL, where);
}

/* Reads data/takes/NAME of the shared test data; skips the test where that is absent. */
static inline fap_err test_read_shared(fap_take **take, const char *name, char *where)
{
    char path[256];
    uint8_t *data;
    size_t size;

    snprintf(path, sizeof path, "data/takes/%s", name);
    assert_int_equal(file_read(test_shared(path), 64 << 20, &data, &size), FAP_OK);
    const fap_err err = fap_take_read(take, data, size, NULL, where);
    free(data);
    return err;
}

#endif
