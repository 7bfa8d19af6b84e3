/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The take of coefficients in memory, names of its channels, and choosing the reader. See <fap/studio/coefficients.h>.
 */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/mem.h"
#include "gen/facs_units.h"
#include "take/coef.h"

static const coef_driver *const drivers[] = { &coef_driver_livelink, &coef_driver_packets,
                                              &coef_driver_openface, &coef_driver_json };

static const char *const unit_labels[FAP_FACS_MAX_NUMBER + 1] = {
#define X(unit, label, name) [unit] = label,
    FACS_UNITS_ROWS(X)
#undef X
};

/* A share or an angle past this is no measurement. */
static const double value_limit = 1e4;

const char *fap_channel_name(int channel)
{
    if (channel < 0 || channel >= FAP_CHANNEL_COUNT)
        return NULL;
    if (channel >= FAP_CHANNEL_AU)
        return unit_labels[channel - FAP_CHANNEL_AU];
    return channel < FAP_CHANNEL_ANGLE ? fap_arkit_name(channel)
                                       : fap_arkit_angle_name(channel - FAP_CHANNEL_ANGLE);
}

fap_err fap_coefficients_create(fap_coefficients **take, uint32_t channel_count, uint32_t frame_count,
                                const fap_allocator *alloc)
{
    const fap_allocator a = fap_mem_allocator(alloc);

    *take = NULL;
    if (!channel_count || !frame_count)
        return FAP_E_ARG;
    if (channel_count > FAP_CHANNEL_COUNT || frame_count > FAP_COEFFICIENTS_MAX_FRAMES)
        return FAP_E_LIMIT;
    fap_coefficients *t = fap_mem_calloc(&a, 1, sizeof *t);
    if (!t)
        return FAP_E_NOMEM;
    const size_t samples = (size_t)channel_count * frame_count;
    t->format = "";
    t->alloc = a;
    t->channel_count = channel_count;
    t->frame_count = frame_count;
    t->value = fap_mem_calloc(&a, samples, sizeof *t->value);
    t->valid = fap_mem_calloc(&a, samples, 1);
    if (!t->value || !t->valid) {
        fap_coefficients_close(&t);
        return FAP_E_NOMEM;
    }
    *take = t;
    return FAP_OK;
}

void fap_coefficients_close(fap_coefficients **take)
{
    fap_coefficients *t = *take;

    if (!t)
        return;
    const fap_allocator a = t->alloc;
    fap_mem_free(&a, t->value);
    fap_mem_free(&a, t->valid);
    fap_mem_free(&a, t);
    *take = NULL;
}

int fap_coefficients_find(const fap_coefficients *take, int channel)
{
    for (uint32_t c = 0; c < take->channel_count; c++)
        if (take->channel[c] == channel)
            return (int)c;
    return -1;
}

void coef_note(fap_coefficients *take, const char *fmt, ...)
{
    if (take->note_count == FAP_TAKE_MAX_NOTES)
        return;
    va_list args;
    va_start(args, fmt);
    vsnprintf(take->note[take->note_count++], FAP_TAKE_NOTE_SIZE, fmt, args);
    va_end(args);
}

/* --- names --- */

static int is_filler(char c)
{
    return c == '_' || c == ' ' || c == '-' || c == '.';
}

static int lower(int c)
{
    return c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c;
}

/* Without regard to case, underscores and blanks. */
static int same_letters(text t, const char *name)
{
    for (size_t i = 0; i < t.length; i++) {
        if (is_filler(t.start[i]))
            continue;
        if (!*name || lower(t.start[i]) != lower(*name))
            return 0;
        name++;
    }
    return !*name;
}

/* "eyeBlink_L" for "EyeBlinkLeft". */
static int is_short_for(text t, const char *name)
{
    const size_t length = strlen(name);
    const char *side = length > 5 && !strcmp(name + length - 5, "Right") ? "Right" : "Left";
    char stem[32];

    if (t.length < 3 || t.start[t.length - 2] != '_' || lower(t.start[t.length - 1]) != lower(side[0]))
        return 0;
    if (length <= strlen(side) || strcmp(name + length - strlen(side), side) || length >= sizeof stem)
        return 0;
    memcpy(stem, name, length - strlen(side));
    stem[length - strlen(side)] = '\0';
    return same_letters((text){ t.start, t.length - 2 }, stem);
}

