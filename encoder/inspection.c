/* SPDX-License-Identifier: BSD-2-Clause */
/* See inspection.h. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <fap/tables.h>

#include "encoder/inspection.h"

/* --- the fullest two seconds --- */

static void drop_before(inspection *in, int64_t pts_us)
{
    while (in->first < in->last && in->window[in->first % INSPECT_WINDOW].pts_us <= pts_us)
        in->window_bits -= in->window[in->first++ % INSPECT_WINDOW].bits;
}

/* Stuffing in front of a start code ends what was sent before: a packet is whole bytes. */
static int64_t code_at(const inspection *in, const fap_plane_info *p)
{
    const int64_t at = p->bit_position;
    const size_t byte = (size_t)(at / 8);

    if (!p->start_code)
        return at;
    if (at % 8)
        return (at + 7) / 8 * 8;
    return byte < in->size && in->data[byte] == 0x7F ? at + 8 : at;
}

/* Bits up to @p bit belong to the newest plane: stuffing, end code and what could not be decoded included. */
static void close_plane(inspection *in, int64_t bit)
{
    if (in->first == in->last)
        return;
    const uint64_t bits = (uint64_t)(bit - in->plane_at);
    in->window[(in->last - 1) % INSPECT_WINDOW].bits = bits;
    in->window_bits += bits;
    if (in->window_bits > in->largest_window_bits)
        in->largest_window_bits = in->window_bits;
}

static void open_plane(inspection *in, const fap_plane_info *p, int64_t pts_us)
{
    const int64_t two_seconds_us = 2000000, rounding_us = 2;

    const int64_t at = code_at(in, p);

    close_plane(in, at);
    drop_before(in, pts_us - two_seconds_us + rounding_us);
    if (in->last - in->first == INSPECT_WINDOW)
        in->window_bits -= in->window[in->first++ % INSPECT_WINDOW].bits;
    /* The object's start code is the first plane's. */
    in->plane_at = in->last ? at : 0;
    in->window[in->last % INSPECT_WINDOW].pts_us = pts_us;
    in->window[in->last++ % INSPECT_WINDOW].bits = 0;
}

/* --- what a plane is made of --- */

static uint32_t sum_of_faps(const fap_plane_info *p)
{
    uint32_t sum = 0;

    for (int fap = 1; fap <= FAP_COUNT; fap++)
        sum += p->fap_bits[fap];
    return sum;
}

static void count_kind(plane_kind *k, const fap_plane_info *p)
{
    k->planes++;
    k->bits += p->bit_count;
    k->largest = p->bit_count > k->largest ? p->bit_count : k->largest;
    k->start_codes += p->start_code;
    k->header += p->header_bits;
    k->setup += p->setup_bits;
    k->ranges += p->range_bits;
    k->faps += sum_of_faps(p);
    k->runs += p->run_bits;
    k->body += p->body_bits;
}

static int count_coded(const fap_frame *f, int first, int count, uint32_t *bits)
{
    int n = 0;

    *bits = 0;
    for (int i = 0; i < count; i++)
        if (f->state[first + i] == FAP_CODED) {
            *bits |= 1u << i;
            n++;
        }
    return n;
}

static void count_mask(inspection *in, int group, const fap_plane_info *p, const fap_frame *f)
{
    group_masks *g = &in->group[group];
    const int type = p->mask_type[group];
    uint32_t bits;
    const int coded = count_coded(f, fap_group_first(group), fap_group_count(group), &bits);

    g->of_type[type % INSPECT_MASK_TYPES]++;
    if (g->kept && bits == g->coded_bits && type == g->type)
        return;
    g->changes += g->kept > 0;
    g->type = type;
    g->coded_bits = bits;
    if (g->kept < INSPECT_MAX_CHANGES)
        g->change[g->kept++] =
            (mask_change){ (int64_t)(in->kind[0].planes + in->kind[1].planes), f->number, type, coded };
}

