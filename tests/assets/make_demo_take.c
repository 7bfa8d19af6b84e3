/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * make_demo_take BANK.fbank OUT.c3d OUT.wav: makes the take that "make demo" encodes. A sentence is spoken by
 * espeak-ng; its phoneme times drive the visemes of a face, with head motion, blinks, brows and a smile; and
 * what an optical rig with 56 markers would have seen of that, noise and occlusions included, is written as
 * C3D beside the sound. The bank is only the actor: fapenc and fapplay see nothing of it but marker
 * positions. Not part of the product: it links espeak-ng, which is GPL. Its two outputs are committed. Source
 * of the blending of visemes: dominance functions after Cohen & Massaro 1993.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <espeak-ng/speak_lib.h>
#include <sndfile.h>

#include <fap/bank.h>
#include <fap/studio/take.h>

#include "common/file.h"

static const char sentence[] =
    "Hello. I am a face made of a few numbers. Maybe two thousand bits per second.";

enum { RATE_HZ = 120, MAX_SEGMENTS = 256, MAX_KEYS = 256 };
static const double lead_s = 0.6, tail_s = 0.9, pi = 3.14159265358979;

/* --- the rig --- */

/* A lid marker is a dot of paint on the lid's edge; the others are 3 mm balls. Names are those of a studio,
 * not ours. */
static const struct marker {
    const char *label, *point;
} rig[] = {
    { "HeadTop", "11.1" },   { "HeadR", "11.2" },    { "HeadL", "11.3" },     { "EarLoR", "10.8" },
    { "EarLoL", "10.7" },    { "EarUpR", "10.10" },  { "EarUpL", "10.9" },    { "BrowInL", "4.1" },
    { "BrowInR", "4.2" },    { "BrowMidL", "4.3" },  { "BrowMidR", "4.4" },   { "BrowOutL", "4.5" },
    { "BrowOutR", "4.6" },   { "LidUpL", "3.1" },    { "LidUpR", "3.2" },     { "LidLoL", "3.3" },
    { "LidLoR", "3.4" },     { "EyeOutL", "3.7" },   { "EyeOutR", "3.12" },   { "EyeInL", "3.11" },
    { "EyeInR", "3.8" },     { "OrbUpL", "3.13" },   { "OrbUpR", "3.14" },    { "OrbLoL", "3.9" },
    { "OrbLoR", "3.10" },    { "CheekL", "5.1" },    { "CheekR", "5.2" },     { "CheekBoneL", "5.3" },
    { "CheekBoneR", "5.4" }, { "NoseTip", "9.3" },   { "NoseBase", "9.15" },  { "NostrilL", "9.1" },
    { "NostrilR", "9.2" },   { "NoseEdgeL", "9.5" }, { "NoseEdgeR", "9.4" },  { "NoseUpL", "9.7" },
    { "NoseUpR", "9.6" },    { "NoseBump", "9.12" }, { "NoseLoL", "9.13" },   { "NoseLoR", "9.14" },
    { "LipUp", "8.1" },      { "LipLo", "8.2" },     { "LipCornerL", "8.3" }, { "LipCornerR", "8.4" },
    { "LipUpL", "8.5" },     { "LipUpR", "8.6" },    { "LipLoL", "8.7" },     { "LipLoR", "8.8" },
    { "CupidL", "8.10" },    { "CupidR", "8.9" },    { "ChinLo", "2.1" },     { "Chin", "2.10" },
    { "ChinL", "2.11" },     { "ChinR", "2.12" },    { "JawL", "2.13" },      { "JawR", "2.14" },
};
enum { MARKERS = sizeof rig / sizeof *rig };
_Static_assert(MARKERS == 56, "the rig has 56 markers");

/* --- speech --- */

typedef struct segment {
    int viseme;
    double start_s, end_s, strength;
} segment;

typedef struct speech {
    segment segment[MAX_SEGMENTS];
    int count;
    double length_s;
    SNDFILE *out;
    char last[16];
    double last_s;
} speech;

static speech spoken; /* espeak's callback has a user pointer per event only; one sentence, one program */

