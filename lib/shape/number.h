/* SPDX-License-Identifier: BSD-2-Clause */
/* Decimal numbers in mesh files, whatever the locale says. */
#ifndef LIB_SHAPE_NUMBER_H
#define LIB_SHAPE_NUMBER_H

/* @p count blank-separated numbers from the start of @p text. @return 0 where there are fewer or one is none.
 */
int fap_read_floats(const char *text, float *out, int count);

#endif
