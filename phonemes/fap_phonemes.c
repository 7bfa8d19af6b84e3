/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * fap-phonemes: text to phonemes and their times, by espeak-ng. One of three lines of numbers and a name each is all that
 * leaves this program: "start_s <TAB> end_s <TAB> phoneme", which fapenc --phonemes reads.
 *
 * This file, and it alone, links libespeak-ng, which is under the GNU General Public License, version 3 or later; so this
 * program is too (phonemes/README.md). libfap and its tools are not: fapenc runs it and reads what it prints.
 */
#include <errno.h>
#include <getopt.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <espeak-ng/speak_lib.h>

#include <fap/version.h>

#include "common/file.h"
#include "common/tool.h"

enum { NAME_SIZE = 16, MOST_PHONEMES = 1 << 18 };

typedef struct phoneme {
    int at_ms;
    char name[NAME_SIZE];
} phoneme;

typedef struct told {
    phoneme *phoneme;
    int count, room, rate_hz, failed;
    int64_t samples;
    FILE *wav;
} told;

static void usage(FILE *to)
{
    fputs(
        "Usage: fap-phonemes [options] WORDS     what is said when, by espeak-ng's rules\n"
        "\n"
        "Prints a line for each sound: start and end in seconds and its name in the International Phonetic "
        "Alphabet, tabs\n"
        "between, which fapenc --phonemes reads. WORDS \"-\" are read from standard input.\n"
        "\n"
        "  -l, --language L  en-us, de, fr ... (en-us); espeak-ng --voices lists them\n"
        "  -w, --wav FILE    how it sounds\n"
        "      --speed N     words a minute, 80 to 450 (175)\n"
        "      --help, --version\n"
        "\n"
        "Example:\n"
        "  fap-phonemes -l de -w hallo.wav \"Hallo Welt\" > hallo.tsv\n"
        "  fapenc --speech hallo.wav --phonemes hallo.tsv -o hallo.fap\n"
        "\n"
        "This program is under the GNU GPL, version 3 or later, as espeak-ng is; the rest of libfap is not.\n"
        "Exit: 0 success, 1 bad data, 2 bad usage, 3 espeak-ng's data are missing.\n",
        to);
}

/* --- what espeak-ng tells --- */

static void add(told *t, int at_ms, const char *name, size_t size)
{
    if (t->count == t->room) {
        const int room = 2 * t->room + 256;
        phoneme *grown = t->room < MOST_PHONEMES ? realloc(t->phoneme, (size_t)room * sizeof *grown) : NULL;
        if (!grown) {
            t->failed = 1;
            return;
        }
        t->phoneme = grown;
        t->room = room;
    }
    phoneme *p = &t->phoneme[t->count++];
    *p = (phoneme){ .at_ms = at_ms };
    memcpy(p->name, name, size); /* not always terminated in there, always here */
}

/* Its callback has no room for a pointer of ours but in the events. */
static int on_sound(short *wav, int count, espeak_EVENT *event)
{
    told *t = event->user_data;

    for (; event->type != espeakEVENT_LIST_TERMINATED; event++)
        if (event->type == espeakEVENT_PHONEME)
            add(t, event->audio_position, event->id.string, sizeof event->id.string);
    for (int i = 0; wav && t->wav && i < count; i++) {
        const uint16_t bits = (uint16_t)wav[i];
        fputc(bits & 255, t->wav);
        fputc(bits >> 8, t->wav);
    }
    if (wav)
        t->samples += count;
    return t->failed;
}

/* --- a WAV file: RIFF, one channel of 16 bits --- */

static void put_number(FILE *f, uint32_t value, int size)
{
    for (int i = 0; i < size; i++)
        fputc((int)(value >> (8 * i) & 255), f);
}

static void put_head(FILE *f, uint32_t rate_hz, uint32_t bytes)
{
    rewind(f);
    fputs("RIFF", f);
    put_number(f, 36 + bytes, 4);
    fputs("WAVEfmt ", f);
    put_number(f, 16, 4);
    put_number(f, 1, 2);
    put_number(f, 1, 2);
    put_number(f, rate_hz, 4);
    put_number(f, 2 * rate_hz, 4);
    put_number(f, 2, 2);
    put_number(f, 16, 2);
    fputs("data", f);
    put_number(f, bytes, 4);
}

/* --- lines --- */

/* A name that is empty is a pause. Each sound lasts to the next one. */
static void print(const told *t)
{
    const int end_ms = (int)(1000 * t->samples / t->rate_hz);

    for (int i = 0; i < t->count; i++) {
        const int from = t->phoneme[i].at_ms, to = i + 1 < t->count ? t->phoneme[i + 1].at_ms : end_ms;
        const char *name = t->phoneme[i].name;
        if (to > from)
            printf("%d.%03d\t%d.%03d\t%s\n", from / 1000, from % 1000, to / 1000, to % 1000,
                   *name && strcmp(name, "_:") && strcmp(name, "_") ? name : "sil");
    }
}

