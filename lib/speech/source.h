/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * A format of phoneme times is one file with one const struct of this type; the array of them in speech.c is all there is
 * to registering it.
 */
#ifndef LIB_SPEECH_SOURCE_H
#define LIB_SPEECH_SOURCE_H

#include <fap/studio/speech.h>

#include "take/text.h"

/* The bytes of a file while it is read. */
typedef struct speech_source {
    const uint8_t *data;
    size_t size;
    const fap_speech_read_config *cfg;
    fap_allocator alloc;
    char where[FAP_ERROR_TEXT_SIZE];
} speech_source;

typedef struct speech_driver {
    const char *name;
    /* 1: these bytes are of this format. */
    int (*claims)(const uint8_t *data, size_t size);
    /* Appends to an empty speech. What is missing or wrong is an error only when nothing can be saved. */
    fap_err (*read)(speech_source *src, fap_speech *speech);
} speech_driver;

extern const speech_driver speech_driver_textgrid, speech_driver_rhubarb, speech_driver_tsv;

/* Says where and returns @p err. */
fap_err speech_fail(speech_source *src, fap_err err, const char *fmt, ...)
    __attribute__((format(printf, 3, 4)));
/* Adds a note; silently dropped when the list is full. */
void speech_note(fap_speech *speech, const char *fmt, ...) __attribute__((format(printf, 2, 3)));
/* A name is cut at both ends, and between letters where it is too long. FAP_E_LIMIT, FAP_E_NOMEM. */
fap_err speech_add(fap_speech *speech, double start_s, double end_s, text name);

#endif