/* Behind a subject or a mesh: "Face:jawOpen", "head_GEO|jawOpen". */
static text without_prefix(text t)
{
    for (size_t i = t.length; i > 0; i--)
        if (t.start[i - 1] == ':' || t.start[i - 1] == '|')
            return (text){ t.start + i, t.length - i };
    return t;
}

int coef_channel_of(text name)
{
    const text t = without_prefix(text_trim(name));

    for (int c = 0; c < FAP_CHANNEL_ANGLE + FAP_ARKIT_ANGLE_COUNT; c++)
        if (same_letters(t, fap_channel_name(c)) || is_short_for(t, fap_channel_name(c)))
            return c;
    return -1;
}

/* --- reading --- */

static const coef_driver *sniff(const uint8_t *data, size_t size)
{
    const coef_driver *best = NULL;
    int best_score = 0;

    for (size_t i = 0; i < sizeof drivers / sizeof *drivers; i++) {
        const int score = drivers[i]->claims(data, size);
        if (score > best_score) {
            best = drivers[i];
            best_score = score;
        }
    }
    return best;
}

static fap_err read_with(const coef_driver *driver, take_source *src, const fap_take_config *cfg,
                         fap_coefficients **take)
{
    coef_rows rows = { .alloc = src->alloc };

    fap_err err = driver->read(src, &rows);
    if (err == FAP_OK && !rows.count)
        err = take_fail(src, FAP_E_NOT_FOUND, "%s: %u coefficients and not one row of numbers", driver->name,
                        (unsigned)rows.take->channel_count);
    if (err == FAP_OK)
        err = coef_rows_settle(src, &rows, cfg->rate_hz);
    if (err == FAP_OK) {
        *take = rows.take;
        rows.take = NULL;
        if (!*(*take)->format)
            (*take)->format = driver->name;
    }
    coef_rows_close(&rows);
    return err;
}

fap_err fap_coefficients_read(fap_coefficients **take, const void *data, size_t size,
                              const fap_take_config *cfg, char *where)
{
    fap_take_config defaults;

    *take = NULL;
    if (where)
        *where = '\0';
    fap_take_config_init(&defaults);
    if (!cfg)
        cfg = &defaults;
    take_source src = { .data = data, .size = size, .alloc = fap_mem_allocator(&cfg->alloc) };
    const coef_driver *driver = sniff(data, size);
    const fap_err err =
        driver ? read_with(driver, &src, cfg, take)
               : take_fail(&src, FAP_E_UNKNOWN_FORMAT,
                           "neither a table of ARKit's coefficients or OpenFace's action units, nor "
                           "recorded Live Link packets, nor BEAT or Audio2Face JSON");
    if (err != FAP_OK && where)
        memcpy(where, src.where, sizeof src.where);
    return err;
}

/* --- rows --- */

fap_err coef_rows_open(take_source *src, coef_rows *rows, uint32_t channels, uint64_t room)
{
    if (room > FAP_COEFFICIENTS_MAX_FRAMES)
        return take_fail(src, FAP_E_LIMIT, "%llu rows; at most %d are read", (unsigned long long)room,
                         FAP_COEFFICIENTS_MAX_FRAMES);
    const uint32_t n = room ? (uint32_t)room : 1;
    rows->alloc = src->alloc;
    const fap_err err = fap_coefficients_create(&rows->take, channels, n, &src->alloc);
    if (err != FAP_OK)
        return err;
    rows->room = n;
    rows->time = fap_mem_calloc(&src->alloc, n, sizeof *rows->time);
    rows->part = fap_mem_calloc(&src->alloc, n, sizeof *rows->part);
    return rows->time && rows->part ? FAP_OK : FAP_E_NOMEM;
}

void coef_rows_close(coef_rows *rows)
{
    fap_mem_free(&rows->alloc, rows->time);
    fap_mem_free(&rows->alloc, rows->part);
    fap_coefficients_close(&rows->take);
}

int64_t coef_rows_add(coef_rows *rows, double time, double part)
{
    if (rows->count == rows->room)
        return -1;
    rows->time[rows->count] = time;
    rows->part[rows->count] = part;
    return rows->count++;
}

void coef_set(coef_rows *rows, int64_t row, uint32_t column, double value)
{
    const size_t i = (size_t)row * rows->take->channel_count + column;

    if (row < 0 || !(fabs(value) < value_limit))
        return;
    rows->take->value[i] = (float)value;
    rows->take->valid[i] = 1;
}
