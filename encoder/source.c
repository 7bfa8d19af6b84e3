/* SPDX-License-Identifier: BSD-2-Clause */
/* See source.h. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "encoder/source.h"

/* A few bytes of an .fba can skip hours: what is filled has to end somewhere. */
enum { FILL_MAX = 1 << 22, LOAD_MAX = 1 << 20 };

/* --- one by one --- */

typedef struct passing {
    const frame_source *src;
    fap_err (*put)(void *user, const fap_frame *frame);
    void *user;
    fap_frame last;
    int64_t filled;
    int begun;
} passing;

static void count_found_as_coded(fap_frame *f)
{
    for (int fap = 1; fap <= FAP_COUNT; fap++)
        if (f->state[fap] == FAP_DERIVED || f->state[fap] == FAP_CONCEALED)
            f->state[fap] = FAP_CODED;
}

/* Frames between the last and @p f; in front of the first one as many as its time says. */
static int64_t missing(const passing *p, const fap_frame *f)
{
    const int64_t since_us = f->pts_us - (p->begun ? p->last.pts_us : 0);
    const int64_t frames = llround((double)since_us * 1e-6 * p->src->rate_hz);

    return frames - (p->begun ? 1 : 0);
}

static fap_err fill(passing *p, const fap_frame *next)
{
    const int64_t count = missing(p, next);
    fap_frame copy = p->begun ? p->last : *next;
    const int64_t from_us = p->begun ? p->last.pts_us : 0;
    fap_err err = FAP_OK;

    if (count > 0 && (p->filled += count) > FILL_MAX)
        return FAP_E_LIMIT;
    for (int64_t i = 0; i < count && err == FAP_OK; i++) {
        copy.pts_us = from_us + llround((double)(i + p->begun) * 1e6 / p->src->rate_hz);
        err = p->put(p->user, &copy);
    }
    return err;
}

static fap_err pass(void *user, const fap_frame *frame)
{
    passing *p = user;
    fap_frame f = *frame;
    fap_err err = FAP_OK;

    count_found_as_coded(&f);
    if (p->src->fill)
        err = fill(p, &f);
    p->last = f;
    p->begun = 1;
    return err == FAP_OK ? p->put(p->user, &f) : err;
}

fap_err frame_source_each(const frame_source *src, fap_err (*put)(void *user, const fap_frame *frame),
                          void *user)
{
    passing p = { .src = src, .put = put, .user = user };
    const frame_sink sink = { .put = pass, .user = &p };
    char where[FAP_ERROR_TEXT_SIZE];
    stream_summary again;
    fap_err err = FAP_OK;

    if (!src->frames)
        return stream_read(src->data, src->size, src->options, &again, &sink, where);
    for (size_t i = 0; i < src->count && err == FAP_OK; i++)
        err = put(user, &src->frames[i]);
    return err;
}

static fap_err count_one(void *user, const fap_frame *frame)
{
    (void)frame;
    ++*(int64_t *)user;
    return FAP_OK;
}

fap_err frame_source_count(const frame_source *src, int64_t *count)
{
    *count = 0;
    return frame_source_each(src, count_one, count);
}

/* --- all at once --- */

typedef struct frame_list {
    fap_frame *frames;
    size_t count, room;
} frame_list;

static fap_err append(void *user, const fap_frame *frame)
{
    frame_list *l = user;

    if (l->count == LOAD_MAX)
        return FAP_E_LIMIT;
    if (l->count == l->room) {
        const size_t room = l->room ? 2 * l->room : 256;
        fap_frame *grown = realloc(l->frames, room * sizeof *grown);
        if (!grown)
            return FAP_E_NOMEM;
        l->frames = grown;
        l->room = room;
    }
    l->frames[l->count++] = *frame;
    return FAP_OK;
}

fap_err frame_source_load(const frame_source *src, fap_frame **frames, size_t *count)
{
    frame_list l = { NULL, 0, 0 };
    const fap_err err = frame_source_each(src, append, &l);

    *frames = l.frames;
    *count = l.count;
    if (err == FAP_OK)
        return FAP_OK;
    free(l.frames);
    *frames = NULL;
    return err;
}
