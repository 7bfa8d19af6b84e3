/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * C3D takes: header, parameter chain, points of any of the three processors, 16-bit or float. The header
 * decides where data starts and how integers scale, the parameters give names and units; where the two
 * disagree real files are right that way round. Analog channels are skipped. Source: the C3D file format as
 * described at c3d.org; deviations as found in 64 real files.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "take/c3d.h"
#include "take/take_driver.h"
#include "take/text.h"

enum {
    LABEL_PARTS = 1 + FAP_TAKE_MAX_POINTS / 255, /* LABELS, LABELS2 ... of 255 names each */
    OUTPUT_LISTS = 5,
    MAX_PARAMETER_SIZE =
        512 * C3D_BLOCK, /* twice what the format can state: real chains overrun their section */
};

/* One parameter. data lies in the file, data_size bytes of it are there. */
typedef struct record {
    int group;
    const uint8_t *name;
    unsigned name_length;
    int is_group, leads_back; /* the offset to the next one is negative: the chain ends in damage */
    int type;                 /* -1 char, 1 byte, 2 int16, 4 float */
    unsigned dimension[2];    /* bytes of a text, texts */
    const uint8_t *data;
    size_t data_size;
} record;

typedef struct c3d {
    take_source *src;
    int processor;                     /* a ::fap_c3d_processor */
    size_t first_record, record_limit; /* the parameter chain; equal when there is none */
    uint32_t points, analog_words;
    float scale; /* negative: floats */
    size_t data_start, frame_size;
    int point_group;                                   /* number of group POINT, 0: none */
    record labels[LABEL_PARTS], outputs[OUTPUT_LISTS]; /* data_size 0: not there */
} c3d;

/* --- numbers --- */

/* Bytes past the end of the file read as 0. */
static unsigned byte_at(const c3d *c, size_t at)
{
    return at < c->src->size ? c->src->data[at] : 0;
}

static unsigned u16_at(const c3d *c, size_t at)
{
    return c->processor == FAP_C3D_SGI ? byte_at(c, at) << 8 | byte_at(c, at + 1)
                                       : byte_at(c, at) | byte_at(c, at + 1) << 8;
}

static int s16_at(const c3d *c, size_t at)
{
    const int v = (int)u16_at(c, at);
    return v < 0x8000 ? v : v - 0x10000;
}

/* VAX F floats are IEEE with the halves swapped and an exponent that is two higher. */
static float float_at(const c3d *c, size_t at)
{
    const uint32_t first = u16_at(c, at), second = u16_at(c, at + 2);
    const uint32_t bits = c->processor == FAP_C3D_INTEL ? second << 16 | first : first << 16 | second;
    float v;

    memcpy(&v, &bits, sizeof v);
    return c->processor == FAP_C3D_DEC ? v / 4 : v;
}

/* Word @p n of the header, counted from 1 as the format's description does. */
static size_t header_word(unsigned n)
{
    return (n - 1) * 2;
}

/* --- the parameter chain --- */

/* What the dimensions promise and the file does not hold is cut off, so that rows can be trusted afterwards.
 */
static void dimensions(const c3d *c, size_t at, record *r)
{
    const unsigned count = byte_at(c, at++);
    size_t elements = 1;

    r->dimension[0] = 1;
    for (unsigned d = 0; d < count && d < 8; d++) {
        const unsigned n = byte_at(c, at + d);
        elements *= n; /* at most 255^8 < 2^64 */
        if (d == 0)
            r->dimension[0] = n;
    }
    at += count;
    const size_t left = at < c->record_limit ? c->record_limit - at : 0;
    const size_t width = (size_t)abs(r->type);
    r->data = c->src->data + (left ? at : 0);
    r->data_size = elements <= left / (width ? width : 1) ? elements * width : left;
    r->dimension[1] = r->dimension[0] ? (unsigned)(r->data_size / r->dimension[0]) : 0;
}

/* Reads the record at *at and moves on; 0 at the end of the chain, which is also the first record that makes
 * no sense. */
static int next_record(const c3d *c, size_t *at, record *r)
{
    if (*at + 5 > c->record_limit)
        return 0;
    const int length = abs((int8_t)byte_at(c, *at)), group = (int8_t)byte_at(c, *at + 1);
    const size_t offset_at = *at + 2 + (size_t)length;
    if (!length || !group || offset_at + 3 > c->record_limit)
        return 0;
    *r = (record){ .group = abs(group), .name = c->src->data + *at + 2, .name_length = (unsigned)length };
    r->is_group = group < 0;
    if (!r->is_group) {
        r->type = (int8_t)byte_at(c, offset_at + 2);
        dimensions(c, offset_at + 3, r);
    }
    const int offset = s16_at(c, offset_at);
    r->leads_back = offset < 0;
    *at = offset > 0 ? offset_at + (size_t)offset : c->record_limit;
    return 1;
}