static int16_t lower(int16_t a, int16_t b)
{
    return a < b ? a : b;
}

static int16_t higher(int16_t a, int16_t b)
{
    return a > b ? a : b;
}

static void count_ranges(fap_ranges *r, const fap_plane_info *p, int fap)
{
    const fap_ranges now = { 1, 0, p->i_min[fap], p->i_max[fap], p->p_min[fap], p->p_max[fap] };
    const fap_ranges old = *r;

    if (!old.known) {
        *r = now;
        return;
    }
    r->i_min = lower(old.i_min, now.i_min);
    r->i_max = higher(old.i_max, now.i_max);
    r->p_min = lower(old.p_min, now.p_min);
    r->p_max = higher(old.p_max, now.p_max);
    r->vary |=
        old.i_min != now.i_min || old.i_max != now.i_max || old.p_min != now.p_min || old.p_max != now.p_max;
}

static void count_setup(inspection *in, const fap_plane_info *p, const fap_frame *f)
{
    for (int group = 1; group <= FAP_GROUPS; group++)
        count_mask(in, group, p, f);
    for (int fap = 3; fap <= FAP_COUNT; fap++)
        if (f->state[fap] == FAP_CODED)
            count_ranges(&in->ranges[fap], p, fap);
    in->quant_i[p->quant % INSPECT_QUANTS]++;
    *(p->gender ? &in->male : &in->female) += 1;
}

static void count_faps(inspection *in, const fap_plane_info *p, const fap_frame *f)
{
    for (int fap = 1; fap <= FAP_COUNT; fap++) {
        in->fap_bits[p->intra != 0][fap] += p->fap_bits[fap];
        in->derived[fap] += f->state[fap] == FAP_DERIVED;
    }
}

static void keep_plane(inspection *in, const fap_plane_info *p, const fap_frame *f)
{
    if (in->plane_count == in->plane_room) {
        const size_t room = in->plane_room ? 2 * in->plane_room : 256;
        plane_record *grown = realloc(in->plane, room * sizeof *grown);
        if (!grown) {
            in->out_of_memory = 1;
            return;
        }
        in->plane = grown;
        in->plane_room = room;
    }
    plane_record *r = &in->plane[in->plane_count++];
    *r = (plane_record){ *p, f->number, f->pts_us, sum_of_faps(p), 0 };
    for (int fap = 1; fap <= FAP_COUNT; fap++)
        r->coded += f->state[fap] == FAP_CODED;
}

static void take_plane(void *user, const fap_plane_info *p, const fap_frame *f)
{
    inspection *in = user;

    open_plane(in, p, f->pts_us);
    if (p->intra && p->has_face)
        count_setup(in, p, f);
    count_kind(&in->kind[p->intra != 0], p);
    count_faps(in, p, f);
    in->with_face += p->has_face;
    in->with_body += p->has_body;
    in->quant_all[p->quant % INSPECT_QUANTS]++;
    if (in->keep_planes && !in->out_of_memory)
        keep_plane(in, p, f);
}

static void take_broken(void *user, const char *why)
{
    inspection *in = user;

    if (in->broken_kept < INSPECT_MAX_BROKEN)
        snprintf(in->broken[in->broken_kept++].why, FAP_ERROR_TEXT_SIZE, "%s", why);
}

static fap_err take_frame(void *user, const fap_frame *f)
{
    const inspection *in = user;

    (void)f;
    return in->out_of_memory ? FAP_E_NOMEM : FAP_OK;
}

frame_sink inspection_sink(inspection *in)
{
    return (frame_sink){ .put = take_frame, .user = in, .plane = take_plane, .broken = take_broken };
}

void inspection_end(inspection *in)
{
    close_plane(in, (int64_t)in->size * 8);
}

void inspection_free(inspection *in)
{
    free(in->plane);
    *in = (inspection){ 0 };
}
