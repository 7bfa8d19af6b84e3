/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * What is laid down before low-level FAPs speak: visemes and expressions as key models, lids that follow the
 * gaze, and blinks of the face's own. Source: ISO/IEC 14496-2, FAPs 1 and 2; Lin et al. 2001 section 5.2 (a
 * blink about every 2.5 s).
 */
#include <math.h>
#include <string.h>

#include "bank/face.h"

static const float full_look_rad = 0.55f; /* gaze angle at which an eyeLook unit is fully on */
static const int64_t blink_slot_us = 2500000;
static const int64_t blink_close_us = 90000, blink_open_us = 190000;

static void add_base(fap_face *face, fap_key_kind kind, int number, float weight)
{
    const int key = number ? fap_bank_key_number(face->bank, kind, number) : -1;

    if (key < 0 || weight <= 0)
        return;
    for (int i = 0; i < face->base_count; i++)
        if (face->base_key[i] == key) { /* select1 = select2 */
            face->base_weight[i] += weight;
            return;
        }
    face->base_key[face->base_count] = key;
    face->base_weight[face->base_count++] = weight;
}

static float share63(int value)
{
    return (float)(value < 63 ? value : 63) / 63;
}

static void lay_viseme(fap_face *face, const fap_frame *frame)
{
    const fap_viseme *v = &frame->viseme;
    const float blend = share63(v->blend);

    if (frame->state[1] == FAP_ABSENT)
        return;
    add_base(face, FAP_KEY_VISEME, v->select1, blend);
    add_base(face, FAP_KEY_VISEME, v->select2, 1 - blend);
}

static void lay_expression(fap_face *face, const fap_frame *frame)
{
    const fap_expression *e = &frame->expression;

    if (frame->state[2] == FAP_ABSENT)
        return;
    add_base(face, FAP_KEY_EXPRESSION, e->select1, share63(e->intensity1));
    add_base(face, FAP_KEY_EXPRESSION, e->select2, share63(e->intensity2));
}

static void fix(fap_face *face, int key, float weight)
{
    if (key >= 0 && weight > 0)
        face->fixed[key] = fminf(1, face->fixed[key] + weight);
}

static float angle_of(const fap_frame *frame, int fap)
{
    return frame->state[fap] == FAP_ABSENT ? 0 : 1e-5f * (float)frame->value[fap];
}

/* FAPs 23 and 24: positive yaw looks to the face's left, outward for the left eye; 25 and 26: positive pitch
 * down. */
static void lay_gaze(fap_face *face, const fap_frame *frame)
{
    const fap_face_keys *k = &face->known;

    for (int right = 0; right < 2; right++) {
        const float outward = angle_of(frame, 23 + right) * (right ? -1 : 1) / full_look_rad;
        const float down = angle_of(frame, 25 + right) / full_look_rad;
        fix(face, k->look_out[right], outward);
        fix(face, k->look_in[right], -outward);
        fix(face, k->look_down[right], down);
        fix(face, k->look_up[right], -down);
    }
}

static uint64_t hash(uint64_t x)
{
    x += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

static float smooth(float t)
{
    return t <= 0 ? 0 : t >= 1 ? 1 : t * t * (3 - 2 * t);
}

/* One blink somewhere in every 2.5 s, where is a hash of the slot: a function of time alone. */
static float blink_at(uint64_t seed, int64_t pts_us)
{
    const int64_t slot = pts_us / blink_slot_us - (pts_us % blink_slot_us < 0);
    const int64_t span = blink_slot_us - blink_close_us - blink_open_us;
    const int64_t start = (int64_t)(hash(seed ^ hash((uint64_t)slot)) % (uint64_t)span);
    const int64_t t = pts_us - slot * blink_slot_us - start;

    if (t < 0)
        return 0;
    return t < blink_close_us ? smooth((float)t / (float)blink_close_us)
                              : 1 - smooth((float)(t - blink_close_us) / (float)blink_open_us);
}

static int drives_lids(const fap_frame *frame)
{
    for (int fap = 19; fap <= 22; fap++)
        if (frame->state[fap] != FAP_ABSENT)
            return 1;
    return 0;
}

/* How much of a blink key makes the lids just touch; 1 where it never does. */
static float touching(const fap_face *face, int key, int right)
{
    const int *lid = face->slit[FAP_LIP_SLITS + right];
    const fap_key *k = face->key[key];
    const float gap = face->neutral[lid[0]][1] - face->neutral[lid[1]][1];
    const float closed = k->point_mm[lid[1]][1] - k->point_mm[lid[0]][1];

    return gap > 0 && closed > gap ? gap / closed : 1;
}

static void lay_blink(fap_face *face, const fap_frame *frame)
{
    const fap_face_keys *k = &face->known;
    const int own[2] = { k->blink[0] >= 0 ? k->blink[0] : k->blink_both, k->blink[1] };

    if (!face->cfg.blink || drives_lids(frame))
        return;
    const float weight = blink_at(face->cfg.seed, frame->pts_us);
    for (int right = 0; right < 2; right++)
        if (own[right] >= 0)
            fix(face, own[right], weight * touching(face, own[right], right));
}

static int any_fixed(const fap_face *face)
{
    for (int k = 0; k < face->key_count; k++)
        if (face->fixed[k] != 0)
            return 1;
    return 0;
}

void fap_face_lay_base(fap_face *face, const fap_frame *frame)
{
    face->base_count = 0;
    memset(face->fixed, 0, sizeof *face->fixed * (size_t)face->key_count);
    lay_viseme(face, frame);
    lay_expression(face, frame);
    lay_gaze(face, frame);
    lay_blink(face, frame);
    const int any = any_fixed(face);
    for (int row = 0; row < FAP_ROWS; row++)
        face->fixed_motion[row] = any ? fap_face_row_motion(face, row, face->fixed) : 0;
}
