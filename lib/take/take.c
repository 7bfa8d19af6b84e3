/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The take in memory: making, freeing, names, units, and choosing the reader. See <fap/studio/take.h>.
 */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "take/take_driver.h"

static const take_driver *const drivers[] = {
    &take_driver_c3d,     &take_driver_trc,       &take_driver_nexus,        &take_driver_motive,
    &take_driver_plain,   &take_driver_openface,  &take_driver_coefficients, &take_driver_ema_pos,
    &take_driver_ema_mat, &take_driver_landmarks,
};

/* A coordinate past this is no measurement, and squaring it must not overflow a float. */
static const float coordinate_limit = 1e7f;

void fap_take_config_init(fap_take_config *cfg)
{
    *cfg = (fap_take_config){ .struct_size = sizeof *cfg };
}

fap_err fap_take_create(fap_take **take, uint32_t point_count, uint32_t frame_count,
                        const fap_allocator *alloc)
{
    const fap_allocator a = fap_mem_allocator(alloc);

    *take = NULL;
    if (!point_count || !frame_count)
        return FAP_E_ARG;
    const uint64_t samples = (uint64_t)point_count * frame_count;
    if (point_count > FAP_TAKE_MAX_POINTS || samples > FAP_TAKE_MAX_SAMPLES)
        return FAP_E_LIMIT;
    fap_take *t = fap_mem_calloc(&a, 1, sizeof *t);
    if (!t)
        return FAP_E_NOMEM;
    t->format = "";
    t->alloc = a;
    t->first_frame = 1;
    t->mm_per_unit = 1;
    t->unit_known = 1;
    t->point_count = point_count;
    t->frame_count = frame_count;
    t->name = fap_mem_calloc(&a, point_count, sizeof *t->name);
    t->xyz = fap_mem_calloc(&a, samples, sizeof *t->xyz);
    t->valid = fap_mem_calloc(&a, samples, 1);
    if (!t->name || !t->xyz || !t->valid) {
        fap_take_close(&t);
        return FAP_E_NOMEM;
    }
    *take = t;
    return FAP_OK;
}

void fap_take_close(fap_take **take)
{
    fap_take *t = *take;

    if (!t)
        return;
    const fap_allocator a = t->alloc;
    fap_mem_free(&a, t->name);
    fap_mem_free(&a, t->xyz);
    fap_mem_free(&a, t->valid);
    fap_mem_free(&a, t);
    *take = NULL;
}

static size_t sample_index(const fap_take *take, uint32_t frame, uint32_t point)
{
    return (size_t)frame * take->point_count + point;
}

const float *fap_take_sample(const fap_take *take, uint32_t frame, uint32_t point)
{
    const size_t i = sample_index(take, frame, point);
    return take->valid[i] ? take->xyz[i] : NULL;
}

static int is_coordinate(float v)
{
    return isfinite(v) && fabsf(v) < coordinate_limit;
}

void fap_take_set(fap_take *take, uint32_t frame, uint32_t point, const float xyz_mm[3])
{
    const size_t i = sample_index(take, frame, point);

    take->valid[i] = is_coordinate(xyz_mm[0]) && is_coordinate(xyz_mm[1]) && is_coordinate(xyz_mm[2]);
    for (int axis = 0; axis < 3; axis++)
        take->xyz[i][axis] = take->valid[i] ? xyz_mm[axis] : 0;
}

static int lower(int c)
{
    return c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c;
}

static int same_name(const char *a, const char *b)
{
    while (*a && lower(*a) == lower(*b))
        a++, b++;
    return lower(*a) == lower(*b);
}

int fap_take_find(const fap_take *take, const char *name)
{
    for (uint32_t p = 0; p < take->point_count; p++)
        if (same_name(take->name[p], name))
            return (int)p;
    for (uint32_t p = 0; p < take->point_count; p++) {
        const char *colon = strrchr(take->name[p], ':');
        if (colon && same_name(colon + 1, name))
            return (int)p;
    }
    return -1;
}

double fap_take_unit_mm(const char *unit)
{
    static const struct {
        const char *start;
        double mm;
    } units[] = { { "mm", 1 },   { "milli", 1 },  { "cm", 10 },  { "centi", 10 },
                  { "dm", 100 }, { "met", 1000 }, { "in", 25.4 } };
    char text[8] = "";

    while (*unit == ' ')
        unit++;
    for (size_t i = 0; i + 1 < sizeof text && unit[i] && unit[i] != ' '; i++)
        text[i] = (char)lower(unit[i]);
    if (!strcmp(text, "m"))
        return 1000;
    for (size_t i = 0; i < sizeof units / sizeof *units; i++)
        if (!strncmp(text, units[i].start, strlen(units[i].start)))
            return units[i].mm;
    return 0;
}

/* --- helpers of the drivers --- */