static int upper(int ch)
{
    return ch >= 'a' && ch <= 'z' ? ch - 'a' + 'A' : ch;
}

static int is_called(const record *r, const char *name)
{
    const size_t length = strlen(name);

    if (r->name_length != length)
        return 0;
    for (size_t i = 0; i < length; i++)
        if (upper(r->name[i]) != name[i])
            return 0;
    return 1;
}

static int find_group(const c3d *c, const char *name)
{
    record r;

    for (size_t at = c->first_record; next_record(c, &at, &r);)
        if (r.is_group && is_called(&r, name))
            return r.group;
    return 0;
}

/* First one wins where names repeat. @p group 0: any. */
static int find_in(const c3d *c, int group, const char *name, record *r)
{
    for (size_t at = c->first_record; next_record(c, &at, r);)
        if (!r->is_group && (!group || r->group == group) && is_called(r, name) && r->data_size)
            return 1;
    r->data_size = 0;
    return 0;
}

static int find_parameter(const c3d *c, const char *name, record *r)
{
    r->data_size = 0;
    return c->point_group && find_in(c, c->point_group, name, r);
}

/* A file may have parameters and no group records: DATA_START is a name that only the point group has. */
static int find_point_group(const c3d *c)
{
    const int group = find_group(c, "POINT");
    record r;

    return group || !find_in(c, 0, "DATA_START", &r) ? group : r.group;
}

static size_t offset_of(const c3d *c, const record *r)
{
    return (size_t)(r->data - c->src->data);
}

/* The first number of a parameter; @p otherwise where there is none. 16-bit ones are unsigned: -1 means 65535
 * frames. */
static double number_of(const c3d *c, const char *name, double otherwise)
{
    record r;

    if (!find_parameter(c, name, &r))
        return otherwise;
    if (r.type == 4 && r.data_size >= 4)
        return float_at(c, offset_of(c, &r));
    if (r.type == 2 && r.data_size >= 2)
        return u16_at(c, offset_of(c, &r));
    return r.type == 1 ? byte_at(c, offset_of(c, &r)) : otherwise;
}

/* --- header --- */

static int believable_rate(float hz)
{
    return hz > 0.1f && hz < 100000;
}

/* Without a parameter section only the rate in the header can tell the processors apart. */
static int guess_processor(c3d *c)
{
    static const int all[] = { FAP_C3D_INTEL, FAP_C3D_SGI, FAP_C3D_DEC };

    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        c->processor = all[i];
        const float scale = float_at(c, header_word(7));
        if (believable_rate(float_at(c, header_word(11))) && fabsf(scale) > 1e-9f && fabsf(scale) < 1e9f)
            return all[i];
    }
    return FAP_C3D_INTEL;
}

static void find_lists(c3d *c)
{
    static const char *const outputs[OUTPUT_LISTS] = { "ANGLES", "FORCES", "MOMENTS", "POWERS", "SCALARS" };
    char name[16];

    for (unsigned part = 0; part < LABEL_PARTS; part++) {
        snprintf(name, sizeof name, part ? "LABELS%u" : "LABELS", part + 1);
        if (!find_parameter(c, name, &c->labels[part]))
            break;
    }
    for (unsigned i = 0; i < OUTPUT_LISTS; i++)
        find_parameter(c, outputs[i], &c->outputs[i]);
}

static void find_parameters(c3d *c)
{
    const unsigned block = byte_at(c, 0);
    const size_t start = block ? (block - 1) * (size_t)C3D_BLOCK : 0;
    const int processor = (int)byte_at(c, start + 3);

    if (start < C3D_BLOCK || processor < FAP_C3D_INTEL || processor > FAP_C3D_SGI) {
        c->processor = guess_processor(c);
        return;
    }
    c->processor = processor;
    const unsigned data_block = u16_at(c, header_word(9));
    const size_t data = data_block ? (data_block - 1) * (size_t)C3D_BLOCK : 0;
    c->first_record = start + 4;
    c->record_limit = data > start && data < c->src->size ? data : c->src->size;
    if (c->record_limit > start + MAX_PARAMETER_SIZE)
        c->record_limit = start + MAX_PARAMETER_SIZE;
    c->point_group = find_point_group(c);
    find_lists(c);
}

