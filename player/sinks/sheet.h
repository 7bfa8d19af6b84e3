/* SPDX-License-Identifier: BSD-2-Clause */
/* What the tests of the contact sheet look at. */
#ifndef PLAYER_SINKS_SHEET_H
#define PLAYER_SINKS_SHEET_H

#include <stddef.h>

/* The label of a moment: "1.24 s", "2:07.50", "1:02:03.00". */
void sheet_label(char *out, size_t room, double time_s);

#endif
