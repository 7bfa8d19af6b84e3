/* SPDX-License-Identifier: BSD-2-Clause */
/* Masks as a table of vertices and sides. */
#include <stdio.h>
#include <string.h>

#include <fap/bank.h>
#include <fap/studio/masks.h>

static const char *const sides[FAP_MASK_BITS] = { "lip_upper",      "lip_lower",       "lid_upper_left",
                                                  "lid_lower_left", "lid_upper_right", "lid_lower_right" };
static const char heading[] = "vertex,side\n";

enum { LINE_MAX_BYTES = 64 };

const char *fap_mask_side_name(int i)
{
    return i >= 0 && i < FAP_MASK_BITS ? sides[i] : NULL;
}

fap_err fap_masks_write(const uint8_t *mask, uint32_t vertex_count, const fap_writer *out)
{
    if (out->write(out->user, heading, sizeof heading - 1))
        return FAP_E_IO;
    for (uint32_t v = 0; v < vertex_count; v++)
        for (int bit = 0; bit < FAP_MASK_BITS; bit++) {
            char line[LINE_MAX_BYTES];
            if (!(mask[v] >> bit & 1))
                continue;
            const int n = snprintf(line, sizeof line, "%u,%s\n", (unsigned)v, sides[bit]);
            if (out->write(out->user, line, (size_t)n))
                return FAP_E_IO;
        }
    return FAP_OK;
}

/* --- read --- */

typedef struct reading {
    uint8_t *mask;
    uint32_t vertex_count;
    unsigned line;
    char *where;
} reading;

static fap_err fail(const reading *r, fap_err err, const char *what)
{
    if (r->where)
        snprintf(r->where, FAP_ERROR_TEXT_SIZE, "line %u: %s", r->line, what);
    return err;
}

static int bit_of(const char *name, size_t length)
{
    for (int bit = 0; bit < FAP_MASK_BITS; bit++)
        if (strlen(sides[bit]) == length && !memcmp(sides[bit], name, length))
            return bit;
    return -1;
}

static size_t digits(const char *text, size_t length, uint32_t *value)
{
    size_t n = 0;

    *value = 0;
    for (; n < length && n < 9 && text[n] >= '0' && text[n] <= '9'; n++)
        *value = 10 * *value + (uint32_t)(text[n] - '0');
    return n;
}

/* Without its end of line. */
static fap_err take_line(const reading *r, const char *text, size_t length)
{
    uint32_t vertex;

    if (length && text[length - 1] == '\r')
        length--;
    if (!length || *text == '#' ||
        (r->line == 1 && length == sizeof heading - 2 && !memcmp(text, heading, length)))
        return FAP_OK;
    const size_t n = digits(text, length, &vertex);
    if (!n || n == length || text[n] != ',')
        return fail(r, FAP_E_SYNTAX, "expected VERTEX,SIDE");
    const int bit = bit_of(text + n + 1, length - n - 1);
    if (bit < 0)
        return fail(r, FAP_E_SYNTAX,
                    "no such side; lip_upper, lip_lower, lid_upper_left ... lid_lower_right");
    if (vertex >= r->vertex_count)
        return fail(r, FAP_E_DATA, "the face has no such vertex");
    r->mask[vertex] |= (uint8_t)(1 << bit);
    return FAP_OK;
}

fap_err fap_masks_read(uint8_t *mask, uint32_t vertex_count, const void *data, size_t size, char *where)
{
    const char *text = data, *end = text + size;
    reading r = { mask, vertex_count, 0, where };
    fap_err err = FAP_OK;

    if (where)
        *where = '\0';
    memset(mask, 0, vertex_count);
    while (text < end && err == FAP_OK) {
        const char *stop = memchr(text, '\n', (size_t)(end - text));
        const size_t length = (size_t)((stop ? stop : end) - text);
        r.line++;
        err = take_line(&r, text, length);
        text += length + (stop != NULL);
    }
    return err;
}
