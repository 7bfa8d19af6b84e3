/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * A capture format is one file with one const struct of this type; the array of them in take.c is all there
 * is to registering it.
 */
#ifndef LIB_TAKE_TAKE_DRIVER_H
#define LIB_TAKE_TAKE_DRIVER_H

#include <fap/studio/take.h>

/* The bytes of a file while it is read. */
typedef struct take_source {
    const uint8_t *data;
    size_t size;
    fap_allocator alloc;
    char where[FAP_ERROR_TEXT_SIZE];
} take_source;

typedef struct take_driver {
    const char *name;
    /* How surely these bytes are of this format: 0 no, 100 yes. */
    int (*claims)(const uint8_t *data, size_t size);
    /*
     * Reads into a new take, in the file's own unit, with mm_per_unit 0 where the file does not name it.
     * Bytes that are missing or wrong are an error only when nothing can be saved.
     */
    fap_err (*read)(take_source *src, fap_take **take);
} take_driver;

extern const take_driver take_driver_c3d, take_driver_trc, take_driver_nexus, take_driver_motive,
    take_driver_plain, take_driver_openface, take_driver_coefficients, take_driver_ema_pos,
    take_driver_ema_mat, take_driver_landmarks;

/* Says where and returns @p err. */
fap_err take_fail(take_source *src, fap_err err, const char *fmt, ...) __attribute__((format(printf, 3, 4)));
/* Adds a note; silently dropped when the list is full. */
void take_note(fap_take *take, const char *fmt, ...) __attribute__((format(printf, 2, 3)));
/* A name with blanks and NULs cut at both ends and unprintable bytes replaced; @p length bytes at @p text. */
void take_set_name(fap_take *take, uint32_t point, const char *text, size_t length);
/* Repeated names get _2, _3 ...; empty ones M001 ... */
void take_finish_names(fap_take *take);
/* Exact 0,0,0 means missing, except for one point that is 0 in every frame: the reference of a relative take.
 */
void take_drop_zeros(fap_take *take);
/* Times are rounded to milliseconds in many files, so a rate close to a usual one is that one. */
double take_usual_rate(double hz);

#endif