static void find_data(c3d *c)
{
    const unsigned header = u16_at(c, header_word(9));
    const double stated = header > 1 ? header : number_of(c, "DATA_START", 0);
    const unsigned parameters = byte_at(c, 0), blocks = byte_at(c, (parameters - 1u) * (size_t)C3D_BLOCK + 2);

    c->data_start = (stated > 1 ? (size_t)stated - 1 : parameters + (size_t)blocks - 1) * C3D_BLOCK;
}

/* Two 16-bit words, low first: what TRIAL:ACTUAL_START_FIELD and ACTUAL_END_FIELD are made of. */
static double long_field(const c3d *c, const char *name)
{
    const int group = find_group(c, "TRIAL");
    record r;

    if (!group || !find_in(c, group, name, &r) || r.type != 2 || r.data_size < 4)
        return 0;
    return u16_at(c, offset_of(c, &r)) + 65536.0 * u16_at(c, offset_of(c, &r) + 2);
}

static double stated_frames(const c3d *c)
{
    const unsigned first = u16_at(c, header_word(4)), last = u16_at(c, header_word(5));
    const double header = last >= first ? last - first + 1.0 : 0, parameter = number_of(c, "FRAMES", 0);
    const double start = long_field(c, "ACTUAL_START_FIELD"), end = long_field(c, "ACTUAL_END_FIELD");
    const double trial = end >= start && start > 0 ? end - start + 1 : 0;
    const double longest = fmax(trial, number_of(c, "LONG_FRAMES", 0));

    if (last == 65535 && longest > header)
        return longest;
    if (header > 0 && parameter > 0)
        return fmin(header, parameter);
    return fmax(header, parameter);
}

static fap_err read_header(c3d *c)
{
    find_parameters(c);
    find_data(c);
    c->points = u16_at(c, header_word(2));
    if (!c->points)
        c->points = (uint32_t)fmin(fmax(number_of(c, "USED", 0), 0), 65535);
    c->analog_words = u16_at(c, header_word(3));
    c->scale = float_at(c, header_word(7));
    if (!isfinite(c->scale) || c->scale == 0)
        c->scale = (float)number_of(c, "SCALE", -1);
    if (!c->points)
        return take_fail(c->src, FAP_E_NOT_FOUND,
                         "c3d: the file has no points, only %u analog values a frame",
                         (unsigned)c->analog_words);
    if (c->points > FAP_TAKE_MAX_POINTS)
        return take_fail(c->src, FAP_E_LIMIT, "c3d: %u points; at most %d are read", (unsigned)c->points,
                         FAP_TAKE_MAX_POINTS);
    c->frame_size = (c->points * (size_t)4 + c->analog_words) * (c->scale < 0 ? 4 : 2);
    return FAP_OK;
}

/* --- samples --- */

static void float_point(const c3d *c, size_t at, fap_take *take, uint32_t frame, uint32_t point)
{
    const float xyz[3] = { float_at(c, at), float_at(c, at + 4), float_at(c, at + 8) };

    if (float_at(c, at + 12) >= 0)
        fap_take_set(take, frame, point, xyz);
}

static void integer_point(const c3d *c, size_t at, fap_take *take, uint32_t frame, uint32_t point)
{
    const float xyz[3] = { c->scale * (float)s16_at(c, at), c->scale * (float)s16_at(c, at + 2),
                           c->scale * (float)s16_at(c, at + 4) };

    if (s16_at(c, at + 6) >= 0)
        fap_take_set(take, frame, point, xyz);
}

/* @p column: which points of the file become points of the take. */
static void read_samples(const c3d *c, const uint16_t *column, fap_take *take)
{
    const int is_float = c->scale < 0;
    const size_t point_size = is_float ? 16 : 8;

    for (uint32_t f = 0; f < take->frame_count; f++)
        for (uint32_t p = 0; p < take->point_count; p++) {
            const size_t at = c->data_start + f * c->frame_size + column[p] * point_size;
            if (is_float)
                float_point(c, at, take, f, p);
            else
                integer_point(c, at, take, f, p);
        }
}

/* --- names --- */

