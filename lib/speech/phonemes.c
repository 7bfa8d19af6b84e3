/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Names of phonemes to visemes, in five spellings. See fap/studio/speech.h; the rows are fap_tables/phonemes.csv.
 */
#include <string.h>
#include <strings.h>

#include "gen/phonemes.h"
#include "speech/phonemes.h"

/* Names for silence that every alphabet meets. */
enum { FAP_ALPHABET_ANY = FAP_ALPHABET_COUNT };

static const struct row {
    uint8_t alphabet;
    const char *name;
    uint8_t viseme, second, silent;
} rows[] = {
#define X(alphabet, name, viseme, second, silent) { FAP_ALPHABET_##alphabet, name, viseme, second, silent },
    PHONEMES_ROWS(X)
#undef X
};

const char *fap_alphabet_name(int alphabet)
{
    static const char *const names[FAP_ALPHABET_COUNT] = { NULL,    "ipa",    "arpabet",
                                                           "sampa", "espeak", "rhubarb" };
    return alphabet >= 0 && alphabet < FAP_ALPHABET_COUNT ? names[alphabet] : NULL;
}

/* Stress in front of a name: ' , " % and IPA's U+02C8 and U+02CC. */
static const char *skip_stress(const char *name)
{
    for (;;)
        if (name[0] && name[1] && strchr("',\"%", name[0]))
            name++;
        else if (!strncmp(name, "\xcb\x88", 2) || !strncmp(name, "\xcb\x8c", 2))
            name += 2;
        else
            return name;
}

/* Modifier letters U+02B0 to U+02FF and combining marks U+0300 to U+036F. */
static int is_mark(const char *at)
{
    const unsigned char lead = (unsigned char)at[0], next = (unsigned char)at[1];

    return (lead == 0xca && next >= 0xb0) || lead == 0xcb || lead == 0xcc || (lead == 0xcd && next < 0xb0);
}

/* Nothing but length, tone, stress and the like. */
static int is_ornament(fap_alphabet alphabet, const char *rest)
{
    for (; *rest; rest++)
        if (alphabet == FAP_ALPHABET_RHUBARB)
            return 0;
        else if (alphabet == FAP_ALPHABET_IPA && is_mark(rest))
            rest++;
        else if (!strchr(alphabet == FAP_ALPHABET_ARPABET ? "0123456789" : "0123456789:;_=~`'\"%,.|^", *rest))
            return 0;
    return 1;
}

/* ARPAbet is written large, TIMIT's kind of it small. */
static int begins(const struct row *row, const char *name, size_t length)
{
    return row->alphabet >= FAP_ALPHABET_ANY || row->alphabet == FAP_ALPHABET_ARPABET
               ? !strncasecmp(name, row->name, length)
               : !strncmp(name, row->name, length);
}

/* The longest name that this one begins with, if only ornaments follow. */
static const struct row *find(fap_alphabet alphabet, const char *name)
{
    const struct row *best = NULL;
    size_t longest = 0;

    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const struct row *r = &rows[i];
        const size_t length = strlen(r->name);
        if ((r->alphabet != alphabet && r->alphabet != FAP_ALPHABET_ANY) || length <= longest ||
            !begins(r, name, length))
            continue;
        if (r->alphabet == FAP_ALPHABET_ANY ? name[length] : !is_ornament(alphabet, name + length))
            continue;
        best = r;
        longest = length;
    }
    return best;
}

static const struct row *look_up(fap_alphabet alphabet, const char *name)
{
    const struct row *row = *name ? find(alphabet, name) : NULL;

    return row || !*name ? row : find(alphabet, skip_stress(name));
}

int phonemes_is_silence(fap_alphabet alphabet, const char *name)
{
    const struct row *row = look_up(alphabet, name);

    return row ? row->silent : !*name;
}

int fap_phoneme_visemes(fap_alphabet alphabet, const char *name, int *second)
{
    const struct row *row = look_up(alphabet, name);

    if (second)
        *second = row ? row->second : 0;
    if (!*name)
        return 0;
    return row ? row->viseme : -1;
}

uint32_t phonemes_known(fap_alphabet alphabet, const fap_phoneme *phoneme, uint32_t count)
{
    uint32_t known = 0;

    for (uint32_t i = 0; i < count; i++)
        known += fap_phoneme_visemes(alphabet, phoneme[i].name, NULL) >= 0;
    return known;
}

fap_alphabet phonemes_alphabet(const fap_phoneme *phoneme, uint32_t count)
{
    static const fap_alphabet order[] = { FAP_ALPHABET_IPA, FAP_ALPHABET_SAMPA, FAP_ALPHABET_ESPEAK,
                                          FAP_ALPHABET_ARPABET };
    const uint32_t enough = count < 2000 ? count : 2000;
    fap_alphabet best = order[0];
    uint32_t most = 0;

    for (size_t i = 0; i < sizeof order / sizeof *order; i++) {
        const uint32_t known = phonemes_known(order[i], phoneme, enough);
        if (known > most) {
            most = known;
            best = order[i];
        }
    }
    return best;
}
