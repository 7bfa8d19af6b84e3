/* SPDX-License-Identifier: BSD-2-Clause */
/* A program behind a pipe. */
#include "tests/test.h"

#include <errno.h>

#include "common/child_pipe.h"

static int start(child_pipe *c, const char *script)
{
    char *const argv[] = { "sh", "-c", (char *)(uintptr_t)script, NULL };
    return child_pipe_start(c, argv, CHILD_READS);
}

TEST(child_pipe, a_missing_program_is_named_as_such)
{
    char *const argv[] = { "no-such-program-anywhere", NULL };
    child_pipe c;

    assert_int_equal(child_pipe_start(&c, argv, CHILD_READS), ENOENT);
    child_pipe_abandon(&c);
}

TEST(child_pipe, what_is_written_arrives_and_ends)
{
    child_pipe c;

    assert_int_equal(start(&c, "test \"$(cat)\" = hello"), 0);
    assert_int_equal(child_pipe_write(&c, "hello", 5), 0);
    assert_int_equal(child_pipe_finish(&c), 0);
}

TEST(child_pipe, failure_of_the_program_is_seen)
{
    child_pipe c;

    assert_int_equal(start(&c, "exit 7"), 0);
    assert_int_equal(child_pipe_finish(&c), 7);
}

TEST(child_pipe, a_program_that_gives_up_does_not_take_us_along)
{
    static const uint8_t zeros[1 << 17];
    child_pipe c;

    assert_int_equal(start(&c, "exec true"), 0);
    int err = 0;
    for (int i = 0; i < 64 && !err; i++)
        err = child_pipe_write(&c, zeros, sizeof zeros);
    assert_int_equal(err, EPIPE);
    child_pipe_abandon(&c);
    assert_int_equal(c.pid, 0);
}

TEST(child_pipe, what_a_program_says_can_be_read_to_its_end)
{
    char *const argv[] = { "sh", "-c", "printf hello; exit 3", NULL };
    char said[16];
    child_pipe c;

    assert_int_equal(child_pipe_start(&c, argv, CHILD_WRITES), 0);
    assert_int_equal(child_pipe_read(&c, said, sizeof said), 5);
    assert_memory_equal(said, "hello", 5);
    assert_int_equal(child_pipe_read(&c, said, sizeof said), 0);
    assert_int_equal(child_pipe_finish(&c), 3);
}

TEST(child_pipe, a_program_that_is_not_listened_to_is_no_hang)
{
    char *const argv[] = { "sh", "-c", "while :; do echo again; done", NULL };
    char said[4];
    child_pipe c;

    assert_int_equal(child_pipe_start(&c, argv, CHILD_WRITES), 0);
    assert_int_equal(child_pipe_read(&c, said, sizeof said), 4);
    child_pipe_abandon(&c);
}
