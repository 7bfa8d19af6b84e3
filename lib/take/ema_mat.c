/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Articulography in MATLAB's files, as Haskins' MVIEW has it: an array of structures, one a sensor or sound, with NAME, SRATE and SIGNAL, a
 * row a sample: x, y, z in millimetres, then angles. Sounds have one column and are passed over.
 */
#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "take/mat5.h"
#include "take/take_driver.h"
#ifdef HAVE_ZLIB
#include <zlib.h>
#endif

enum { MOST_SENSORS = 256, MOST_UNPACKED = 1 << 28, MOST_FIELDS = 64 };

typedef struct sensor {
    char name[FAP_TAKE_NAME_SIZE];
    mat5_array signal;
    double rate_hz;
} sensor;

typedef struct finding {
    sensor sensor[MOST_SENSORS];
    uint32_t count, elsewhere; /* elsewhere: sensors of another length or rate */
    uint8_t *unpacked;         /* what the sensors point into */
    fap_err err;               /* why nothing could be unpacked */
} finding;

static int mat_claims(const uint8_t *data, size_t size)
{
    return mat5_claims(data, size);
}

/* --- what is in an array --- */

static int is_position(const mat5_array *a)
{
    return a->kind == MAT5_NUMBERS && a->columns >= 3 && a->columns <= 64 && a->rows >= 1 &&
           a->rows <= FAP_TAKE_MAX_SAMPLES && a->stored >= 3 * a->rows;
}

static void read_member(sensor *s, text field, const mat5_array *a)
{
    if (text_is(field, "NAME") && a->kind == MAT5_TEXT)
        mat5_text(a, s->name, sizeof s->name);
    else if (text_is(field, "SRATE") && a->kind == MAT5_NUMBERS)
        s->rate_hz = mat5_number(a, 0);
    else if (text_is(field, "SIGNAL"))
        s->signal = *a;
}

/* All have the length and the rate of the first. */
static void keep_sensor(finding *f, const sensor *s)
{
    if (!is_position(&s->signal) || f->count == MOST_SENSORS)
        return;
    if (f->count && (s->signal.rows != f->sensor[0].signal.rows || s->rate_hz != f->sensor[0].rate_hz))
        f->elsewhere++;
    else
        f->sensor[f->count++] = *s;
}

static void read_sensors(finding *f, const mat5_array *a)
{
    mat5 members = a->members;
    mat5_array member;
    text packed;

    if (a->fields > MOST_FIELDS)
        return;
    for (uint64_t i = 0; i < a->count && i < 4 * MOST_SENSORS; i++) {
        sensor s = { .name = "" };
        for (uint32_t field = 0; field < a->fields; field++) {
            if (mat5_next(&members, &member, &packed) != 1)
                return;
            read_member(&s, mat5_field(a, field), &member);
        }
        keep_sensor(f, &s);
    }
}

/* --- unpacking --- */

#ifdef HAVE_ZLIB
static uint8_t *unpack(take_source *src, finding *f, text packed, size_t *size)
{
    const size_t room = packed.length < MOST_UNPACKED / 64 ? 64 * packed.length + 1024 : MOST_UNPACKED;
    uint8_t *out = fap_mem_calloc(&src->alloc, room, 1);
    z_stream z = { .next_in = (Bytef *)(uintptr_t)packed.start, .avail_in = (uInt)packed.length };

    if (!out || inflateInit(&z) != Z_OK) {
        fap_mem_free(&src->alloc, out);
        f->err = FAP_E_NOMEM;
        return NULL;
    }
    z.next_out = out;
    z.avail_out = (uInt)room;
    inflate(&z, Z_FINISH); /* what comes out of a damaged one is looked at like any bytes */
    *size = room - z.avail_out;
    inflateEnd(&z);
    return out;
}
#else
static uint8_t *unpack(take_source *src, finding *f, text packed, size_t *size)
{
    (void)packed;
    (void)size;
    f->err = take_fail(src, FAP_E_UNSUPPORTED,
                       "mat: it is packed, and this build is without zlib; save it with save -v6");
    return NULL;
}
#endif

static void look_into(take_source *src, finding *f, mat5 m, int may_unpack)
{
    mat5_array a;
    text packed;

    for (int next; !f->count && f->err == FAP_OK && (next = mat5_next(&m, &a, &packed)) != 0;) {
        if (next == 1 && a.kind == MAT5_STRUCTURES)
            read_sensors(f, &a);
        if (next == 1 || !may_unpack)
            continue;
        size_t size = 0;
        f->unpacked = unpack(src, f, packed, &size);
        if (f->unpacked)
            look_into(src, f, mat5_inside(f->unpacked, size, m.big), 0);
        if (!f->count) {
            fap_mem_free(&src->alloc, f->unpacked);
            f->unpacked = NULL;
        }
    }
}

/* --- the take --- */

static fap_err make_take(take_source *src, const finding *f, fap_take **take)
{
    const uint64_t rows = f->sensor[0].signal.rows;
    const fap_err err = fap_take_create(take, f->count, (uint32_t)rows, &src->alloc);

    if (err != FAP_OK)
        return err;
    (*take)->format = "ema";
    (*take)->rate_hz = f->sensor[0].rate_hz > 0 && f->sensor[0].rate_hz < 1e5 ? f->sensor[0].rate_hz : 0;
    for (uint32_t i = 0; i < f->count; i++) {
        const mat5_array *signal = &f->sensor[i].signal;
        take_set_name(*take, i, f->sensor[i].name, strlen(f->sensor[i].name));
        for (uint32_t frame = 0; frame < rows; frame++) {
            float at[3];
            for (uint64_t axis = 0; axis < 3; axis++) /* x forward, y left, z up: to the axes of a head */
                at[axis] = (float)mat5_number(signal, (axis + 1) % 3 * rows + frame);
            fap_take_set(*take, frame, i, at);
        }
    }
    if (f->elsewhere)
        take_note(*take, "%u sensors of another length or rate are left out", (unsigned)f->elsewhere);
    return FAP_OK;
}

static fap_err mat_read(take_source *src, fap_take **take)
{
    finding *f = fap_mem_calloc(&src->alloc, 1, sizeof *f);
    if (!f)
        return FAP_E_NOMEM;
    look_into(src, f, mat5_open(src->data, src->size), 1);
    fap_err err = f->err;
    if (f->count)
        err = make_take(src, f, take);
    else if (err == FAP_OK)
        err = take_fail(src, FAP_E_NOT_FOUND,
                        "mat: no structures with NAME, SRATE and SIGNAL of three columns or more");
    fap_mem_free(&src->alloc, f->unpacked);
    fap_mem_free(&src->alloc, f);
    return err;
}

const take_driver take_driver_ema_mat = { "ema", mat_claims, mat_read };
