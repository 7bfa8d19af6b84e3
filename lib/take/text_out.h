/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Tables written piece by piece, without the locale, which may have another decimal mark. After the first failure nothing more is
 * written, so only the end needs to be asked.
 */
#ifndef LIB_TAKE_TEXT_OUT_H
#define LIB_TAKE_TEXT_OUT_H

#include <fap/io.h>

typedef struct text_out {
    const fap_writer *to;
    int failed;
} text_out;

void text_put(text_out *o, const char *text);
/* A name within a row: control characters, and @separator, become '_'. */
void text_put_name(text_out *o, const char *name, char separator);
/* With up to 9 @decimals; never "-0". */
void text_put_number(text_out *o, double value, int decimals);

#endif