/* espeak-ng's en-us mnemonics; a diphthong has two visemes. 0: silence. */
static const struct phoneme {
    const char *name;
    int first, second;
    double strength;
} phonemes[] = {
    { "p", 1, 0, 1.8 },  { "b", 1, 0, 1.8 },  { "m", 1, 0, 1.8 },   { "f", 2, 0, 1.5 },  { "v", 2, 0, 1.5 },
    { "T", 3, 0, 1 },    { "D", 3, 0, 1 },    { "t", 4, 0, 0.7 },   { "d", 4, 0, 0.7 },  { "k", 5, 0, 0.5 },
    { "g", 5, 0, 0.5 },  { "tS", 6, 0, 1 },   { "dZ", 6, 0, 1 },    { "S", 6, 0, 1 },    { "s", 7, 0, 0.8 },
    { "z", 7, 0, 0.8 },  { "n", 8, 0, 0.6 },  { "l", 8, 0, 0.6 },   { "h", 0, 0, 0.1 },  { "r", 9, 0, 0.8 },
    { "3:", 9, 0, 0.9 }, { "3", 9, 0, 0.7 },  { "aI", 10, 12, 1 },  { "aU", 10, 14, 1 }, { "oU", 13, 14, 1 },
    { "eI", 11, 12, 1 }, { "E", 11, 0, 0.9 }, { "I", 12, 0, 0.8 },  { "i:", 12, 0, 1 },  { "u:", 14, 0, 1.1 },
    { "V", 10, 0, 0.7 }, { "@", 11, 0, 0.5 }, { "a#", 11, 0, 0.5 }, { "A:", 10, 0, 1 },  { "w", 14, 0, 1.2 },
    { "j", 12, 0, 0.6 },
};

static void add_segment(speech *s, int viseme, double start, double end, double strength)
{
    if (viseme && s->count < MAX_SEGMENTS)
        s->segment[s->count++] = (segment){ viseme, start + lead_s, end + lead_s, strength };
}

static void end_phoneme(speech *s, double end)
{
    for (size_t i = 0; i < sizeof phonemes / sizeof *phonemes; i++) {
        const struct phoneme *p = &phonemes[i];
        if (strcmp(p->name, s->last))
            continue;
        const double middle = p->second ? s->last_s + 0.55 * (end - s->last_s) : end;
        add_segment(s, p->first, s->last_s, middle, p->strength);
        add_segment(s, p->second, middle, end, p->strength);
        return;
    }
    if (s->last[0] && s->last[0] != '_')
        fprintf(stderr, "make_demo_take: phoneme %s has no viseme\n", s->last);
}

static int on_audio(short *wav, int count, espeak_EVENT *event)
{
    for (; event->type != espeakEVENT_LIST_TERMINATED; event++) {
        if (event->type != espeakEVENT_PHONEME)
            continue;
        const double now = event->audio_position * 1e-3;
        end_phoneme(&spoken, now);
        memset(spoken.last, 0, sizeof spoken.last);
        memcpy(spoken.last, event->id.string, sizeof event->id.string);
        spoken.last_s = now;
        spoken.length_s = now;
    }
    if (wav && count > 0)
        sf_writef_short(spoken.out, wav, count);
    return 0;
}

static void write_silence(SNDFILE *out, int rate, double seconds)
{
    const short zero = 0;
    for (int i = 0; i < (int)(rate * seconds); i++)
        sf_writef_short(out, &zero, 1);
}

static int speak(const char *wav_path)
{
    const int rate = espeak_Initialize(AUDIO_OUTPUT_SYNCHRONOUS, 0, NULL,
                                       espeakINITIALIZE_PHONEME_EVENTS | espeakINITIALIZE_DONT_EXIT);
    SF_INFO info = { .samplerate = rate, .channels = 1, .format = SF_FORMAT_WAV | SF_FORMAT_PCM_16 };

    if (rate <= 0 || !(spoken.out = sf_open(wav_path, SFM_WRITE, &info)))
        return 0;
    write_silence(spoken.out, rate, lead_s);
    espeak_SetVoiceByName("en-us");
    espeak_SetParameter(espeakRATE, 150, 0);
    espeak_SetSynthCallback(on_audio);
    espeak_Synth(sentence, sizeof sentence, 0, POS_CHARACTER, 0, espeakCHARS_UTF8, NULL, NULL);
    espeak_Synchronize();
    write_silence(spoken.out, rate, tail_s);
    return sf_close(spoken.out) == 0;
}

/* --- acting --- */

