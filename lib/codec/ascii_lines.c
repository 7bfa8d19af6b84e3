/* SPDX-License-Identifier: BSD-2-Clause */
/* See ascii_lines.h. */
#include <string.h>

#include "codec/ascii_lines.h"

void fap_ascii_lines_init(ascii_lines *l, const fap_reader *in)
{
    l->in = *in;
    l->start = l->end = l->buffer;
    l->feed = NULL;
    l->number = 0;
    l->finished = l->lone_cr = l->unended = l->byte_order_mark = 0;
}

/* Move the rest to the front and read once: a live source should not wait for a full buffer. */
static fap_err refill(ascii_lines *l)
{
    const size_t rest = (size_t)(l->end - l->start), room = ASCII_BUFFER - rest;

    memmove(l->buffer, l->start, rest);
    const size_t got = l->in.read(l->in.user, l->buffer + rest, room);
    if (got > room)
        return FAP_E_IO;
    l->finished = !got;
    l->start = l->buffer;
    l->end = l->buffer + rest + got;
    l->feed = NULL;
    return FAP_OK;
}

static void skip_byte_order_mark(ascii_lines *l)
{
    if (l->end - l->start >= 3 && !memcmp(l->start, "\xEF\xBB\xBF", 3)) {
        l->start += 3;
        l->byte_order_mark = 1;
    }
}

/* Where the line that begins at start ends; end where no line end is in the buffer. */
static char *find_end(ascii_lines *l)
{
    if (!l->feed || l->feed < l->start) {
        char *feed = memchr(l->start, '\n', (size_t)(l->end - l->start));
        l->feed = feed ? feed : l->end;
    }
    char *cr = memchr(l->start, '\r', (size_t)(l->feed - l->start));
    return cr ? cr : l->feed;
}

/* A CR that ends the buffer may have its LF still to come: wait and see. */
static int undecided(const ascii_lines *l, const char *stop)
{
    return !l->finished && (stop == l->end || (*stop == '\r' && stop + 1 == l->end));
}

fap_err fap_ascii_lines_next(ascii_lines *l, char **line, size_t *length)
{
    char *stop = find_end(l);

    while (undecided(l, stop) && stop - l->start <= ASCII_LINE_MAX) {
        const fap_err err = refill(l);
        if (err != FAP_OK)
            return err;
        stop = find_end(l);
    }
    if (!l->number)
        skip_byte_order_mark(l);
    if (l->start == l->end)
        return FAP_E_END;

    *line = l->start;
    *length = (size_t)(stop - l->start);
    l->number++;
    if (*length > ASCII_LINE_MAX) {
        *length = ASCII_LINE_MAX;
        return FAP_E_LIMIT;
    }
    l->unended = stop == l->end;
    l->start = stop < l->end ? stop + 1 : stop;
    if (stop < l->end && *stop == '\r') {
        if (l->start < l->end && *l->start == '\n')
            l->start++;
        else
            l->lone_cr = 1;
    }
    *stop = '\n';
    return FAP_OK;
}
