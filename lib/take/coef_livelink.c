/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Tables of ARKit's coefficients: Live Link Face's, and any other that has their names over its columns, MediaPipe's
 * blendshapes among them. Columns are found by name; those of other names are left out and said. The time code counts frames in a
 * base that the file does not state, see coef_clock.c. Source: files of the app; spellings that other writers use.
 */
#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "take/coef.h"

/* Fewer names than this may be chance. */
enum { FEWEST_NAMES = 6 };

typedef enum time_kind { TIME_NONE, TIME_CODE, TIME_SECONDS, TIME_MILLISECONDS, TIME_FRAME } time_kind;

typedef struct table {
    text_lines body;
    char separator;
    int time_column;
    time_kind kind;
    int16_t channel[TEXT_MAX_CELLS]; /* of each column; -1: none */
    size_t columns;
    uint32_t channel_count;
    text_row row;
} table;

/* --- the head line --- */

static text next_cell(text *rest, char separator)
{
    size_t n = 0;

    while (n < rest->length && rest->start[n] != separator)
        n++;
    const text cell = text_trim((text){ rest->start, n });
    const size_t used = n < rest->length ? n + 1 : n;
    *rest = (text){ rest->start + used, rest->length - used };
    return cell;
}

static int first_line(text_lines *lines, text *line)
{
    while (text_next(lines, line))
        if (text_trim(*line).length)
            return 1;
    return 0;
}

static text unquoted(text t)
{
    return t.length >= 2 && t.start[0] == '"' ? (text){ t.start + 1, t.length - 2 } : t;
}

/* Names enough, or one and the column that only these tables have. */
static int livelink_claims(const uint8_t *data, size_t size)
{
    text_lines lines = text_open(data, size);
    text line;
    int names = 0, counts = 0;

    if (!first_line(&lines, &line))
        return 0;
    const char separator = text_separator(line);
    for (size_t cells = 0; line.length && cells < TEXT_MAX_CELLS && names < FEWEST_NAMES; cells++) {
        const text cell = unquoted(next_cell(&line, separator));
        names += coef_channel_of(cell) >= 0;
        counts |= text_is(cell, "BlendShapeCount");
    }
    return names >= FEWEST_NAMES || (names && counts) ? 80 : 0;
}

static int is_one_of(text t, const char *const *words)
{
    for (; *words; words++)
        if (text_is(t, *words))
            return 1;
    return 0;
}

static time_kind kind_of(text name)
{
    static const char *const codes[] = { "timecode", "tc", "smpte", NULL };
    static const char *const ms[] = { "time_ms",      "timestamp_ms", "time (ms)", "timems",
                                      "milliseconds", "ms",           NULL };
    static const char *const seconds[] = { "time", "timestamp", "time_s", "seconds", "time (s)", "t", NULL };
    static const char *const frames[] = { "frame", "frame_number", "framenumber", "frame#", "index", NULL };

    return is_one_of(name, codes)     ? TIME_CODE
           : is_one_of(name, ms)      ? TIME_MILLISECONDS
           : is_one_of(name, seconds) ? TIME_SECONDS
           : is_one_of(name, frames)  ? TIME_FRAME
                                      : TIME_NONE;
}

/* Columns that are no coefficients and need no words. */
static int is_known_other(text name)
{
    static const char *const others[] = { "",  "blendshapecount", "_neutral", "image_width", "image_height",
                                          NULL };
    return is_one_of(name, others);
}

static int has_channel(const table *t, size_t before, int channel)
{
    for (size_t i = 0; i < before; i++)
        if (t->channel[i] == channel)
            return 1;
    return 0;
}

/* Channels by column, and the best clock: a time code before times before frame numbers. */
static void read_head(table *t)
{
    t->columns = t->row.count;
    t->time_column = -1;
    for (size_t i = 0; i < t->columns; i++) {
        const int channel = coef_channel_of(t->row.cell[i]);
        const time_kind kind = kind_of(t->row.cell[i]);
        t->channel[i] = (int16_t)(channel >= 0 && !has_channel(t, i, channel) ? channel : -1);
        t->channel_count += t->channel[i] >= 0;
        if (kind != TIME_NONE && (t->time_column < 0 || kind < t->kind)) {
            t->time_column = (int)i;
            t->kind = kind;
        }
    }
}

static void note_unknown(const table *t, fap_coefficients *take)
{
    char list[FAP_TAKE_NOTE_SIZE - 64] = "";
    size_t used = 0, count = 0;

    for (size_t i = 0; i < t->columns; i++) {
        const text name = t->row.cell[i];
        if (t->channel[i] >= 0 || kind_of(name) != TIME_NONE || is_known_other(name))
            continue;
        count++;
        if (used + name.length + 3 >= sizeof list)
            continue;
        for (size_t k = 0; k < name.length; k++)
            list[used++] = (char)((unsigned char)name.start[k] < ' ' ? '_' : name.start[k]);
        list[used++] = ' ';
        list[used] = '\0';
    }
    if (count)
        coef_note(take, "%u columns are left out, no coefficient has their name: %s", (unsigned)count, list);
}

static void name_channels(const table *t, fap_coefficients *take)
{
    uint32_t n = 0;

    for (size_t i = 0; i < t->columns; i++)
        if (t->channel[i] >= 0)
            take->channel[n++] = (uint8_t)t->channel[i];
}

/* --- times --- */

/* "HH:MM:SS:FF.fff" or "HH:MM:SS.mmm"; returns how many fields there are. */
static int split_code(text cell, double field[4])
{
    int count = 0;

    while (cell.length && count < 4) {
        size_t n = 0;
        while (n < cell.length && cell.start[n] != ':' && cell.start[n] != ';')
            n++;
        if (text_number((text){ cell.start, n }, &field[count]) != TEXT_NUMBER || field[count] < 0 ||
            field[count] > 1e6)
            return 0;
        count++;
        const size_t used = n < cell.length ? n + 1 : n;
        cell = (text){ cell.start + used, cell.length - used };
    }
    return cell.length ? 0 : count;
}