/* A smooth bump of height 1 between two times. */
static double bump(double t, double from, double to)
{
    return t <= from || t >= to ? 0 : 0.5 - 0.5 * cos(2 * pi * (t - from) / (to - from));
}

static double ramp(double t, double from, double to)
{
    const double u = fmin(1, fmax(0, (t - from) / (to - from)));
    return u * u * (3 - 2 * u);
}

/* Full within the segment, falling off outside: lips start for a bilabial about 90 ms ahead of it. */
static double dominance(const segment *s, double t)
{
    const double before = 0.075, after = 0.065, middle = 0.5 * (s->start_s + s->end_s);
    const double half = 0.3 * (s->end_s - s->start_s), d = fabs(t - middle) - half;

    if (d <= 0)
        return s->strength;
    const double width = t < middle ? before : after;
    return s->strength * exp(-(d * d) / (width * width));
}

static void viseme_weights(double t, double weight[FAP_VISEME_COUNT + 1])
{
    double rest = 0.12, sum;

    memset(weight, 0, (FAP_VISEME_COUNT + 1) * sizeof *weight);
    sum = rest;
    for (int i = 0; i < spoken.count; i++) {
        const double d = dominance(&spoken.segment[i], t);
        weight[spoken.segment[i].viseme] +=
            d * d; /* squared: the strongest shape wins, the others colour it */
        sum += d * d;
    }
    for (int v = 1; v <= FAP_VISEME_COUNT; v++)
        weight[v] /= sum;
}

/* Lids fall in 80 ms, rest 30 ms, rise in 160 ms. */
static double blink(double t, double at)
{
    return ramp(t, at, at + 0.08) * (1 - ramp(t, at + 0.11, at + 0.27));
}

static void act(const fap_bank *bank, double t, double weight[MAX_KEYS])
{
    double viseme[FAP_VISEME_COUNT + 1];
    const double end = lead_s + spoken.length_s;

    memset(weight, 0, MAX_KEYS * sizeof *weight);
    viseme_weights(t, viseme);
    for (int v = 1; v <= FAP_VISEME_COUNT; v++)
        weight[fap_bank_key_number(bank, FAP_KEY_VISEME, v)] = viseme[v];
    weight[fap_bank_key_find(bank, FAP_KEY_EXTRA, "blink")] =
        fmin(1, blink(t, lead_s + 0.42) + blink(t, lead_s + 2.45) + blink(t, end - 0.15));
    weight[fap_bank_key_find(bank, FAP_KEY_EXTRA, "brows_up")] = 0.45 * bump(t, lead_s - 0.05, lead_s + 0.6) +
                                                                 0.35 * bump(t, lead_s + 0.9, lead_s + 1.6) +
                                                                 0.5 * bump(t, lead_s + 2.6, lead_s + 3.7);
    weight[fap_bank_key_number(bank, FAP_KEY_EXPRESSION, 1)] =
        0.22 * bump(t, lead_s, lead_s + 1) + 0.5 * ramp(t, end - 0.1, end + 0.35);
}

/* The head: two slow sways and a nod on the stressed words, degrees; millimetres for the torso that carries
 * it. */
static void head_pose(double t, float rotation[3][3], double sway_mm[3])
{
    const double on = ramp(t, 0.35, 0.9), au = pi / 180 * 1e5;
    const double yaw = on * (3.2 * sin(2 * pi * 0.21 * (t - 0.4)) + 1.1 * sin(2 * pi * 0.57 * t));
    const double roll = on * (1.6 * sin(2 * pi * 0.17 * t + 1) + 0.6 * sin(2 * pi * 0.43 * t));
    const double nod = 2.6 * bump(t, lead_s, lead_s + 0.5) + 2 * bump(t, lead_s + 0.95, lead_s + 1.5) +
                       2.4 * bump(t, lead_s + 2.75, lead_s + 3.4) + 1.5 * bump(t, lead_s + 3.6, lead_s + 4.2);
    const double pitch = nod + on * 0.8 * sin(2 * pi * 0.33 * t);

    fap_head_rotation((int32_t)lrint(pitch * au), (int32_t)lrint(yaw * au), (int32_t)lrint(roll * au),
                      rotation);
    sway_mm[0] = on * 6 * sin(2 * pi * 0.19 * t);
    sway_mm[1] = on * 2 * sin(2 * pi * 0.31 * t);
    sway_mm[2] = on * 5 * sin(2 * pi * 0.13 * t + 2);
}

