/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * A program behind a pipe: started with an argument vector, never through a shell.
 */
#ifndef COMMON_CHILD_PIPE_H
#define COMMON_CHILD_PIPE_H

#include <stddef.h>
#include <sys/types.h>

typedef struct child_pipe {
    pid_t pid; /* 0: not running */
    int fd;    /* our end */
} child_pipe;

/* What the pipe is to the program: its standard input or its standard output. */
typedef enum child_side { CHILD_READS, CHILD_WRITES } child_side;

/* @return 0 or an errno; ENOENT: there is no such program. SIGPIPE is ignored from here on. */
int child_pipe_start(child_pipe *c, char *const argv[], child_side side);
/* All of it, or an errno; EPIPE: the program gave up. */
int child_pipe_write(child_pipe *c, const void *data, size_t size);
/* Up to @size bytes, fewer at the end of what it says; -1: errno. */
long child_pipe_read(child_pipe *c, void *data, size_t size);
/* Ends the pipe and waits. @return 0 when it said that all went well, else its exit status or -1. */
int child_pipe_finish(child_pipe *c);
/* Kills it. Harmless when it is not running. */
void child_pipe_abandon(child_pipe *c);

#endif
