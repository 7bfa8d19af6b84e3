/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * A program behind a pipe: started with an argument vector, never through a shell.
 */
#ifndef PLAYER_SINKS_CHILD_PIPE_H
#define PLAYER_SINKS_CHILD_PIPE_H

#include <stddef.h>
#include <sys/types.h>

typedef struct child_pipe {
    pid_t pid; /* 0: not running */
    int fd;    /* write end; its standard input is the other */
} child_pipe;

/* @return 0 or an errno; ENOENT: there is no such program. SIGPIPE is ignored from here on. */
int child_pipe_start(child_pipe *c, char *const argv[]);
/* All of it, or an errno; EPIPE: the program gave up. */
int child_pipe_write(child_pipe *c, const void *data, size_t size);
/* Ends its input and waits. @return 0 when it said that all went well, else its exit status or -1. */
int child_pipe_finish(child_pipe *c);
/* Kills it. Harmless when it is not running. */
void child_pipe_abandon(child_pipe *c);

#endif
