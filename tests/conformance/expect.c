/* SPDX-License-Identifier: BSD-2-Clause */
/* See expect.h. */
#include "tests/conformance/expect.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_LINE = 4096 };

static const char state_sign[] = { ' ', '=', '~', '?', '!' }; /* absent, coded, held, derived, concealed */

static void add_line(transcript *t, const char *line)
{
    if (t->count == t->room) {
        t->room = 2 * t->room + 64;
        t->line = realloc(t->line, t->room * sizeof *t->line);
    }
    char *copy = t->line ? malloc(strlen(line) + 1) : NULL;
    if (!copy)
        abort();
    t->line[t->count++] = strcpy(copy, line);
}

void transcript_free(transcript *t)
{
    for (size_t i = 0; i < t->count; i++)
        free(t->line[i]);
    free(t->line);
    memset(t, 0, sizeof *t);
}

void transcript_print(const transcript *t, FILE *to)
{
    for (size_t i = 0; i < t->count; i++)
        fprintf(to, "%s\n", t->line[i]);
}

/* --- frames in words --- */

__attribute__((format(printf, 2, 3))) static void append(char *line, const char *format, ...)
{
    const size_t at = strlen(line);
    va_list args;

    va_start(args, format);
    vsnprintf(line + at, MAX_LINE - at, format, args);
    va_end(args);
}

static void append_high_level(char *line, const fap_frame *f)
{
    const fap_viseme *v = &f->viseme;
    const fap_expression *e = &f->expression;

    if (f->state[1])
        append(line, " V%c%d,%d,%d,%d", state_sign[f->state[1]], v->select1, v->select2, v->blend, v->def);
    if (f->state[2])
        append(line, " E%c%d,%d,%d,%d,%d,%d", state_sign[f->state[2]], e->select1, e->intensity1, e->select2,
               e->intensity2, e->init_face, e->def);
}

/* FAP=value; neighbours that are alike in one word: 19-30=0 */
static void append_faps(char *line, const fap_frame *f)
{
    for (int fap = 3, last; fap <= FAP_COUNT; fap = last + 1) {
        last = fap;
        if (!f->state[fap])
            continue;
        while (last < FAP_COUNT && f->state[last + 1] == f->state[fap] && f->value[last + 1] == f->value[fap])
            last++;
        if (last > fap)
            append(line, " %d-%d%c%d", fap, last, state_sign[f->state[fap]], (int)f->value[fap]);
        else
            append(line, " %d%c%d", fap, state_sign[f->state[fap]], (int)f->value[fap]);
    }
}

static void add_frame(transcript *t, const fap_frame *f)
{
    char line[MAX_LINE];

    snprintf(line, sizeof line, "frame %lld %lld", (long long)f->number, (long long)f->pts_us);
    append_high_level(line, f);
    append_faps(line, f);
    add_line(t, line);
}

/* What the plane was made of. Ranges are named where they are not those of a plane before. */
static void add_plane(transcript *t, const fap_plane_info *i, const fap_plane_info *before)
{
    char line[MAX_LINE];

    snprintf(line, sizeof line, "plane %lld+%u %s%s%s%s quant=%d gender=%d skipped=%u rate=%.4f mask=",
             (long long)i->bit_position, (unsigned)i->bit_count, i->intra ? "I" : "P",
             i->start_code ? " code" : "", i->has_face ? " face" : "", i->has_body ? " body" : "", i->quant,
             i->gender, (unsigned)i->skipped, i->rate_hz);
    for (int group = 1; group <= FAP_GROUPS; group++)
        append(line, "%d", i->mask_type[group]);
    for (int fap = 3; fap <= FAP_COUNT; fap++)
        if (i->i_min[fap] != before->i_min[fap] || i->i_max[fap] != before->i_max[fap] ||
            i->p_min[fap] != before->p_min[fap] || i->p_max[fap] != before->p_max[fap])
            append(line, " %d:%d..%d,%d..%d", fap, i->i_min[fap], i->i_max[fap], i->p_min[fap],
                   i->p_max[fap]);
    add_line(t, line);
}

static void add_notice(void *user, int64_t bit, const char *text)
{
    char line[MAX_LINE];

    snprintf(line, sizeof line, "notice bit %lld: %s", (long long)bit, text);
    add_line(user, line);
}

static const char *error_name(fap_err err)
{
    switch (err) {
#define X(name, value, text)                                                                                 \
    case name: return #name;
        FAP_ERRORS(X)
#undef X
    }
    return "?";
}

/* --- playing --- */

