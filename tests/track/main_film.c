/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * mirror-film OPTIONS OUT: makes a film of a talking face with dots between mirrors, and everything that is known of it:
 * OUT.y4m, OUT.csv (where the dots are in the first picture), OUT.json (the camera), OUT.c3d (the truth, in the head's axes). For tests of
 * "fapenc track"; no part of the product.
 */
#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <fap/studio/take.h>

#include "common/bank_file.h"
#include "common/file.h"
#include "common/json.h"
#include "film.h"

enum { PATH_SIZE = 512 };

typedef struct options {
    film_config film;
    const char *bank, *out;
    double click_px; /* how far beside a dot a person clicks */
} options;

/* --- options --- */

static const struct option long_options[] = {
    { "bank", 1, NULL, 'b' },    { "size", 1, NULL, 's' },       { "fps", 1, NULL, 'f' },
    { "seconds", 1, NULL, 't' }, { "dot", 1, NULL, 'd' },        { "mirrors", 1, NULL, 'm' },
    { "samples", 1, NULL, 'n' }, { "blur", 1, NULL, 'B' },       { "noise", 1, NULL, 'N' },
    { "hide", 0, NULL, 'h' },    { "one-colour", 0, NULL, 'o' }, { "interlaced", 0, NULL, 'i' },
    { "swift", 1, NULL, 'w' },   { "seed", 1, NULL, 'S' },       { "click", 1, NULL, 'c' },
    { NULL, 0, NULL, 0 },
};

static int set(options *o, int option, const char *value)
{
    film_config *f = &o->film;

    switch (option) {
    case 'b': o->bank = value; return 1;
    case 's': return sscanf(value, "%dx%d", &f->width_px, &f->height_px) == 2;
    case 'f': f->rate_hz = atof(value); return f->rate_hz > 0;
    case 't': f->seconds = atof(value); return f->seconds > 0;
    case 'd': f->dot_mm = atof(value); return f->dot_mm > 0;
    case 'm': f->mirrors = atoi(value); return f->mirrors >= 0 && f->mirrors <= FAP_MIRROR_MAX;
    case 'n': f->samples = atoi(value); return f->samples > 0;
    case 'B': f->shutter = atof(value); return 1;
    case 'N': f->noise = atof(value); return 1;
    case 'o': f->one_colour = 1; return 1;
    case 'h': f->hides = 1; return 1;
    case 'i': f->interlaced = 1; return 1;
    case 'w': f->swiftness = atof(value); return 1;
    case 'S': f->seed = (uint32_t)atoi(value); return 1;
    case 'c': o->click_px = atof(value); return 1;
    default: return 0;
    }
}

static int parse(options *o, int argc, char **argv)
{
    int option;

    *o = (options){ .out = NULL };
    film_config_init(&o->film);
    while ((option = getopt_long(argc, argv, "", long_options, NULL)) >= 0)
        if (!set(o, option, optarg))
            return 0;
    if (optind + 1 != argc || o->film.width_px < 16 || o->film.height_px < 16 || o->film.width_px > 4096 ||
        o->film.height_px > 4096)
        return 0;
    o->out = argv[optind];
    return 1;
}

/* --- the film --- */

static FILE *open_out(const char *out, const char *ending, out_file *file)
{
    char path[PATH_SIZE];

    snprintf(path, sizeof path, "%s%s", out, ending);
    return out_file_open(file, path) == FAP_OK ? file->stream : NULL;
}

static uint8_t byte(double v)
{
    return (uint8_t)(v < 0 ? 0 : v > 255 ? 255 : v + 0.5);
}

/* ITU-R BT.601, 16 to 235; colour as fine as light, so that dots stay as they were drawn. */
static void put_picture(const uint8_t *rgb, size_t pixels, FILE *out)
{
    static const double row[3][4] = { { 65.481, 128.553, 24.966, 16 },
                                      { -37.797, -74.203, 112, 128 },
                                      { 112, -93.786, -18.214, 128 } };

    fputs("FRAME\n", out);
    for (int plane = 0; plane < 3; plane++)
        for (size_t i = 0; i < pixels; i++) {
            const double *r = row[plane];
            const uint8_t *p = &rgb[3 * i];
            putc(byte((r[0] * p[0] + r[1] * p[1] + r[2] * p[2]) / 255 + r[3]), out);
        }
}

/* The head's axes in the middle of the picture: y up, z towards the camera. */
static void put_truth(fap_take *take, int frame, const film_dot *dot)
{
    for (uint32_t i = 0; i < FILM_DOTS; i++) {
        const float at[3] = { (float)dot[i].place[0], (float)-dot[i].place[1], (float)-dot[i].place[2] };
        fap_take_set(take, (uint32_t)frame, i, at);
    }
}

static int shoot(const options *o, film *f, fap_take *take, FILE *out)
{
    const size_t pixels = (size_t)o->film.width_px * (size_t)o->film.height_px;
    film_dot dot[FILM_DOTS];
    uint8_t *rgb = malloc(3 * pixels);

    if (!rgb)
        return 0;
    fprintf(out, "YUV4MPEG2 W%d H%d F%d:1000 I%c A1:1 C444\n", o->film.width_px, o->film.height_px,
            (int)lrint(1000 * o->film.rate_hz), o->film.interlaced ? 't' : 'p');
    for (int frame = 0; frame < film_frames(f); frame++) {
        film_draw(f, frame, rgb, dot);
        put_picture(rgb, pixels, out);
        put_truth(take, frame, dot);
    }
    free(rgb);
    return 1;
}

/* --- what is known --- */

/* Half hidden, a dot would not be clicked on. */
static int can_be_clicked(const film_dot *dot, int view)
{
    return dot->shown[view] > 0.6;
}

static int is_seen(const options *o, const film_dot *dot)
{
    int seen = 0;

    for (int view = 0; view <= o->film.mirrors; view++)
        seen += can_be_clicked(dot, view);
    return seen > 0;
}

static void put_cell(const film_dot *dot, int view, double aside_px, FILE *out)
{
    if (can_be_clicked(dot, view))
        fprintf(out, ",%.2f,%.2f", dot->pixel[view][0] + aside_px, dot->pixel[view][1] - aside_px / 2);
    else
        fputs(",,", out);
}

static void put_points(const options *o, const film_dot *dot, FILE *out)
{
    fputs("label,x,y", out);
    for (int m = 1; m <= o->film.mirrors; m++)
        fprintf(out, ",mirror%d_x,mirror%d_y", m, m);
    fputs("\n", out);
    for (int i = 0; i < FILM_DOTS; i++) {
        if (!is_seen(o, &dot[i]))
            continue;
        fputs(film_dot_name(i), out);
        for (int view = 0; view <= o->film.mirrors; view++)
            put_cell(&dot[i], view, ((i + view) % 3 - 1) * o->click_px, out);
        fputs("\n", out);
    }
}

static void put_camera(const fap_camera *c, FILE *out)
{
    json j = { .out = out };

    json_open(&j, NULL, '{');
    json_integer(&j, "width", c->width_px);
    json_integer(&j, "height", c->height_px);
    json_number(&j, "fx", c->fx_px);
    json_number(&j, "fy", c->fy_px);
    json_number(&j, "cx", c->cx_px);
    json_number(&j, "cy", c->cy_px);
    json_close(&j, '}');
}

static int write_known(const options *o, film *f, const fap_take *take)
{
    film_dot dot[FILM_DOTS];
    out_file points, camera, truth;
    uint8_t *rgb = malloc(3 * (size_t)o->film.width_px * (size_t)o->film.height_px);

    if (!rgb || !open_out(o->out, ".csv", &points) || !open_out(o->out, ".json", &camera) ||
        !open_out(o->out, ".c3d", &truth))
        return 0;
    film_draw(f, 0, rgb, dot);
    free(rgb);
    put_points(o, dot, points.stream);
    put_camera(film_camera(f), camera.stream);
    const fap_writer writer = file_writer(truth.stream);
    return fap_take_write_c3d(take, &writer, FAP_C3D_INTEL, 0) == FAP_OK &&
           out_file_commit(&points) == FAP_OK && out_file_commit(&camera) == FAP_OK &&
           out_file_commit(&truth) == FAP_OK;
}

static fap_take *make_take(const options *o, const film *f)
{
    fap_take *take = NULL;

    if (fap_take_create(&take, FILM_DOTS, (uint32_t)film_frames(f), NULL) != FAP_OK)
        return NULL;
    take->rate_hz = o->film.rate_hz;
    for (int i = 0; i < FILM_DOTS; i++)
        snprintf(take->name[i], sizeof take->name[i], "%s", film_dot_name(i));
    return take;
}

static int make(const options *o, film *f)
{
    fap_take *take = make_take(o, f);
    out_file video;
    const int made = take && open_out(o->out, ".y4m", &video) && shoot(o, f, take, video.stream) &&
                     out_file_commit(&video) == FAP_OK && write_known(o, f, take);

    fap_take_close(&take);
    return made;
}

int main(int argc, char **argv)
{
    char where[FAP_ERROR_TEXT_SIZE];
    fap_bank *bank = NULL;
    options o;

    if (!parse(&o, argc, argv)) {
        fprintf(
            stderr,
            "usage: mirror-film [--bank F.fbank] [--size WxH] [--fps R] [--seconds T] [--dot MM] [--mirrors "
            "N] "
            "[--samples N]\n [--blur SHARE] [--noise SIGMA] [--hide] [--one-colour] [--interlaced] [--swift "
            "X] [--seed N] "
            "[--click PX] OUT\n");
        return 2;
    }
    if (o.bank ? bank_file_read(&bank, o.bank, where) : fap_bank_builtin(&bank, NULL))
        return 1;
    film *f = film_open(&o.film, bank);
    const int made = f && make(&o, f);
    film_close(&f);
    fap_bank_close(&bank);
    return made ? 0 : 1;
}