static char *read_words(void)
{
    enum { MOST = 1 << 20 };
    char *text = malloc(MOST + 1);
    const size_t size = text ? fread(text, 1, MOST, stdin) : 0;

    if (text)
        text[size] = '\0';
    return text;
}

static int fail(int status, const char *what, const char *why)
{
    tool_error("%s%s%s", what, *why ? ": " : "", why);
    return status;
}

static int speak(told *t, const char *text, const char *language, int speed)
{
    t->rate_hz = espeak_Initialize(AUDIO_OUTPUT_SYNCHRONOUS, 0, NULL,
                                   espeakINITIALIZE_PHONEME_EVENTS | espeakINITIALIZE_PHONEME_IPA |
                                       espeakINITIALIZE_DONT_EXIT);
    if (t->rate_hz <= 0)
        return fail(EXIT_MISSING, "espeak-ng finds no data", "install espeak-ng-data");
    if (espeak_SetVoiceByName(language) != EE_OK)
        return fail(EXIT_USAGE, language, "no such language; espeak-ng --voices lists them");
    espeak_SetParameter(espeakRATE, speed, 0);
    espeak_SetSynthCallback(on_sound);
    if (t->wav)
        put_head(t->wav, (uint32_t)t->rate_hz, 0);
    const espeak_ERROR err =
        espeak_Synth(text, strlen(text) + 1, 0, POS_CHARACTER, 0, espeakCHARS_UTF8, NULL, t);
    const int done = err == EE_OK && espeak_Synchronize() == EE_OK;
    espeak_Terminate();
    if (!done || t->failed)
        return fail(EXIT_DATA, "espeak-ng could not speak it", "");
    return t->count ? EXIT_OK : fail(EXIT_DATA, "nothing in it is spoken", "");
}

typedef struct arguments {
    const char *language, *wav, *words;
    int speed;
} arguments;

/* -1: go on; else the exit status. */
static int parse(arguments *a, int argc, char **argv)
{
    static const struct option longs[] = {
        { "language", required_argument, NULL, 'l' }, { "wav", required_argument, NULL, 'w' },
        { "speed", required_argument, NULL, 's' },    { "help", no_argument, NULL, 'h' },
        { "version", no_argument, NULL, 'V' },        { NULL, 0, NULL, 0 }
    };
    int c;

    *a = (arguments){ .language = "en-us", .speed = 175 };
    while ((c = getopt_long(argc, argv, "l:w:", longs, NULL)) != -1)
        switch (c) {
        case 'l': a->language = optarg; break;
        case 'w': a->wav = optarg; break;
        case 's': a->speed = atoi(optarg); break;
        case 'h': usage(stdout); return EXIT_OK;
        case 'V': printf("fap-phonemes %s, GPL-3.0-or-later\n", fap_version()); return EXIT_OK;
        default: return EXIT_USAGE;
        }
    if (optind + 1 != argc)
        return fail(EXIT_USAGE, "what is said? fap-phonemes WORDS; fap-phonemes --help tells more", "");
    if (a->speed < 80 || a->speed > 450)
        return fail(EXIT_USAGE, "--speed", "expected words a minute, from 80 to 450");
    a->words = argv[optind];
    return -1;
}

static int run(told *t, const arguments *a, const char *words)
{
    out_file wav;

    if (a->wav && out_file_open(&wav, a->wav) != FAP_OK)
        return fail(EXIT_DATA, a->wav, strerror(errno));
    t->wav = a->wav ? wav.stream : NULL;
    const int status = speak(t, words, a->language, a->speed);
    if (t->wav && !status)
        put_head(t->wav, (uint32_t)t->rate_hz, (uint32_t)(2 * t->samples));
    if (a->wav && status)
        out_file_abandon(&wav);
    else if (a->wav && out_file_commit(&wav) != FAP_OK)
        return fail(EXIT_DATA, a->wav, strerror(errno));
    if (status)
        return status;
    print(t);
    return fflush(stdout) ? fail(EXIT_DATA, "standard output", strerror(errno)) : EXIT_OK;
}

int main(int argc, char **argv)
{
    arguments a;
    told t = { 0 };

    tool_name = "fap-phonemes";
    const int stop = parse(&a, argc, argv);
    if (stop >= 0)
        return stop;
    char *words = strcmp(a.words, "-") ? NULL : read_words();
    const int status = run(&t, &a, words ? words : a.words);
    free(words);
    free(t.phoneme);
    return status;
}
