/* SPDX-License-Identifier: BSD-2-Clause */
/* See fba_header.h. Field names are the standard's. */
#include "codec/fba_header.h"

enum { SKIP_MAX = 1 << 20 /* frames; twelve hours at 25 a second */ };

static void read_frame_rate(fap_bits *b, fba_time_fields *t)
{
    const uint32_t frame_rate = fap_bits_get(b, 8), seconds = fap_bits_get(b, 4);

    t->rate_16 = 16 * frame_rate + seconds;
    t->offset = (int)fap_bits_get(b, 1);
}

static void read_time_code(fap_bits *b, fba_time_fields *t)
{
    const uint32_t hours = fap_bits_get(b, 5), minutes = fap_bits_get(b, 6);

    fap_bits_marker(b);
    t->time_code_s = 3600 * hours + 60 * minutes + fap_bits_get(b, 6);
}

static void read_skip(fap_bits *b, fba_time_fields *t)
{
    uint32_t n;

    do {
        n = fap_bits_get(b, 4);
        t->skipped += n;
    } while (n == 15 && t->skipped <= SKIP_MAX);
}

static void read_time(fap_bits *b, fba_time_fields *t)
{
    t->is_frame_rate = (int)fap_bits_get(b, 1);
    if (t->is_frame_rate)
        read_frame_rate(b, t);
    t->is_time_code = (int)fap_bits_get(b, 1);
    if (t->is_time_code)
        read_time_code(b, t);
}

static fap_err fail(fap_err err, const char *name, const char *reason, const char **what, const char **why)
{
    *what = name;
    *why = reason;
    return err;
}

fap_err fap_fba_header_read(fap_bits *b, fba_header *h, const char **what, const char **why)
{
    *h = (fba_header){ 0 };
    h->intra = (int)fap_bits_get(b, 1);
    const uint32_t fba_object_mask = fap_bits_get(b, 2);
    h->has_face = fba_object_mask & 1;
    h->has_body = fba_object_mask >> 1;
    if (b->bad == BITS_FINE && !fba_object_mask)
        return fail(FAP_E_BITSTREAM, "fba_object_mask", "neither face nor body", what, why);
    if (h->intra)
        read_time(b, &h->time);
    if (fap_bits_get(b, 1))
        read_skip(b, &h->time);
    if (b->bad != BITS_FINE)
        return fail(FAP_E_BITSTREAM, "plane header", fap_bits_why(b), what, why);
    if (h->time.skipped > SKIP_MAX)
        return fail(FAP_E_LIMIT, "number_of_frames_to_skip", "too many", what, why);
    return FAP_OK;
}
