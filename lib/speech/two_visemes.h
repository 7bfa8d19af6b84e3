/* SPDX-License-Identifier: BSD-2-Clause */
/* FAP 1 has room for two visemes: what becomes of more. */
#ifndef LIB_SPEECH_TWO_VISEMES_H
#define LIB_SPEECH_TWO_VISEMES_H

#include <fap/frame.h>
#include <fap/tables.h>

/* The strongest three of @p strength[count], strongest first; -1 where there are fewer. */
void strongest_three(const double *strength, int count, int best[3]);
/* What is left of one of the two strongest beside a third: 0 where that is as strong, so that nothing jumps when they change. */
double lead_over(double strength, double third);
/* @p strength: of none and 14 visemes, any scale. */
void two_visemes(const double strength[FAP_VISEME_COUNT + 1], fap_viseme *out);

#endif
