/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The conformance runner: conformance [--show] [--quick] FILE.syntax...
 * Every stream is played and compared with FILE.expect; then every byte at which it can be cut, and every bit in it that must
 * be 1 turned over. Needs libfap alone, so that it runs wherever libfap does. --show prints what the decoder says, --quick cuts nothing.
 * The last line but one is a checksum of all of that: the same on every machine.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tests/conformance/expect.h"

enum { CUT_WORK = 400000, MAX_TURNS = 200, MAX_MESSAGE = 9000 };

typedef struct suite {
    int passed, failed, show, quick;
    uint32_t checksum;
} suite;

static void report(suite *s, const char *name, const char *kind, const char *message)
{
    if (!message) {
        s->passed++;
        return;
    }
    s->failed++;
    printf("FAIL: %s%s: %s\n", name, kind, message);
}

static char *read_text(const char *path)
{
    FILE *f = fopen(path, "rb");
    const size_t room = 1 << 20;
    char *text = f ? malloc(room + 2) : NULL;

    if (text) {
        text[0] = '\n'; /* so that every line has one in front */
        text[1 + fread(text + 1, 1, room, f)] = 0;
    }
    if (f)
        fclose(f);
    return text;
}

static void sum(suite *s, const transcript *t)
{
    for (size_t i = 0; i < t->count; i++)
        for (const char *c = t->line[i]; *c; c++)
            s->checksum = (s->checksum ^ (unsigned char)*c) * 16777619u;
}

/* --- a stream cut at every byte --- */

static int is_frame(const char *line)
{
    return !strncmp(line, "frame ", 6);
}

/* Frames of a cut stream are those of the whole, in their order, up to where it breaks. NULL, or one that is not. */
static const char *other_frame(const transcript *cut, const transcript *whole)
{
    size_t w = 0;

    for (size_t c = 0; c < cut->count; c++) {
        if (!is_frame(cut->line[c]))
            continue;
        while (w < whole->count && !is_frame(whole->line[w]))
            w++;
        if (w == whole->count || strcmp(whole->line[w++], cut->line[c]))
            return cut->line[c];
    }
    return NULL;
}

/*
 * 0s at the end may be cut stuffing or the first bits of a plane; stuffing and half a code, once in a while, a body's. A first plane
 * without range tables that is cut may make more sense with other ranges.
 */
static int explains(const char *line)
{
    return strstr(line, ": the data is cut") || strstr(line, "in bits that are no stuffing") ||
           strstr(line, "without the I plane") || strstr(line, "no symbol ranges are sent");
}

/* An error that a cut does not explain; NULL: none. */
static const char *other_error(const transcript *t)
{
    for (size_t i = 0; i < t->count; i++)
        if (!strncmp(t->line[i], "FAP_E_", 6) && strchr(t->line[i], ':') && !explains(t->line[i]))
            return t->line[i];
    return NULL;
}

/* A start code that is cut itself looks like a plane, and a bad one. */
static int is_in_code(const bit_list *b, size_t cut)
{
    static const uint8_t prefix[] = { 0, 0, 1 };

    for (size_t n = 1; n <= 3 && n <= cut; n++)
        if (cut - n + 3 <= b->bits / 8 && !memcmp(b->data + cut - n, prefix, sizeof prefix))
            return 1;
    return 0;
}

/* The first @p size bytes, in the units that they make. */
static void cut_units(assembly *a, size_t size)
{
    int n = 0;

    while (n < a->units && a->unit_end[n] < size)
        n++;
    a->units = n + 1;
    a->unit_end[n] = size;
}

static const char *check_cuts(suite *s, const assembly *a, const transcript *whole, const char *expect,
                              int sound)
{
    static char message[MAX_MESSAGE];
    const size_t size = a->bits.bits / 8, step = size * size / CUT_WORK + 1; /* a cut costs what it leaves */
    const char *why = NULL;

    for (size_t cut = 1; cut < size && !why; cut += step) {
        assembly part = *a;
        transcript t;
        cut_units(&part, cut);
        if (transcript_make(&t, &part, expect, &why))
            why = other_frame(&t, whole);
        if (!why && sound && !is_in_code(&a->bits, cut))
            why = other_error(&t);
        if (why) {
            snprintf(message, sizeof message, "cut behind byte %zu gives %s", cut, why);
            why = message;
        }
        sum(s, &t);
        transcript_free(&t);
    }
    return why;
}

