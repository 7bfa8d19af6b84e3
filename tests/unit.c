/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Runs every TEST() that is linked in, or those whose "group.name" contains the first argument.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "test.h"

enum { MAX_TESTS = 4096 };

static test_case *first;

void test_register(test_case *test)
{
    test->next = first;
    first = test;
}

const char *test_shared(const char *path)
{
    static char full[1024];
    const char *root = getenv("FAP_SHARED");

    snprintf(full, sizeof full, "%s/%s", root ? root : "../shared", path);
    if (access(full, R_OK)) {
        fprintf(stderr, "SKIP: %s is not there\n", full);
        skip();
    }
    return full;
}

/* cmocka counts and prints; tests/run reads its closing lines. */
static void run_one(void **state)
{
    ((test_case *)*state)->run();
}

static int by_name(const void *a, const void *b)
{
    const test_case *const *x = a, *const *y = b;
    const int group = strcmp((*x)->group, (*y)->group);
    return group ? group : strcmp((*x)->name, (*y)->name);
}

static int selected(const test_case *t, const char *what)
{
    char name[256];
    snprintf(name, sizeof name, "%s.%s", t->group, t->name);
    return !what || strstr(name, what);
}

int main(int argc, char **argv)
{
    static test_case *all[MAX_TESTS];
    static struct CMUnitTest tests[MAX_TESTS];
    static char names[MAX_TESTS][160];
    size_t count = 0;

    for (test_case *t = first; t && count < MAX_TESTS; t = t->next)
        if (selected(t, argc > 1 ? argv[1] : NULL))
            all[count++] = t;
    qsort(all, count, sizeof *all, by_name);
    for (size_t i = 0; i < count; i++) {
        snprintf(names[i], sizeof names[i], "%s.%s", all[i]->group, all[i]->name);
        tests[i] = (struct CMUnitTest){ names[i], run_one, NULL, NULL, all[i] };
    }
    const int failed = _cmocka_run_group_tests("unit", tests, count, NULL, NULL);
    return failed ? 1 : count == 0;
}