/* Row @p row of a character array; empty past its end. */
static text row_of(const record *r, unsigned row)
{
    if (r->type != -1 || row >= r->dimension[1])
        return (text){ "", 0 };
    return text_trim((text){ (const char *)r->data + (size_t)row * r->dimension[0], r->dimension[0] });
}

/* LABELS holds the first 255, LABELS2 the next, and so on. */
static text label_of(const c3d *c, unsigned point)
{
    for (unsigned part = 0; part < LABEL_PARTS && c->labels[part].data_size; part++) {
        if (point < c->labels[part].dimension[1])
            return row_of(&c->labels[part], point);
        point -= c->labels[part].dimension[1];
    }
    return (text){ "", 0 };
}

static int lists(const record *list, text label)
{
    for (unsigned row = 0; row < list->dimension[1] && row < FAP_TAKE_MAX_POINTS; row++) {
        const text t = row_of(list, row);
        if (t.length == label.length && !memcmp(t.start, label.start, t.length))
            return 1;
    }
    return 0;
}

/* Model outputs share the point list; these parameters say which labels are angles, forces and so on. */
static int is_model_output(const c3d *c, text label)
{
    for (unsigned i = 0; i < OUTPUT_LISTS && label.length; i++)
        if (c->outputs[i].data_size && lists(&c->outputs[i], label))
            return 1;
    return 0;
}

static uint32_t choose_columns(const c3d *c, uint16_t *column)
{
    uint32_t kept = 0;

    for (uint32_t p = 0; p < c->points; p++)
        if (!is_model_output(c, label_of(c, p)))
            column[kept++] = (uint16_t)p;
    return kept;
}

static void read_names(const c3d *c, const uint16_t *column, fap_take *take)
{
    for (uint32_t p = 0; p < take->point_count; p++) {
        const text label = label_of(c, column[p]);
        take_set_name(take, p, label.start, label.length);
    }
    take_finish_names(take);
}

/* --- the whole --- */

static void text_parameter(const c3d *c, const char *name, char *out, size_t room)
{
    record r;

    *out = '\0';
    if (!find_parameter(c, name, &r) || r.type != -1)
        return;
    const text t = text_trim((text){ (const char *)r.data, r.data_size });
    snprintf(out, room, "%.*s", (int)(t.length < room ? t.length : room - 1), t.start);
}

static void read_units(const c3d *c, fap_take *take)
{
    char unit[16];

    text_parameter(c, "UNITS", unit, sizeof unit);
    take->mm_per_unit = fap_take_unit_mm(unit);
    text_parameter(c, "X_SCREEN", take->screen[0], sizeof take->screen[0]);
    text_parameter(c, "Y_SCREEN", take->screen[1], sizeof take->screen[1]);
}

static void read_rate(const c3d *c, fap_take *take)
{
    const double header = float_at(c, header_word(11)), parameter = number_of(c, "RATE", 0);

    take->rate_hz = believable_rate((float)parameter) ? parameter : header;
    if (parameter > 0 && fabs(parameter - header) > 1e-3 * parameter)
        take_note(take, "header says %g frames a second, POINT:RATE %g; the latter is used", header,
                  parameter);
}

/* --- what was tolerated --- */

/* Group and name as one number, case folded: FNV-1a. */
static uint32_t key_of(const record *r)
{
    uint32_t key = 2166136261u ^ (uint32_t)r->group;

    for (unsigned i = 0; i < r->name_length; i++)
        key = (key ^ (uint32_t)upper(r->name[i])) * 16777619u;
    return key;
}

