/* SPDX-License-Identifier: BSD-2-Clause */
/* See child_pipe.h. */
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <stdatomic.h>
#include <stdint.h>
#include <sys/wait.h>
#include <unistd.h>

#include "common/signals.h"
#include "common/child_pipe.h"

extern char **environ;

/* For the handler of signals; 0: none runs. A tool has one at a time. */
static _Atomic(pid_t) running;

/* It would go on writing to a file that is about to be removed, or make it again. */
static void end_child(void)
{
    const pid_t pid = atomic_load(&running);
    int status;

    if (pid > 0 && !kill(pid, SIGKILL))
        waitpid(pid, &status, 0);
}

/* The child must not inherit our end: its input would never end. */
static int open_pipe(int fd[2])
{
    if (pipe(fd))
        return errno;
    fcntl(fd[0], F_SETFD, FD_CLOEXEC);
    fcntl(fd[1], F_SETFD, FD_CLOEXEC);
    return 0;
}

/* SIGPIPE is ours to ignore, not the child's. Its words go where ours go, its output, unless it is the pipe, nowhere: stdout
 * may be a report. */
static int spawn(pid_t *pid, char *const argv[], child_side side, int its_end, const sigset_t *mask)
{
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    sigset_t defaults;

    sigemptyset(&defaults);
    sigaddset(&defaults, SIGPIPE);
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setsigdefault(&attributes, &defaults);
    posix_spawnattr_setsigmask(&attributes, mask);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, its_end, side == CHILD_READS ? STDIN_FILENO : STDOUT_FILENO);
    if (side == CHILD_READS)
        posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    else
        posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    const int err = posix_spawnp(pid, argv[0], &actions, &attributes, argv, environ);
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
    return err;
}

int child_pipe_start(child_pipe *c, char *const argv[], child_side side)
{
    const int its = side == CHILD_READS ? 0 : 1;
    sigset_t before;
    int fd[2];

    *c = (child_pipe){ 0, -1 };
    signal(SIGPIPE, SIG_IGN); /* a program that gives up is an EPIPE here, not our end */
    int err = open_pipe(fd);
    if (err)
        return err;
    signals_call(end_child);
    signals_hold(&before);
    err = spawn(&c->pid, argv, side, fd[its], &before);
    atomic_store(&running, err ? 0 : c->pid);
    signals_release(&before);
    close(fd[its]);
    if (err) {
        close(fd[!its]);
        c->pid = 0;
        return err;
    }
    c->fd = fd[!its];
    return 0;
}

int child_pipe_write(child_pipe *c, const void *data, size_t size)
{
    const uint8_t *rest = data;

    while (size) {
        const ssize_t n = write(c->fd, rest, size);
        if (n < 0 && errno == EINTR)
            continue;
        if (n < 0)
            return errno;
        rest += n;
        size -= (size_t)n;
    }
    return 0;
}

long child_pipe_read(child_pipe *c, void *data, size_t size)
{
    uint8_t *const to = data;
    size_t got = 0;

    while (got < size) {
        const ssize_t n = read(c->fd, to + got, size - got);
        if (n < 0 && errno == EINTR)
            continue;
        if (n < 0)
            return -1;
        if (!n)
            break;
        got += (size_t)n;
    }
    return (long)got;
}

static int wait_for(child_pipe *c)
{
    int status;

    close(c->fd);
    while (waitpid(c->pid, &status, 0) < 0)
        if (errno != EINTR)
            return -1;
    atomic_store(&running, 0);
    c->pid = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

int child_pipe_finish(child_pipe *c)
{
    return wait_for(c);
}

void child_pipe_abandon(child_pipe *c)
{
    if (!c->pid)
        return;
    kill(c->pid, SIGKILL);
    wait_for(c);
}
