/* SPDX-License-Identifier: BSD-2-Clause */
/* See claim.h. */
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "encoder/batch/claim.h"

enum { OWNER_SIZE = 320, HOST_SIZE = 256, PATH_SIZE = 4400 };

static void host_name(char host[HOST_SIZE])
{
    if (gethostname(host, HOST_SIZE))
        snprintf(host, HOST_SIZE, "unknown");
    host[HOST_SIZE - 1] = '\0';
}

static int write_owner(int fd)
{
    char host[HOST_SIZE], owner[OWNER_SIZE];

    host_name(host);
    const int length = snprintf(owner, sizeof owner, "%s %ld\n", host, (long)getpid());
    const int whole = write(fd, owner, (size_t)length) == length;
    return !close(fd) && whole;
}

/* Names the process only when it ran here. */
static long owner_here(const char *path)
{
    char host[HOST_SIZE], format[32], theirs[HOST_SIZE] = "";
    long pid = 0;
    FILE *const f = fopen(path, "r");

    if (!f)
        return 0;
    host_name(host);
    snprintf(format, sizeof format, "%%%ds %%ld", HOST_SIZE - 1);
    const int got = fscanf(f, format, theirs, &pid);
    fclose(f);
    return got == 2 && pid > 0 && !strcmp(theirs, host) ? pid : 0;
}

static int has_died(const char *path)
{
    const long pid = owner_here(path);
    return pid && kill((pid_t)pid, 0) && errno == ESRCH;
}

/* By the clock of the file system, which all machines share. */
static int is_stale(const char *path, const char *clock)
{
    struct stat theirs, now;

    claim_beat(clock);
    if (stat(path, &theirs) || stat(clock, &now))
        return 0;
    return now.st_mtime - theirs.st_mtime > CLAIM_STALE_S || has_died(path);
}

/* Only one can rename it. If it was renewed just before, its owner is alive: back with it. */
static void take_away(const char *path, const char *clock)
{
    char aside[PATH_SIZE];

    if (snprintf(aside, sizeof aside, "%s.%ld", path, (long)getpid()) >= PATH_SIZE || rename(path, aside))
        return;
    if (!is_stale(aside, clock) && link(aside, path))
        errno = 0; /* somebody has it already */
    unlink(aside);
}

static int make(const char *path)
{
    const int fd = open(path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);

    if (fd < 0)
        return errno == EEXIST ? 0 : -1;
    if (write_owner(fd))
        return 1;
    unlink(path);
    return -1;
}

int claim_get(const char *path, const char *clock)
{
    const int made = make(path);

    if (made || !is_stale(path, clock))
        return made;
    take_away(path, clock);
    return make(path);
}

void claim_beat(const char *path)
{
    if (utimensat(AT_FDCWD, path, NULL, 0))
        return; /* it is gone: another has taken it */
}

void claim_release(const char *path)
{
    unlink(path);
}