static long option(const char *expect, const char *name)
{
    char line[64];

    snprintf(line, sizeof line, "\noption %s ", name);
    const char *at = strstr(expect, line);
    return at ? strtol(at + strlen(line), NULL, 10) : 0;
}

static fap_decoder *open_decoder(transcript *t, const char *expect)
{
    fap_decoder_config cfg;
    fap_decoder *d;

    fap_decoder_config_init(&cfg);
    cfg.strict = (int)option(expect, "strict");
    cfg.default_bound = (int)option(expect, "default_bound");
    cfg.symbol_memory = (int)option(expect, "symbol_memory");
    cfg.notice = add_notice;
    cfg.notice_user = t;
    return fap_decoder_open(&d, &cfg) == FAP_OK ? d : NULL;
}

/* Everything the unit gives. NULL, or what cannot be. */
static const char *drain(transcript *t, fap_decoder *d, size_t size, int planes, fap_plane_info *before)
{
    fap_frame f;
    char line[MAX_LINE];

    for (size_t i = 0; i < 8 * size + 16; i++) {
        memset(&f, 0x5A, sizeof f);
        const fap_err err = fap_decoder_receive(d, &f);
        if (err == FAP_OK) {
            add_frame(t, &f);
            if (planes)
                add_plane(t, fap_decoder_plane(d), before);
            *before = *fap_decoder_plane(d);
            continue;
        }
        snprintf(line, sizeof line, "%s%s%s", error_name(err), err <= FAP_E_BITSTREAM ? " " : "",
                 err <= FAP_E_BITSTREAM ? fap_decoder_last_error(d) : "");
        add_line(t, line);
        if (err == FAP_E_AGAIN || err == FAP_E_END)
            return NULL;
    }
    return "the decoder does not come to an end";
}

static const char *play_units(transcript *t, fap_decoder *d, const assembly *a, const char *expect)
{
    const int planes = (int)option(expect, "planes"), flush_after = (int)option(expect, "flush_after");
    fap_plane_info before = *fap_decoder_plane(d);
    size_t from = 0;

    for (int i = 0; i < a->units; i++) {
        const size_t size = a->unit_end[i] - from;
        uint8_t *exact = malloc(size + 1); /* as large as the unit, so that a sanitizer sees a step too far */
        if (!exact)
            abort();
        uint8_t *data = size ? memcpy(exact + 1, a->bits.data + from, size) : NULL;
        const char *why = fap_decoder_send(d, data, size) == FAP_OK ? NULL : "a unit is not taken";
        if (!why)
            why = drain(t, d, size, planes, &before);
        free(exact);
        if (why)
            return why;
        if (i + 1 == flush_after)
            fap_decoder_flush(d);
        from = a->unit_end[i];
    }
    return NULL;
}

int transcript_make(transcript *t, const assembly *a, const char *expect, const char **why)
{
    memset(t, 0, sizeof *t);
    fap_decoder *d = open_decoder(t, expect);
    *why = d ? play_units(t, d, a, expect) : "the decoder does not open";
    fap_decoder_close(&d);
    return !*why;
}

/* --- comparing --- */

/* The next line that expects something; 0: none. */
static int next_expected(const char **at, char *line)
{
    while (**at) {
        const size_t n = strcspn(*at, "\n");
        snprintf(line, MAX_LINE, "%.*s", (int)n, *at);
        *at += n + ((*at)[n] == '\n');
        line[strcspn(line, "#\r")] = 0;
        for (size_t k = strlen(line); k && line[k - 1] == ' ';)
            line[--k] = 0;
        if (*line && strncmp(line, "option ", 7))
            return 1;
    }
    return 0;
}

int transcript_matches(const transcript *t, const char *expect, char *message, size_t size)
{
    char line[MAX_LINE];
    size_t at = 0, frames;

    while (next_expected(&expect, line)) {
        if (sscanf(line, "frames %zu", &frames) == 1) { /* so many, whatever they hold */
            while (frames && at < t->count && !strncmp(t->line[at], "frame ", 6))
                frames--, at++;
            if (frames) {
                snprintf(message, size, "%zu frames are missing", frames);
                return 0;
            }
            continue;
        }
        if (at == t->count || strcmp(t->line[at], line)) {
            snprintf(message, size, "got      %s\n  expected %s", at < t->count ? t->line[at] : "nothing",
                     line);
            return 0;
        }
        at++;
    }
    if (at < t->count)
        snprintf(message, size, "got      %s\n  expected nothing more", t->line[at]);
    return at == t->count;
}
