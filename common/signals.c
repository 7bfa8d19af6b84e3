/* SPDX-License-Identifier: BSD-2-Clause */
/* See signals.h. */
#include <stdatomic.h>
#include <stddef.h>

#include "common/signals.h"

typedef void (*words)(void);

/* One thread asks; the handler reads. */
static _Atomic(words) asked[4];

enum { ASKED_COUNT = sizeof asked / sizeof *asked };

static const int deadly[] = { SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE };

enum { DEADLY_COUNT = sizeof deadly / sizeof *deadly };

/* SA_RESETHAND has put the default action back: raised again, the signal ends the program as it should. */
static void speak(int sig)
{
    for (int i = ASKED_COUNT - 1; i >= 0; i--) {
        const words last = atomic_load(&asked[i]);
        if (last)
            last();
    }
    raise(sig);
}

static void catch_all(void)
{
    const struct sigaction ours = { .sa_handler = speak, .sa_flags = (int)SA_RESETHAND };
    struct sigaction old;

    for (int i = 0; i < DEADLY_COUNT; i++)
        if (!sigaction(deadly[i], NULL, &old) && old.sa_handler == SIG_DFL)
            sigaction(deadly[i], &ours, NULL);
}

void signals_call(words last_words)
{
    for (int i = 0; i < ASKED_COUNT; i++) {
        words there = NULL;
        if (atomic_compare_exchange_strong(&asked[i], &there, last_words) || there == last_words)
            break;
    }
    catch_all();
}

void signals_hold(sigset_t *before)
{
    sigset_t wait;

    sigemptyset(&wait);
    for (int i = 0; i < DEADLY_COUNT; i++)
        sigaddset(&wait, deadly[i]);
    sigprocmask(SIG_BLOCK, &wait, before);
}

void signals_release(const sigset_t *before)
{
    sigprocmask(SIG_SETMASK, before, NULL);
}