/* --- what the cameras saw --- */

static double uniform(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) / 9007199254740992.0;
}

static double normal(uint64_t *state)
{
    double sum = -6;
    for (int i = 0; i < 12; i++)
        sum += uniform(state);
    return sum;
}

/* The room has z up, and the actor looks along -y; its origin is on the table before the actor, where the
 * wand lay. */
static void to_room(const double head[3], float room[3])
{
    room[0] = (float)(head[0] + 42);
    room[1] = (float)(-head[2] + 130);
    room[2] = (float)(head[1] + 150);
}

static void marker_position(const fap_bank *bank, int point, const double *weight, double out[3])
{
    const fap_bank_point *p = fap_bank_point_get(bank, point);

    for (int a = 0; a < 3; a++)
        out[a] = p->position_mm[a];
    for (int k = 0; k < fap_bank_key_count(bank); k++)
        for (int a = 0; weight[k] != 0 && a < 3; a++)
            out[a] += weight[k] * fap_bank_key_get(bank, k)->point_mm[point][a];
}

/* Hands and hair: three markers vanish for a few frames each. */
static int occluded(int marker, int frame)
{
    return (marker == 25 && frame >= 200 && frame < 209) || (marker == 47 && frame >= 310 && frame < 316) ||
           (marker == 8 && frame >= 420 && frame < 434);
}

static void film(const fap_bank *bank, fap_take *take)
{
    const double noise_mm = 0.05;
    const float *pivot = fap_bank_point_get(bank, fap_point_by_name("7.1"))->position_mm;
    uint64_t random = 20261123;

    for (int f = 0; f < (int)take->frame_count; f++) {
        const double t = (double)f / RATE_HZ;
        double weight[MAX_KEYS], sway[3];
        float rotation[3][3];
        act(bank, t, weight);
        head_pose(t, rotation, sway);
        for (int m = 0; m < MARKERS; m++) {
            double face[3], head[3];
            marker_position(bank, fap_point_by_name(rig[m].point), weight, face);
            for (int a = 0; a < 3; a++) {
                head[a] = pivot[a] + sway[a] + noise_mm * normal(&random);
                for (int b = 0; b < 3; b++)
                    head[a] += rotation[a][b] * (face[b] - pivot[b]);
            }
            float room[3];
            to_room(head, room);
            if (!occluded(m, f))
                fap_take_set(take, (uint32_t)f, (uint32_t)m, room);
        }
    }
}

static fap_err write_take(const fap_take *take, const char *path)
{
    out_file out;
    fap_err err = out_file_open(&out, path);

    if (err != FAP_OK)
        return err;
    const fap_writer w = file_writer(out.stream);
    err = fap_take_write_c3d(take, &w, FAP_C3D_INTEL, 1);
    if (err == FAP_OK)
        return out_file_commit(&out);
    out_file_abandon(&out);
    return err;
}

static fap_err load_bank(fap_bank **bank, const char *path)
{
    uint8_t *data;
    size_t size;
    fap_err err = file_read(path, 1 << 28, &data, &size);

    if (err != FAP_OK)
        return err;
    err = fap_bank_load(bank, data, size, NULL);
    free(data);
    return err;
}

int main(int argc, char **argv)
{
    fap_bank *bank = NULL;
    fap_take *take = NULL;

    if (argc != 4) {
        fprintf(stderr, "usage: make_demo_take BANK.fbank OUT.c3d OUT.wav\n");
        return 2;
    }
    fap_err err = load_bank(&bank, argv[1]);
    if (err == FAP_OK && !speak(argv[3]))
        err = FAP_E_IO;
    if (err == FAP_OK)
        err =
            fap_take_create(&take, MARKERS, (uint32_t)((lead_s + spoken.length_s + tail_s) * RATE_HZ), NULL);
    if (err == FAP_OK) {
        take->rate_hz = RATE_HZ;
        for (int m = 0; m < MARKERS; m++)
            snprintf(take->name[m], FAP_TAKE_NAME_SIZE, "%s", rig[m].label);
        film(bank, take);
        err = write_take(take, argv[2]);
    }
    if (err != FAP_OK)
        fprintf(stderr, "make_demo_take: %s\n", fap_strerror(err));
    fap_take_close(&take);
    fap_bank_close(&bank);
    return err != FAP_OK;
}
