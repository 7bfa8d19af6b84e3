/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * What a tool still has to do when a signal ends it: remove a temporary, put a line of a chip low. The signal ends the
 * program afterwards as it would have, so that whoever waits for it sees which one it was.
 */
#ifndef COMMON_SIGNALS_H
#define COMMON_SIGNALS_H

#include <signal.h>

/*
 * @last_words is called from the handler of INT, TERM, HUP, QUIT and PIPE: nothing but what is async-signal-safe. Asking
 * twice is as asking once; who asked last speaks first: a program that writes a file ends before the file is removed. Signals that somebody ignores or handles already stay as they are.
 */
void signals_call(void (*last_words)(void));

/* None of these signals between the two: what exists and what the handler knows of change together. */
void signals_hold(sigset_t *before);
void signals_release(const sigset_t *before);

#endif
