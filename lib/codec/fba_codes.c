/* SPDX-License-Identifier: BSD-2-Clause */
/* See fba_codes.h. */
#include "codec/fba_codes.h"

static int is_start_code(const fap_bits *b, uint64_t at)
{
    return at % 8 == 0 && at + 32 <= b->end && fap_bits_peek(b, at, 24) == FBA_START_PREFIX;
}

/* Bits of stuffing at @p at: a 0, then 1s to the byte boundary. 0: something else is there. */
static int stuffing(const fap_bits *b, uint64_t at)
{
    const int n = 8 - (int)(at % 8);
    return at + (uint64_t)n <= b->end && fap_bits_peek(b, at, n) == (1u << (n - 1)) - 1 ? n : 0;
}

int fap_fba_code_at(const fap_bits *b, uint64_t *at)
{
    const int n = stuffing(b, *at);

    if (n && is_start_code(b, *at + (uint64_t)n))
        *at += (uint64_t)n;
    if (!is_start_code(b, *at))
        return -1;
    return (int)fap_bits_peek(b, *at + 24, 8);
}

void fap_fba_seek_code(fap_bits *b)
{
    b->at = (b->at + 7) / 8 * 8;
    while (b->at < b->end && !is_start_code(b, b->at))
        b->at += 8;
}

static int begins_something(const fap_bits *b, int drafts)
{
    switch (is_start_code(b, b->at) ? fap_bits_peek(b, b->at + 24, 8) : 0) {
    case FBA_CODE_OBJECT:
    case FBA_CODE_PLANE:
    case FBA_CODE_END: return 1;
    case FBA_CODE_DRAFT_OBJECT:
    case FBA_CODE_DRAFT_PLANE: return drafts;
    default: return 0;
    }
}

/* A P plane of six bits, as a value that is well predicted takes no more, and one bit of stuffing. */
static int is_short_plane(const fap_bits *b)
{
    const uint32_t bits = fap_bits_peek(b, b->at, 7), fba_object_mask = bits >> 4 & 3, run = bits >> 1 & 3;

    return b->at % 8 == 1 && !(bits & 0x49) && (fba_object_mask == 1 || fba_object_mask == 2) &&
           (run == 1 || run == 2);
}

int fap_fba_is_badly_stuffed(const fap_bits *b)
{
    fap_bits aligned = *b;

    aligned.at = (b->at + 7) / 8 * 8;
    return b->at % 8 && begins_something(&aligned, 0) && !is_short_plane(b);
}

void fap_fba_seek_plane(fap_bits *b, int drafts)
{
    b->at = (b->at + 7) / 8 * 8;
    while (b->at < b->end && !begins_something(b, drafts))
        b->at += 8;
}

/*
 * Stuffing may be followed by the beginning of a start code that was cut: 00, 00 00 or 00 00 01. No plane looks like
 * that, as every run has a 1 in it, but for a body's behind "01".
 */
int fap_fba_is_used_up(const fap_bits *b)
{
    const int n = stuffing(b, b->at), is_body = n == 2;

    if (!n)
        return b->at == b->end;
    const uint64_t rest = b->end - b->at - (uint64_t)n;
    if (rest > (is_body ? 16 : 24))
        return 0;
    return fap_bits_peek(b, b->at + (uint64_t)n, (int)rest) == (uint32_t)FBA_START_PREFIX >> (24 - rest);
}

/* A plane cannot begin with three 0s: fba_object_mask would be 0. */
int fap_fba_is_padding(const fap_bits *b)
{
    return b->end - b->at < 8 && !fap_bits_peek(b, b->at, (int)(b->end - b->at));
}