static int by_key(const void *a, const void *b)
{
    const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

/* Walks the whole chain once. A name of no length ends it, or an offset of 0; anything else is damage. */
static void note_chain(const c3d *c, fap_take *take)
{
    enum { CHECKED = 2048 };
    const size_t section = c->first_record + (size_t)C3D_BLOCK * byte_at(c, c->first_record - 2) - 4;
    uint32_t key[CHECKED];
    unsigned count = 0, repeated = 0, outside = 0;
    size_t at = c->first_record, last = at;
    record r;

    r.leads_back = 0;
    for (; next_record(c, &at, &r) && !r.leads_back; last = at) {
        outside += last >= section;
        if (count < CHECKED && !r.is_group)
            key[count++] = key_of(&r);
    }
    qsort(key, count, sizeof *key, by_key);
    for (unsigned i = 1; i < count; i++)
        repeated += key[i] == key[i - 1];
    if (repeated)
        take_note(take, "%u parameters repeat; the first of a name is used", repeated);
    if (outside)
        take_note(take, "%u parameters lie past the end of their section; they are read", outside);
    if (r.leads_back || (last < c->record_limit && byte_at(c, last)))
        take_note(take, "the record at byte %zu is no parameter; those before it are used", last);
    else if (last > c->record_limit)
        take_note(take, "the parameters run on into the data at byte %zu; those before it are used",
                  c->record_limit);
}

static void note_frames(const c3d *c, fap_take *take)
{
    const unsigned first = u16_at(c, header_word(4)), last = u16_at(c, header_word(5));
    const double header = last >= first ? last - first + 1.0 : 0, parameter = number_of(c, "FRAMES", header);
    const unsigned header_start = u16_at(c, header_word(9));
    const double start = number_of(c, "DATA_START", header_start);

    if (last != 65535 && parameter != header)
        take_note(take, "header says %.0f frames, POINT:FRAMES %.0f; the smaller is used", header, parameter);
    if (start != header_start)
        take_note(take, "header says that data start at block %u, POINT:DATA_START %.0f; the %s is used",
                  header_start, start, header_start > 1 ? "header" : "latter");
}

static void note_labels(const c3d *c, fap_take *take)
{
    unsigned labels = 0;

    for (unsigned part = 0; part < LABEL_PARTS && c->labels[part].data_size; part++)
        labels += c->labels[part].dimension[1];
    if (labels > c->points)
        take_note(take, "%u labels for %u points; the first ones are used", labels, (unsigned)c->points);
    if (take->point_count < c->points)
        take_note(take, "%u points are angles, forces and the like: left out",
                  (unsigned)(c->points - take->point_count));
}

static void note_differences(const c3d *c, fap_take *take, double stated)
{
    const double scale = number_of(c, "SCALE", c->scale), used = number_of(c, "USED", c->points);

    if (!c->point_group)
        take_note(take, "no POINT parameters; names and units are not in the file");
    if (used != c->points)
        take_note(take, "header says %u points, POINT:USED %g; the header is used", (unsigned)c->points,
                  used);
    if (c->first_record < c->record_limit)
        note_chain(c, take);
    note_frames(c, take);
    note_labels(c, take);
    if (c->scale > 0 && fabs(scale - c->scale) > 1e-4 * c->scale)
        take_note(take, "header scales by %g, POINT:SCALE %g; the header is used", c->scale, scale);
    if (take->frame_count < stated)
        take_note(take, "%.0f frames are announced, %u are in the file", stated, (unsigned)take->frame_count);
}

static fap_err read_points(c3d *c, const uint16_t *column, uint32_t kept, fap_take **out)
{
    const size_t left = c->src->size > c->data_start ? c->src->size - c->data_start : 0;
    const double stated = stated_frames(c), held = floor((double)left / (double)c->frame_size);

    if (!kept || fmin(stated, held) < 1)
        return take_fail(c->src, FAP_E_NOT_FOUND,
                         "c3d: %u points and %.0f frames announced, %.0f frames in the file", (unsigned)kept,
                         stated, held);
    if (fmin(stated, held) * kept > FAP_TAKE_MAX_SAMPLES)
        return take_fail(c->src, FAP_E_LIMIT, "c3d: %.0f frames of %u points are too many", stated,
                         (unsigned)kept);
    const fap_err err = fap_take_create(out, kept, (uint32_t)fmin(stated, held), &c->src->alloc);
    if (err != FAP_OK)
        return take_fail(c->src, err, "c3d: no room for %.0f frames of %u points", stated, (unsigned)kept);
    fap_take *take = *out;
    take->first_frame = u16_at(c, header_word(4));
    read_units(c, take);
    read_rate(c, take);
    read_names(c, column, take);
    read_samples(c, column, take);
    take_drop_zeros(take);
    note_differences(c, take, stated);
    return FAP_OK;
}

static fap_err c3d_read(take_source *src, fap_take **take)
{
    uint16_t column[FAP_TAKE_MAX_POINTS];
    c3d c = { .src = src };

    const fap_err err = read_header(&c);
    if (err != FAP_OK)
        return err;
    return read_points(&c, column, choose_columns(&c, column), take);
}

/* The key byte is one byte, so the header must look right as well. */
static int c3d_claims(const uint8_t *data, size_t size)
{
    return size >= C3D_BLOCK && data[1] == C3D_KEY && data[0] < 128 ? 90 : 0;
}

const take_driver take_driver_c3d = { "c3d", c3d_claims, c3d_read };
