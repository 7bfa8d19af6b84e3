/* SPDX-License-Identifier: BSD-2-Clause */
/* See fba_unsaid.h. */
#include "codec/fba_codes.h"
#include "codec/fba_header.h"
#include "codec/fba_unsaid.h"

enum { ENOUGH_PLANES = 64 };

/* How well a reading went. */
typedef struct outcome {
    int planes; /* parsed without a fault */
    int whole;  /* 2: they end where they should, or there were enough of them; 1: but for wrong stuffing */
    int cut;    /* the data ended in one of them */
} outcome;

static int read_face(fba_face_reader *r, fba_face *f, int intra)
{
    if (intra && fap_fba_face_set_up(r, f) != FAP_OK)
        return 0;
    return fap_fba_face_move(r, &f->list, &f->motion, intra) == FAP_OK;
}

/* Behind the data is a start code or the end of the unit: whether the planes lead there. */
static int is_at_end(const fap_bits *b)
{
    uint64_t at = b->at;

    if (fap_fba_is_used_up(b) || fap_fba_code_at(b, &at) >= 0)
        return 2;
    return fap_fba_is_badly_stuffed(b);
}

/* The header of the next plane. 0: there is none, or none that this can tell anything about. */
static int next_plane(fap_bits *b, fba_header *h, outcome *o)
{
    const char *what, *why;

    o->whole = o->planes == ENOUGH_PLANES ? 2 : is_at_end(b);
    return !o->whole && fap_fba_header_read(b, h, &what, &why) == FAP_OK && h->has_face && !h->has_body;
}

static outcome read_as(fap_bits b, fba_face f, int bound, model *models, model_pool *pool)
{
    fba_face_reader r = { .bits = &b, .model = models, .pool = pool, .default_bound = bound };
    fba_header h = { .intra = 1 };
    outcome o = { 0 };

    do {
        if (!read_face(&r, &f, h.intra))
            break;
        o.planes++;
    } while (next_plane(&b, &h, &o));
    o.cut = b.bad == BITS_PAST_END;
    return o;
}

/* Up to the next start code: hostile streams must not be read over and over. 0: there is none. */
static int until_next_code(fap_bits *bits)
{
    fap_bits b = *bits;

    fap_fba_seek_plane(&b, 1);
    if (b.at + 32 > b.end)
        return 0;
    bits->end = b.at + 32;
    return 1;
}

int fap_fba_unsaid_bound(const fap_bits *bits, const fba_face *face, model *models, model_pool *pool)
{
    fap_bits b = *bits;
    const int has_code = until_next_code(&b);
    const outcome said = read_as(b, *face, 0, models, pool);

    if (said.whole == 2)
        return 0;
    const outcome silent = read_as(b, *face, FBA_SILENT_BOUND, models, pool);
    if (said.cut && !has_code && silent.whole != 2)
        return 0; /* a stream that was cut proves nothing */
    return silent.whole > said.whole || silent.planes > said.planes ? FBA_SILENT_BOUND : 0;
}