fap_err take_fail(take_source *src, fap_err err, const char *fmt, ...)
{
    va_list args;
    va_start(args, fmt);
    vsnprintf(src->where, sizeof src->where, fmt, args);
    va_end(args);
    return err;
}

void take_note(fap_take *take, const char *fmt, ...)
{
    if (take->note_count == FAP_TAKE_MAX_NOTES)
        return;
    va_list args;
    va_start(args, fmt);
    vsnprintf(take->note[take->note_count++], FAP_TAKE_NOTE_SIZE, fmt, args);
    va_end(args);
}

static int is_padding(char c)
{
    return c == ' ' || c == '\t' || c == '\0' || c == '\r';
}

void take_set_name(fap_take *take, uint32_t point, const char *text, size_t length)
{
    char *name = take->name[point];

    while (length && is_padding(text[0]))
        text++, length--;
    while (length && is_padding(text[length - 1]))
        length--;
    if (length >= FAP_TAKE_NAME_SIZE)
        length = FAP_TAKE_NAME_SIZE - 1;
    for (size_t i = 0; i < length; i++)
        name[i] = (unsigned char)text[i] < ' ' || text[i] == 127 ? '_' : text[i];
    name[length] = '\0';
}

static int earlier_use(const fap_take *take, uint32_t point)
{
    for (uint32_t p = 0; p < point; p++)
        if (same_name(take->name[p], take->name[point]))
            return 1;
    return 0;
}

/* A few tries, then the point's number: a file with thousands of equal names must not cost their cube. */
static void make_unique(fap_take *take, uint32_t point)
{
    enum { TRIES = 9 };
    char base[FAP_TAKE_NAME_SIZE - 16];

    memcpy(base, take->name[point], sizeof base);
    base[sizeof base - 1] = '\0';
    for (unsigned n = 2; n <= TRIES && earlier_use(take, point); n++)
        snprintf(take->name[point], FAP_TAKE_NAME_SIZE, "%s_%u", base, n);
    if (earlier_use(take, point))
        snprintf(take->name[point], FAP_TAKE_NAME_SIZE, "%s_p%u", base, (unsigned)point + 1);
}

void take_finish_names(fap_take *take)
{
    unsigned repeated = 0, empty = 0;

    for (uint32_t p = 0; p < take->point_count; p++) {
        if (!*take->name[p]) {
            snprintf(take->name[p], FAP_TAKE_NAME_SIZE, "M%03u", (unsigned)p + 1);
            empty++;
        }
        if (earlier_use(take, p)) {
            make_unique(take, p);
            repeated++;
        }
    }
    if (empty)
        take_note(take, "%u points have no name; they are called M001 and so on", empty);
    if (repeated)
        take_note(take, "%u names repeat; they got _2, _3 ...", repeated);
}

static int is_zero(const float v[3])
{
    return v[0] == 0 && v[1] == 0 && v[2] == 0;
}

/* Valid samples of a point that are exactly 0,0,0. */
static uint32_t count_zeros(const fap_take *take, uint32_t point)
{
    uint32_t zeros = 0;

    for (uint32_t f = 0; f < take->frame_count; f++) {
        const float *v = fap_take_sample(take, f, point);
        zeros += v && is_zero(v);
    }
    return zeros;
}

static void drop_point_zeros(fap_take *take, uint32_t point)
{
    for (uint32_t f = 0; f < take->frame_count; f++) {
        const size_t i = sample_index(take, f, point);
        if (is_zero(take->xyz[i]))
            take->valid[i] = 0;
    }
}

void take_drop_zeros(fap_take *take)
{
    uint32_t always = 0, dropped = 0;

    for (uint32_t p = 0; p < take->point_count; p++)
        always += count_zeros(take, p) == take->frame_count;
    for (uint32_t p = 0; p < take->point_count; p++) {
        const uint32_t zeros = count_zeros(take, p);
        if (!zeros || (zeros == take->frame_count && always == 1 && take->frame_count > 1))
            continue;
        drop_point_zeros(take, p);
        dropped += zeros;
    }
    if (dropped)
        take_note(take, "%u samples are exactly 0,0,0 and count as missing", (unsigned)dropped);
}

/* --- reading --- */

