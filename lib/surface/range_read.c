/* SPDX-License-Identifier: BSD-2-Clause */
/* The files of a range image: the camera's JSON, and depth as a Portable Float Map. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <fap/studio/range.h>

#include "base/mem.h"
#include "shape/number.h"
#include "take/json_text.h"

/* --- the camera --- */

static int is_word(const text *t, const char *word)
{
    return t->length == strlen(word) && !memcmp(t->start, word, t->length);
}

static fap_err fail(char *where, fap_err err, const char *what)
{
    if (where)
        snprintf(where, FAP_ERROR_TEXT_SIZE, "%s", what);
    return err;
}

/* A file beside the camera's, and nowhere else. */
static int take_name(json_text *j, char out[FAP_RANGE_NAME])
{
    text t;

    if (!json_text_string(j, &t) || !t.length || t.length >= FAP_RANGE_NAME || *t.start == '.')
        return 0;
    for (size_t i = 0; i < t.length; i++)
        if (t.start[i] == '/' || t.start[i] == '\\' || (unsigned char)t.start[i] < ' ')
            return 0;
    memcpy(out, t.start, t.length);
    out[t.length] = '\0';
    return 1;
}

/* @return 0 a name that is none. */
static int take_item(json_text *j, const text *key, fap_range_camera *c)
{
    const struct number {
        const char *key;
        double *to;
    } numbers[] = {
        { "fx", &c->fx }, { "fy", &c->fy }, { "cx", &c->cx }, { "cy", &c->cy }, { "unit_mm", &c->unit_mm }
    };

    if (is_word(key, "depth"))
        return take_name(j, c->depth);
    if (is_word(key, "colour") || is_word(key, "color"))
        return take_name(j, c->colour);
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        if (is_word(key, numbers[i].key))
            return json_text_number(j, numbers[i].to) || 1;
    json_text_skip(j);
    return 1;
}

static fap_err check(const fap_range_camera *c, char *where)
{
    if (!*c->depth)
        return fail(where, FAP_E_UNKNOWN_FORMAT, "no \"depth\" in it, the name of a depth picture");
    if (!(c->fx > 0 && c->fy > 0) || !isfinite(c->fx) || !isfinite(c->fy))
        return fail(where, FAP_E_DATA, "\"fx\" and \"fy\", the focal lengths in pixels, have to be positive");
    if (!isfinite(c->cx) || !isfinite(c->cy))
        return fail(where, FAP_E_DATA,
                    "\"cx\" and \"cy\", the principal point in pixels, have to be numbers");
    if (!(c->unit_mm > 0) || !isfinite(c->unit_mm))
        return fail(where, FAP_E_DATA,
                    "\"unit_mm\", the millimetres of one step of depth, has to be positive");
    return FAP_OK;
}

fap_err fap_range_camera_read(fap_range_camera *out, const void *data, size_t size, char *where)
{
    json_text j = json_text_open(data, size);
    int first = 1, named = 1;
    text key;

    memset(out, 0, sizeof *out);
    out->cx = out->cy = NAN;
    if (!json_text_enter(&j, '{'))
        return fail(where, FAP_E_UNKNOWN_FORMAT, "no JSON object");
    while (named && json_text_next(&j, '}', &first))
        named = json_text_key(&j, &key) && take_item(&j, &key, out);
    if (j.bad)
        return fail(where, FAP_E_SYNTAX, "JSON ends or breaks off in the middle");
    if (!named)
        return fail(where, FAP_E_DATA, "a picture's name has to be that of a file in the same folder");
    return check(out, where);
}

/* --- Portable Float Map --- */

typedef struct header {
    unsigned columns, rows;
    int little;
    size_t body; /* where the numbers begin */
} header;

/* "Pf\n640 480\n-1.0\n": any blanks between, one byte before the numbers. */
static int parse_header(const char *data, size_t size, header *h)
{
    char line[96], scale[32];
    int used = 0;

    const size_t n = size < sizeof line - 1 ? size : sizeof line - 1;
    memcpy(line, data, n);
    line[n] = '\0';
    if (sscanf(line, "Pf %8u %8u %31s%n", &h->columns, &h->rows, scale, &used) != 3 || !used)
        return 0;
    float factor;
    h->little = *scale == '-';
    h->body = (size_t)used + 1;
    return fap_read_floats(scale, &factor, 1) && factor != 0;
}

static float number_at(const uint8_t *p, int little)
{
    const uint32_t bits =
        little ? (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24
               : (uint32_t)p[3] | (uint32_t)p[2] << 8 | (uint32_t)p[1] << 16 | (uint32_t)p[0] << 24;
    float v;

    memcpy(&v, &bits, sizeof v);
    return v;
}

fap_err fap_range_read_pfm(float **depth, uint32_t *columns, uint32_t *rows, const void *data, size_t size,
                           const fap_allocator *alloc)
{
    const fap_allocator a = fap_mem_allocator(alloc);
    header h;

    *depth = NULL;
    if (size < 3 || memcmp(data, "Pf", 2))
        return FAP_E_UNKNOWN_FORMAT;
    if (!parse_header(data, size, &h) || !h.columns || !h.rows)
        return FAP_E_DATA;
    if (h.columns > FAP_RANGE_MAX_SIDE || h.rows > FAP_RANGE_MAX_SIDE)
        return FAP_E_LIMIT;
    const size_t count = (size_t)h.columns * h.rows;
    if (size < h.body || (size - h.body) / 4 < count)
        return FAP_E_DATA;
    *depth = fap_mem_calloc(&a, count, sizeof **depth);
    if (!*depth)
        return FAP_E_NOMEM;
    for (uint32_t row = 0; row < h.rows; row++)
        for (uint32_t column = 0; column < h.columns; column++)
            (*depth)[(size_t)row * h.columns + column] = number_at(
                (const uint8_t *)data + h.body + 4 * ((size_t)(h.rows - 1 - row) * h.columns + column),
                h.little);
    *columns = h.columns;
    *rows = h.rows;
    return FAP_OK;
}
