/* SPDX-License-Identifier: BSD-2-Clause */
/* See report_speech.h. */
#include <stdio.h>

#include "common/json.h"
#include "common/tool.h"
#include "encoder/report_written.h"
#include "encoder/speech/report_speech.h"

/* More than a frame of each: sound and phonemes may not belong together. */
static const double apart_s = 0.25;

static const char *source_of(const options *opt)
{
    return opt->speech.phonemes ? opt->speech.phonemes : "--text";
}

static double end_of(const fap_speech *p)
{
    return p->count ? p->phoneme[p->count - 1].end_s : 0;
}

static void say_unknown(const fap_mouth_report *m)
{
    if (!m->unknown)
        return;
    tool_note("note: no viseme is known for %u sounds, which are spoken as their neighbours are:",
              (unsigned)m->unknown);
    for (uint32_t i = 0; i < m->unknown_names; i++)
        tool_note("  %s", m->unknown_name[i]);
}

static void say_sound(const options *opt, const spoken *s)
{
    if (!opt->speech.sound)
        return;
    tool_note("%s: %.2f s", opt->speech.sound, s->sound_s);
    if (opt->speech.text)
        tool_note(
            "  heard from %.2f to %.2f s: the text is spread over that, %.2f times as long as synthesized",
            s->heard_from_s, s->heard_to_s, s->pace);
    else if (end_of(s->speech) > s->sound_s + apart_s)
        tool_note("note: the phonemes last to %.2f s, the sound ends before: do they belong together?",
                  end_of(s->speech));
}

void report_speech_say(const options *opt, const run_report *rep)
{
    const spoken *s = &rep->spoken;
    const fap_speech *p = s->speech;

    tool_note("%s: %s, %u phonemes (%s), %u of them sounds, %.2f s", source_of(opt), p->format,
              (unsigned)p->count, fap_alphabet_name(p->alphabet), (unsigned)s->mouth.sounds, p->length_s);
    if (*p->tier)
        tool_note("  tier \"%s\"", p->tier);
    for (uint32_t i = 0; i < p->note_count; i++)
        tool_note("note: %s", p->note[i]);
    say_unknown(&s->mouth);
    say_sound(opt, s);
    tool_note("%s: %zu frames at %g Hz, %s", opt->output, s->frame_count, s->rate_hz,
              opt->speech.lips ? "FAPs of lips, jaw and tongue" : "FAP 1");
    if (opt->speech.sound)
        tool_note("  to see and hear it: fapplay %s --audio %s", opt->output, opt->speech.sound);
}

void report_speech_json(const options *opt, const run_report *rep)
{
    const spoken *s = &rep->spoken;
    json j = { .out = stdout };

    json_open(&j, NULL, '{');
    json_string(&j, "phonemes", source_of(opt));
    json_string(&j, "format", s->speech->format);
    json_string(&j, "alphabet", fap_alphabet_name(s->speech->alphabet));
    json_string(&j, "tier", s->speech->tier);
    json_integer(&j, "phoneme_count", s->speech->count);
    json_integer(&j, "sounds", s->mouth.sounds);
    json_integer(&j, "silences", s->mouth.silences);
    json_open(&j, "unknown", '[');
    for (uint32_t i = 0; i < s->mouth.unknown_names; i++)
        json_string(&j, NULL, s->mouth.unknown_name[i]);
    json_close(&j, ']');
    json_number(&j, "sound_s", s->sound_s);
    json_number(&j, "pace", s->pace);
    json_string(&j, "output", opt->output);
    json_integer(&j, "frames", (int64_t)s->frame_count);
    json_number(&j, "rate_hz", s->rate_hz);
    json_open(&j, "notes", '[');
    for (uint32_t i = 0; i < s->speech->note_count; i++)
        json_string(&j, NULL, s->speech->note[i]);
    json_close(&j, ']');
    report_written_json(&j, opt, &rep->written);
    json_close(&j, '}');
    fputc('\n', stdout);
}