static const take_driver *sniff(const uint8_t *data, size_t size)
{
    const take_driver *best = NULL;
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

static uint32_t count_valid(const fap_take *take, uint32_t frame)
{
    uint32_t n = 0;

    for (uint32_t p = 0; p < take->point_count; p++)
        n += take->valid[sample_index(take, frame, p)];
    return n;
}

/* The frame with the most points, the first of them. */
static uint32_t fullest_frame(const fap_take *take)
{
    uint32_t best = 0, most = 0;

    for (uint32_t f = 0; f < take->frame_count; f++) {
        const uint32_t n = count_valid(take, f);
        if (n > most) {
            most = n;
            best = f;
        }
    }
    return best;
}

/* The longest side of the box around the points of the fullest frame. */
static double spread(const fap_take *take)
{
    const uint32_t frame = fullest_frame(take);
    double longest = 0;

    for (int axis = 0; axis < 3; axis++) {
        double low = INFINITY, high = -INFINITY;
        for (uint32_t p = 0; p < take->point_count; p++) {
            const float *v = fap_take_sample(take, frame, p);
            if (!v)
                continue;
            low = fmin(low, v[axis]);
            high = fmax(high, v[axis]);
        }
        longest = fmax(longest, high - low);
    }
    return longest;
}

/* A face is 100 to 300 mm across. What fits no unit is scaled to a face: FAPs are ratios, so only reports
 * suffer. */
static double guess_unit(fap_take *take)
{
    static const double typical_mm = 170;
    const double s = spread(take);

    if (!(s > 0))
        return 1;
    const int has_unit = take->mm_per_unit >= 0;
    const double mm = !has_unit                ? typical_mm / s
                      : s > 50 && s < 5000     ? 1
                      : s >= 5 && s <= 50      ? 10
                      : s >= 0.05 && s <= 0.35 ? 1000
                                               : typical_mm / s;
    take_note(take, "no unit in the file; the points are %.4g across, so one unit is taken as %.4g mm", s,
              mm);
    return mm;
}

static void scale_samples(fap_take *take, double factor)
{
    const size_t samples = sample_index(take, take->frame_count, 0);

    for (size_t i = 0; i < samples; i++)
        for (int axis = 0; axis < 3; axis++) {
            take->xyz[i][axis] = (float)(take->xyz[i][axis] * factor);
            if (!is_coordinate(take->xyz[i][axis]))
                take->valid[i] = 0;
        }
}

static void settle_unit(fap_take *take, double user_mm)
{
    take->unit_known = user_mm > 0 || take->mm_per_unit > 0;
    if (user_mm > 0)
        take->mm_per_unit = user_mm;
    else if (!(take->mm_per_unit > 0))
        take->mm_per_unit = guess_unit(take);
    if (take->mm_per_unit != 1)
        scale_samples(take, take->mm_per_unit);
}

static void settle_rate(fap_take *take, double user_hz)
{
    static const double slowest_hz = 0.5, fastest_hz = 20000;

    if (user_hz > 0)
        take->rate_hz = user_hz;
    if (take->rate_hz != 0 && !(take->rate_hz >= slowest_hz && take->rate_hz <= fastest_hz)) {
        take_note(take, "a rate of %g frames a second is not believed", take->rate_hz);
        take->rate_hz = 0;
    }
}

/* A take without a single sample: the names say whether it is the wrong file or an empty one. */
static fap_err fail_empty(take_source *src, const take_driver *driver, const fap_take *take)
{
    char names[128] = "";

    for (uint32_t p = 0; p < take->point_count; p++) {
        const size_t used = strlen(names);
        if (used + FAP_TAKE_NAME_SIZE + 4 > sizeof names)
            break;
        snprintf(names + used, sizeof names - used, "%s%s", p ? ", " : "", take->name[p]);
    }
    return take_fail(src, FAP_E_NOT_FOUND, "%s: all %u frames of all %u points are missing (%s ...)",
                     driver->name, (unsigned)take->frame_count, (unsigned)take->point_count, names);
}

static fap_err read_with(const take_driver *driver, take_source *src, const fap_take_config *cfg,
                         fap_take **take)
{
    const fap_err err = driver->read(src, take);

    if (err != FAP_OK) {
        if (*take)
            fap_take_close(take);
        return err;
    }
    fap_take *t = *take;
    t->format = driver->name;
    if (!count_valid(t, fullest_frame(t))) {
        const fap_err empty = fail_empty(src, driver, t);
        fap_take_close(take);
        return empty;
    }
    settle_rate(t, cfg->rate_hz);
    settle_unit(t, cfg->mm_per_unit);
    return FAP_OK;
}

fap_err fap_take_read(fap_take **take, const void *data, size_t size, const fap_take_config *cfg, char *where)
{
    fap_take_config defaults;

    *take = NULL;
    if (where)
        *where = '\0';
    fap_take_config_init(&defaults);
    if (!cfg)
        cfg = &defaults;
    take_source src = { .data = data, .size = size, .alloc = fap_mem_allocator(&cfg->alloc) };
    const take_driver *driver = sniff(data, size);
    const fap_err err = driver ? read_with(driver, &src, cfg, take)
                               : take_fail(&src, FAP_E_UNKNOWN_FORMAT,
                                           "neither C3D, TRC, Nexus CSV, Motive CSV, OpenFace CSV, EMA "
                                           "(.pos, .mat), landmarks as JSON nor a table with NAME_x, NAME_y, "
                                           "NAME_z columns");
    if (err != FAP_OK && where)
        memcpy(where, src.where, sizeof src.where);
    return err;
}
