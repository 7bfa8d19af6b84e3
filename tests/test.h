/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * TEST(group, name_what_should_be_true) { ... } defines a unit test that registers itself; assertions are cmocka's.
 * Tests stand beside what they test (lib/codec/ascii_test.c) and are linked into one program, tests/unit.c.
 */
#ifndef TESTS_TEST_H
#define TESTS_TEST_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

typedef struct test_case {
    const char *group, *name;
    void (*run)(void);
    struct test_case *next;
} test_case;

void test_register(test_case *test);

#define TEST(group, name)                                                                                    \
    static void test_##group##_##name(void);                                                                 \
    static test_case case_##group##_##name = { #group, #name, test_##group##_##name, 0 };                    \
    __attribute__((constructor)) static void register_##group##_##name(void)                                 \
    {                                                                                                        \
        test_register(&case_##group##_##name);                                                               \
    }                                                                                                        \
    static void test_##group##_##name(void)

/*
 * Path of a file of the test data beside the project (data/fap/x.fap), in a static buffer. Where ../shared is absent the
 * test is counted as skipped, in sight. FAP_SHARED names another place.
 */
const char *test_shared(const char *path);

#endif