/* --- bits that must be 1 --- */

static int has_line(const transcript *t, const char *beginning, const char *end)
{
    const size_t n = strlen(beginning), m = strlen(end);

    for (size_t i = 0; i < t->count; i++)
        if (!strncmp(t->line[i], beginning, n) && strlen(t->line[i]) >= m &&
            !strcmp(t->line[i] + strlen(t->line[i]) - m, end))
            return 1;
    return 0;
}

/* Bit @p i of those that must be 1 is 0: refused, and a marker is named with its place. */
static const char *check_turn(suite *s, assembly *a, const char *expect, size_t i)
{
    const size_t bit = a->bits.fixed[i];
    const uint8_t mask = (uint8_t)(0x80 >> bit % 8);
    static char message[MAX_MESSAGE], place[64];
    transcript t;
    const char *why;

    if (!(a->bits.data[bit / 8] & mask))
        return NULL; /* broken already */
    a->bits.data[bit / 8] ^= mask;
    snprintf(place, sizeof place, a->bits.is_marker[i] ? "FAP_E_BITSTREAM bit %zu," : "FAP_E_BITSTREAM bit",
             bit);
    if (transcript_make(&t, a, expect, &why) && !has_line(&t, place, "a marker bit is 0"))
        why = "it is not refused, or not at its place";
    if (why)
        snprintf(message, sizeof message, "bit %zu is 0: %s", bit, why);
    sum(s, &t);
    transcript_free(&t);
    a->bits.data[bit / 8] ^= mask;
    return why ? message : NULL;
}

static const char *check_turns(suite *s, assembly *a, const char *expect)
{
    const size_t step = a->bits.fixed_count / MAX_TURNS + 1;
    const char *why = NULL;

    for (size_t i = 0; i < a->bits.fixed_count && !why; i += step)
        why = check_turn(s, a, expect, i);
    return why;
}

/* --- files --- */

static void check_stream(suite *s, const char *name, const char *syntax, const char *expect)
{
    static char message[MAX_MESSAGE];
    assembly a;
    transcript t = { 0 };
    const char *why = NULL;

    if (!assembly_make(&a, syntax)) {
        report(s, name, "", a.error);
    } else {
        if (transcript_make(&t, &a, expect, &why) && !transcript_matches(&t, expect, message, sizeof message))
            why = message;
        if (s->show)
            transcript_print(&t, stdout);
        report(s, name, "", why);
        sum(s, &t);
        const int sound = !strstr(expect, "\noption broken 1");
        if (!s->quick && !strstr(expect, "\noption cuts 0"))
            report(s, name, ", cut", check_cuts(s, &a, &t, expect, sound));
        if (sound)
            report(s, name, ", bits turned", check_turns(s, &a, expect));
    }
    transcript_free(&t);
    assembly_free(&a);
}

static void check_file(suite *s, const char *path)
{
    char beside[1024];

    snprintf(beside, sizeof beside, "%.*s.expect", (int)(strrchr(path, '.') - path), path);
    char *syntax = read_text(path), *expect = read_text(beside);
    if (syntax && (expect || s->show))
        check_stream(s, path, syntax + 1, expect ? expect : "");
    else
        report(s, path, "", "it or its .expect cannot be read");
    free(syntax);
    free(expect);
}

int main(int argc, char **argv)
{
    suite s = { .checksum = 2166136261u };
    int i = 1;

    for (; i < argc && argv[i][0] == '-'; i++) {
        s.show |= !strcmp(argv[i], "--show");
        s.quick |= !strcmp(argv[i], "--quick");
    }
    for (; i < argc; i++)
        check_file(&s, argv[i]);
    printf("checksum %08lx\n", (unsigned long)s.checksum);
    printf("conformance: %d passed, %d failed, 0 skipped\n", s.passed, s.failed);
    return s.failed || !s.passed;
}