/* What the clock of a row shows; 0: nothing that can be read. */
static int read_time(const table *t, double *time, double *part)
{
    double field[4] = { 0 };
    const text cell = text_cell(&t->row, (size_t)t->time_column);

    *part = 0;
    if (t->kind != TIME_CODE)
        return text_number(cell, time) == TEXT_NUMBER;
    const int count = split_code(cell, field);
    *time =
        count == 1 ? field[0] : field[0] * 3600 + field[1] * 60 + (count == 4 ? floor(field[2]) : field[2]);
    *part = count == 4 ? field[3] : 0;
    return count == 1 || count >= 3;
}

/* A "time code" column may hold three kinds of clock; the first row says which. */
static coef_clock clock_of(const table *t)
{
    double field[4];

    switch (t->kind) {
    case TIME_CODE:
        switch (split_code(text_cell(&t->row, (size_t)t->time_column), field)) {
        case 4: return COEF_CLOCK_TIMECODE;
        case 3: return COEF_CLOCK_SECONDS;
        default: return COEF_CLOCK_FRAMES;
        }
    case TIME_SECONDS:
    case TIME_MILLISECONDS: return COEF_CLOCK_SECONDS;
    case TIME_FRAME: return COEF_CLOCK_FRAMES;
    case TIME_NONE: break;
    }
    return COEF_CLOCK_NONE;
}

/* --- rows --- */

static uint64_t count_rows(text_lines lines)
{
    uint64_t n = 0;
    text line;

    while (text_next(&lines, &line))
        n += text_trim(line).length > 0;
    return n;
}

static void read_values(const table *t, coef_rows *rows, int64_t row)
{
    uint32_t column = 0;

    for (size_t i = 0; i < t->columns; i++) {
        double v;
        if (t->channel[i] < 0)
            continue;
        if (text_number(text_cell(&t->row, i), &v) == TEXT_NUMBER)
            coef_set(rows, row, column, v);
        column++;
    }
}

static void read_rows(table *t, coef_rows *rows)
{
    uint32_t timeless = 0;
    text line;

    while (text_next(&t->body, &line)) {
        double time = rows->count, part = 0;
        text_split(line, t->separator, &t->row);
        if (text_row_is_blank(&t->row))
            continue;
        if (!rows->count)
            rows->clock = clock_of(t);
        if (rows->clock != COEF_CLOCK_NONE && !read_time(t, &time, &part)) {
            timeless++;
            continue;
        }
        read_values(t, rows, coef_rows_add(rows, time, part));
    }
    if (timeless)
        coef_note(rows->take, "%u rows have no time and are left out", (unsigned)timeless);
}

/* --- units --- */

static double largest_shape(const fap_coefficients *t, uint32_t rows)
{
    double most = 0;

    for (uint32_t i = 0; i < rows; i++)
        for (uint32_t c = 0; c < t->channel_count; c++)
            if (t->channel[c] < FAP_CHANNEL_ANGLE)
                most = fmax(most, (double)t->value[(size_t)i * t->channel_count + c]);
    return most;
}

/* iFacialMocap counts to 100. */
static void settle_percent(coef_rows *rows)
{
    fap_coefficients *t = rows->take;
    const double most = largest_shape(t, rows->count);

    if (most <= 5)
        return;
    for (size_t i = 0; i < (size_t)rows->count * t->channel_count; i++)
        if (t->channel[i % t->channel_count] < FAP_CHANNEL_ANGLE)
            t->value[i] /= 100;
    coef_note(t, "coefficients go up to %.4g: they are taken as percent", most);
}

/* Milliseconds by their name, or because no camera takes seconds for a frame. */
static void settle_milliseconds(const table *t, coef_rows *rows)
{
    const uint32_t n = rows->count;
    const double step = n > 1 ? (rows->time[n - 1] - rows->time[0]) / (n - 1) : 0;

    if (rows->clock != COEF_CLOCK_SECONDS || (t->kind != TIME_MILLISECONDS && step < 4))
        return;
    for (uint32_t i = 0; i < n; i++)
        rows->time[i] /= 1000;
    if (t->kind != TIME_MILLISECONDS)
        coef_note(rows->take, "times are taken as milliseconds");
}

/* --- all --- */

static fap_err read_table(take_source *src, table *t, coef_rows *rows)
{
    text line;

    t->body = text_open(src->data, src->size);
    if (!first_line(&t->body, &line))
        return take_fail(src, FAP_E_SYNTAX, "no head line");
    t->separator = text_separator(line);
    text_split(line, t->separator, &t->row);
    read_head(t);
    const fap_err err = coef_rows_open(src, rows, t->channel_count, count_rows(t->body));
    if (err != FAP_OK)
        return err;
    name_channels(t, rows->take);
    note_unknown(t, rows->take);
    read_rows(t, rows);
    settle_percent(rows);
    settle_milliseconds(t, rows);
    rows->snap = t->kind == TIME_CODE ? 0 : 0.002;
    return FAP_OK;
}

static fap_err livelink_read(take_source *src, coef_rows *rows)
{
    table *t = fap_mem_calloc(&src->alloc, 1, sizeof *t);

    if (!t)
        return FAP_E_NOMEM;
    const fap_err err = read_table(src, t, rows);
    fap_mem_free(&src->alloc, t);
    return err;
}

const coef_driver coef_driver_livelink = { "livelink", livelink_claims, livelink_read };
