/* SPDX-License-Identifier: BSD-2-Clause */
/* See film.h. The face is any bank's; it talks by sines. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <fap/derive.h>
#include <fap/face.h>
#include <fap/tables.h>

#include "film.h"
#include "raster.h"
#include "track/vector.h"

enum { RULER_A = FILM_DOTS - 2, RULER_B = FILM_DOTS - 1, MAX_SAMPLES = 16 };

static const double pi = 3.14159265358979323846;
/* Seen so much from the side, a dot is a line, and nobody would click on it. */
static const double thinnest = 0.2;

/* About as in the paper: 50 dots on the face and lips, and those at the ears for the head. */
static const char *const dot_name[FILM_DOTS] = {
    "4.1",  "4.2",  "4.3",  "4.4",  "4.5",  "4.6", "11.1", "11.2", "11.3",    "5.1",     "5.2",
    "5.3",  "5.4",  "9.1",  "9.2",  "9.3",  "9.4", "9.5",  "9.6",  "9.7",     "9.12",    "9.13",
    "9.14", "8.1",  "8.2",  "8.3",  "8.4",  "8.5", "8.6",  "8.7",  "8.8",     "8.9",     "8.10",
    "2.10", "2.11", "2.12", "2.13", "2.14", "3.7", "3.8",  "3.9",  "3.10",    "3.11",    "3.12",
    "3.13", "3.14", "10.5", "10.6", "9.15", "F1",  "F2",   "F3",   "ruler A", "ruler B",
};
enum { PAINTS = 4 };
static const uint8_t paint[PAINTS][3] = {
    { 20, 60, 190 }, { 20, 130, 60 }, { 20, 165, 185 }, { 110, 20, 140 }
};

typedef struct rng {
    uint32_t state;
} rng;

struct film {
    film_config cfg;
    const fap_bank *bank;
    fap_face *face;
    float *position, *normal;
    float (*corner)[3], (*colour)[3]; /* per vertex: camera millimetres, lit colour */
    uint32_t vertex[FILM_DOTS];
    uint8_t paint[FILM_DOTS]; /* its colour */
    raster canvas;
    fap_mirror_plane mirror[FAP_MIRROR_MAX];
    double glass[FAP_MIRROR_MAX][3], half[FAP_MIRROR_MAX][2][3];
    uint32_t *sum;
    rng noise;
};

void film_config_init(film_config *cfg)
{
    *cfg = (film_config){ .width_px = 640,
                          .height_px = 480,
                          .rate_hz = 30,
                          .seconds = 3,
                          .dot_mm = 3,
                          .mirrors = 2,
                          .samples = 6,
                          .ruler_mm = 100,
                          .swiftness = 1,
                          .seed = 1 };
}

/* --- the set --- */

enum { FACE_AWAY_MM = 800 };
/* The middle of a head of these axes. */
static const double head_middle[3] = { 0, 15, 75 };

/* The person faces the camera: its x is the camera's, y and z are the other way round. */
static void to_camera(const double head[3], double place[3])
{
    place[0] = head[0] - head_middle[0];
    place[1] = head_middle[1] - head[1];
    place[2] = FACE_AWAY_MM + head_middle[2] - head[2];
}

static void rotate_to_camera(const double head[3], double out[3])
{
    out[0] = head[0];
    out[1] = -head[1];
    out[2] = -head[2];
}

/* Beside a cheek, so that the lens sees the face in it from some sixty degrees aside. Nobody hangs mirrors quite alike. */
static void hang_mirror(film *f, int i)
{
    const double side = i ? 1 : -1, angle = (i ? 62.5 : 63.5) * pi / 180;
    const double through[3] = { side * (i ? 133.0 : 136.0), 0, FACE_AWAY_MM };
    fap_mirror_plane *m = &f->mirror[i];
    double up[3] = { 0, 1, 0 }, along[3];

    memcpy(m->normal, (const double[3]){ -side * sin(angle), i ? -0.03 : 0.02, -cos(angle) },
           sizeof m->normal);
    unit3(m->normal);
    m->distance = dot3(m->normal, through);
    cross3(m->normal, up, along);
    unit3(along);
    cross3(along, m->normal, up);
    memcpy(f->glass[i], through, sizeof through);
    add_scaled3(f->glass[i], along, along[2] > 0 ? -52 : 52);
    for (int k = 0; k < 3; k++) {
        f->half[i][0][k] = 116 * along[k];
        f->half[i][1][k] = 165 * up[k];
    }
}

static void set_camera(film *f, fap_camera *cam)
{
    const int w = f->cfg.width_px, h = f->cfg.height_px;
    const double focal = 0.5 * w / 0.345;

    /* No lens sits exactly over the middle. */
    *cam = (fap_camera){ w, h, focal, focal, 0.505 * (w - 1), 0.497 * (h - 1), { 0 } };
}

static int dot_vertex(const fap_bank *bank, const char *name, uint32_t *vertex)
{
    const fap_bank_point *at = fap_bank_point_get(bank, fap_point_by_name(name));

    if (!at || !at->present || !at->vertex_count)
        return 0;
    *vertex = at->vertex[0];
    return 1;
}

/* The forehead has more dots than the standard has points there: the nearest of the skin's vertices as seen from the front. */
static uint32_t forehead_vertex(const fap_mesh *mesh, double x, double y)
{
    const float *p = mesh->position;
    double least = INFINITY;
    uint32_t found = 0;

    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        const double dx = (double)p[v] - x, dy = (double)p[mesh->stride + v] - y, far = dx * dx + dy * dy;
        if (mesh->part[v] != FAP_PART_SKIN || p[2 * mesh->stride + v] < 50 || far >= least)
            continue;
        least = far;
        found = v;
    }
    return found;
}

static int place_dots(film *f)
{
    static const double x[3] = { 28, -28, 0 };

    for (int i = 0; i < RULER_A; i++) {
        const char *name = dot_name[i];
        if (*name == 'F')
            f->vertex[i] = forehead_vertex(fap_bank_mesh(f->bank), x[name[1] - '1'], 75);
        else if (!dot_vertex(f->bank, name, &f->vertex[i]))
            return 0;
    }
    return 1;
}

/* How far the nearest dot of that colour is among the first @count, in the neutral face. */
static double nearest_of(const film *f, int count, int dot, int colour)
{
    const fap_mesh *mesh = fap_bank_mesh(f->bank);
    double least = INFINITY;

    for (int i = 0; i < count; i++) {
        double far = 0;
        for (uint32_t k = 0; k < 3; k++) {
            const double a = (double)mesh->position[k * mesh->stride + f->vertex[i]],
                         b = (double)mesh->position[k * mesh->stride + f->vertex[dot]];
            far += (a - b) * (a - b);
        }
        if (f->paint[i] == colour)
            least = fmin(least, far);
    }
    return least;
}

/* Neighbours differ. */
static void paint_dots(film *f)
{
    for (int i = 0; i < RULER_A; i++)
        for (int colour = 1; colour < PAINTS && !f->cfg.one_colour; colour++)
            if (nearest_of(f, i, i, colour) > nearest_of(f, i, i, f->paint[i]))
                f->paint[i] = (uint8_t)colour;
    f->paint[RULER_B] = 1;
}

static int allocate(film *f, const fap_camera *cam)
{
    const fap_mesh *mesh = fap_bank_mesh(f->bank);
    const size_t row = mesh->stride * sizeof(float);

    f->position = aligned_alloc(32, 3 * row);
    f->normal = aligned_alloc(32, 3 * row);
    f->corner = malloc(3 * row);
    f->colour = malloc(3 * row);
    f->sum = malloc(3 * sizeof *f->sum * (size_t)cam->width_px * (size_t)cam->height_px);
    return raster_make(&f->canvas, cam) && f->position && f->normal && f->corner && f->colour && f->sum;
}

film *film_open(const film_config *cfg, const fap_bank *bank)
{
    film *f = calloc(1, sizeof *f);
    fap_face_config face;
    fap_camera cam;

    if (!f)
        return NULL;
    f->cfg = *cfg;
    f->bank = bank;
    f->noise.state = 2463534242U ^ cfg->seed * 2654435761U;
    set_camera(f, &cam);
    for (int i = 0; i < FAP_MIRROR_MAX; i++)
        hang_mirror(f, i);
    fap_face_config_init(&face);
    face.blend = FAP_BLEND_QP;
    if (!place_dots(f) || !allocate(f, &cam) || fap_face_open(&f->face, bank, &face) != FAP_OK)
        film_close(&f);
    if (f)
        paint_dots(f);
    return f;
}

void film_close(film **f)
{
    if (!*f)
        return;
    raster_free(&(*f)->canvas);
    fap_face_close(&(*f)->face);
    free((*f)->position);
    free((*f)->normal);
    free((*f)->corner);
    free((*f)->colour);
    free((*f)->sum);
    free(*f);
    *f = NULL;
}

const fap_camera *film_camera(const film *f)
{
    return &f->canvas.camera;
}

const fap_mirror_plane *film_mirror(const film *f)
{
    return f->mirror;
}

int film_frames(const film *f)
{
    return (int)lrint(f->cfg.rate_hz * f->cfg.seconds);
}

const char *film_dot_name(int dot)
{
    return dot_name[dot];
}

/* --- motion --- */

static void say(fap_frame *frame, int fap, double value)
{
    frame->state[fap] = FAP_CODED;
    frame->value[fap] = (int32_t)lrint(value);
}

/* From rest at the start: the first picture shows the neutral face. */
static void talk(double at_s, double swiftness, fap_frame *frame)
{
    const double t = 2 * pi * at_s * swiftness, open = 0.5 - 0.5 * cos(2.3 * t);

    *frame = (fap_frame){ .pts_us = (int64_t)(1e6 * at_s) };
    say(frame, 3, 300 * open * (0.7 + 0.3 * cos(0.6 * t)));
    say(frame, 6, 110 * sin(1.1 * t));
    say(frame, 7, 110 * sin(1.1 * t));
    say(frame, 4, -90 * open);
    say(frame, 5, -60 * open);
    say(frame, 31, 120 * sin(0.4 * t));
    say(frame, 32, 120 * sin(0.4 * t));
    say(frame, 33, 160 * sin(0.4 * t));
    say(frame, 34, 160 * sin(0.4 * t));
    say(frame, 48, 5000 * sin(0.5 * t));
    say(frame, 49, 9000 * sin(0.35 * t));
    say(frame, 50, 4000 * sin(0.3 * t));
    fap_derive(frame);
}

static void sway(double at_s, double swiftness, double shift[3])
{
    const double t = 2 * pi * at_s * swiftness;

    shift[0] = 6 * sin(0.33 * t);
    shift[1] = 3 * sin(0.5 * t);
    shift[2] = 5 * sin(0.27 * t);
}

static void vertex_of(const float *row, uint32_t stride, uint32_t v, double out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = (double)row[(uint32_t)k * stride + v];
}

static void act(film *f, double at_s)
{
    fap_frame frame;

    talk(at_s, f->cfg.swiftness, &frame);
    fap_face_pose(f->face, &frame, f->position, f->normal);
}

/* A dot's place and which way it looks, in camera axes, of what was acted last. */
static void dot_at(const film *f, int dot, double at_s, double place[3], double normal[3])
{
    const uint32_t stride = fap_bank_mesh(f->bank)->stride;
    double head[3], out[3], shift[3];

    vertex_of(f->position, stride, f->vertex[dot], head);
    vertex_of(f->normal, stride, f->vertex[dot], out);
    add_scaled3(head, out, 0.2);
    sway(at_s, f->cfg.swiftness, shift);
    add_scaled3(head, shift, 1);
    to_camera(head, place);
    rotate_to_camera(out, normal);
}

/* Held still before the throat, aslant so that its ends differ in depth. */
static void ruler_end(const film *f, int dot, double place[3])
{
    const double way[3] = { 0.8, 0.44, 0.33 }, middle[3] = { 0, 160, FACE_AWAY_MM - 60 };
    double along[3] = { way[0], way[1], way[2] };

    unit3(along);
    memcpy(place, middle, sizeof middle);
    add_scaled3(place, along, (dot == RULER_A ? -0.5 : 0.5) * f->cfg.ruler_mm);
}

static void find_pixels(const film *f, film_dot *dot)
{
    for (int view = 0; view <= f->cfg.mirrors; view++) {
        double image[3] = { dot->place[0], dot->place[1], dot->place[2] };
        if (view)
            fap_mirror_reflect(&f->mirror[view - 1], dot->place, image);
        fap_camera_project(&f->canvas.camera, image, dot->pixel[view]);
    }
}

static void dots_at(const film *f, double at_s, film_dot *dot)
{
    double normal[3];

    for (int i = 0; i < FILM_DOTS; i++) {
        dot[i] = (film_dot){ { 0 }, { { 0 } }, { 0 } };
        if (i < RULER_A)
            dot_at(f, i, at_s, dot[i].place, normal);
        else
            ruler_end(f, i, dot[i].place);
        find_pixels(f, &dot[i]);
    }
}

void film_places(film *f, double at_s, film_dot *dot)
{
    act(f, at_s);
    dots_at(f, at_s, dot);
}

/* --- light --- */

/* From above the camera, soft: the dark side still gets half. Reflections keep the light, so it is laid on before them. */
static double light_on(const double normal[3])
{
    const double lamp[3] = { 0.25, 0.45, 0.857 };

    return 0.55 + 0.45 * fmax(0, dot3(normal, lamp));
}

static void light_face(film *f, double at_s)
{
    const fap_mesh *mesh = fap_bank_mesh(f->bank);
    double shift[3];

    sway(at_s, f->cfg.swiftness, shift);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        double head[3], normal[3], place[3];
        vertex_of(f->position, mesh->stride, v, head);
        vertex_of(f->normal, mesh->stride, v, normal);
        add_scaled3(head, shift, 1);
        to_camera(head, place);
        for (int k = 0; k < 3; k++) {
            f->corner[v][k] = (float)place[k];
            f->colour[v][k] = (float)(light_on(normal) * mesh->colour[4 * v + (uint32_t)k]);
        }
    }
}

/* --- a view: the scene, or its reflection --- */

static void reflect_face(film *f, const fap_mirror_plane *m)
{
    const uint32_t count = fap_bank_mesh(f->bank)->vertex_count;

    for (uint32_t v = 0; v < count; v++) {
        const double at[3] = { (double)f->corner[v][0], (double)f->corner[v][1], (double)f->corner[v][2] };
        double image[3];
        fap_mirror_reflect(m, at, image);
        for (int k = 0; k < 3; k++)
            f->corner[v][k] = (float)image[k];
    }
}

static void draw_face(film *f)
{
    const fap_mesh *mesh = fap_bank_mesh(f->bank);

    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        float corner[3][3], colour[3][3];
        for (int i = 0; i < 3; i++) {
            const uint32_t v = mesh->triangle[3 * t + (uint32_t)i];
            memcpy(corner[i], f->corner[v], sizeof corner[i]);
            memcpy(colour[i], f->colour[v], sizeof colour[i]);
        }
        raster_triangle(&f->canvas, (const float(*)[3])corner, (const float(*)[3])colour);
    }
}

static void reflect_direction(const fap_mirror_plane *m, double way[3])
{
    add_scaled3(way, m->normal, -2 * dot3(m->normal, way));
}

static raster_cover draw_dot(film *f, const fap_mirror_plane *m, int dot, double at_s)
{
    double place[3], normal[3] = { 0 }, image[3];

    if (dot < RULER_A)
        dot_at(f, dot, at_s, place, normal);
    else
        ruler_end(f, dot, place);
    memcpy(image, place, sizeof image);
    if (m) {
        fap_mirror_reflect(m, place, image);
        reflect_direction(m, normal);
    }
    if (dot >= RULER_A)
        return raster_ball(&f->canvas, image, f->cfg.dot_mm / 2, paint[f->paint[dot]]);
    return raster_disc(&f->canvas, image, normal, f->cfg.dot_mm / 2, 1.2, paint[f->paint[dot]]);
}

/* What hides: it comes from one side and leaves on the other in the film's middle third. */
static void draw_hiding(film *f, const fap_mirror_plane *m, double at_s)
{
    static const uint8_t rgb[3] = { 150, 140, 130 };
    const double part = 3 * at_s / f->cfg.seconds - 1,
                 place[3] = { 130 - 260 * part, 45, FACE_AWAY_MM - 110 };
    double image[3] = { place[0], place[1], place[2] };

    if (!f->cfg.hides || part < 0 || part > 1)
        return;
    if (m)
        fap_mirror_reflect(m, place, image);
    raster_ball(&f->canvas, image, 16, rgb);
}

/* Pixels of a dot that looks at the camera. */
static double whole_pixels(const film *f, const film_dot *dot)
{
    const double radius = f->canvas.camera.fx_px * f->cfg.dot_mm / 2 / dot->place[2];

    return pi * radius * radius;
}

/* @share: what one picture adds to how much of a dot is shown. */
static void draw_view(film *f, int view, double at_s, double share, film_dot *dot)
{
    const fap_mirror_plane *m = view ? &f->mirror[view - 1] : NULL;

    f->canvas.drawing = view;
    draw_face(f);
    draw_hiding(f, m, at_s);
    for (int i = 0; i < FILM_DOTS; i++) {
        const raster_cover cover = draw_dot(f, m, i, at_s);
        if (dot && cover.pixels > thinnest * whole_pixels(f, &dot[i]))
            dot[i].shown[view] += share * cover.seen / cover.pixels;
    }
}

/* Everything is drawn before the glass, then what the glass shows. */
static void draw_once(film *f, double at_s, double share, film_dot *dot)
{
    static const uint8_t wall[3] = { 58, 62, 70 }, glass[3] = { 74, 78, 84 };

    act(f, at_s);
    raster_clear(&f->canvas, wall);
    light_face(f, at_s);
    draw_view(f, 0, at_s, share, dot);
    for (int i = 0; i < f->cfg.mirrors; i++)
        raster_mirror(&f->canvas, f->glass[i], (const double(*)[3])f->half[i], 1 + i, glass);
    for (int i = 0; i < f->cfg.mirrors; i++) {
        reflect_face(f, &f->mirror[i]);
        draw_view(f, 1 + i, at_s, share, dot);
        reflect_face(f, &f->mirror[i]);
    }
}

/* --- exposure --- */

/* Spread evenly over a pixel whatever their number (Roberts 2018, R2), in pairs opposite each other: the mean is the middle. */
static void spread(int sample, int samples, double shift_px[2])
{
    const int pair = sample / 2 + 1, side = sample % 2 ? -1 : 1,
              alone = sample % 2 == 0 && sample == samples - 1;

    shift_px[0] = alone ? 0 : side * (fmod(0.5 + 0.7548776662466927 * pair, 1) - 0.5);
    shift_px[1] = alone ? 0 : side * (fmod(0.5 + 0.5698402909980532 * pair, 1) - 0.5);
}

static void expose(film *f, double at_s, film_dot *dot)
{
    const size_t count = 3 * (size_t)f->cfg.width_px * (size_t)f->cfg.height_px;
    const int samples = f->cfg.samples < 1 ? 1 : f->cfg.samples > MAX_SAMPLES ? MAX_SAMPLES : f->cfg.samples;

    memset(f->sum, 0, count * sizeof *f->sum);
    for (int s = 0; s < samples; s++) {
        const double part = samples > 1 ? (double)s / (samples - 1) - 0.5 : 0;
        spread(s, samples, f->canvas.shift_px);
        draw_once(f, at_s + part * f->cfg.shutter / f->cfg.rate_hz, 1.0 / samples, dot);
        for (size_t i = 0; i < count; i++)
            f->sum[i] += f->canvas.rgb[i];
    }
    for (size_t i = 0; i < count; i++)
        f->sum[i] /= (uint32_t)samples;
}

static double evenly(rng *r)
{
    r->state ^= r->state << 13;
    r->state ^= r->state >> 17;
    r->state ^= r->state << 5;
    return (r->state + 0.5) / 4294967296.0;
}

/* Four evenly spread numbers added are near enough to a normal one for pixels. */
static double noise(rng *r)
{
    return (evenly(r) + evenly(r) + evenly(r) + evenly(r) - 2) * 1.7320508;
}

static uint8_t grain(film *f, uint32_t value)
{
    const double v = value + f->cfg.noise * noise(&f->noise) + 0.5;

    return v < 0 ? 0 : v > 255 ? 255 : (uint8_t)v;
}

static void copy_rows(film *f, int first, int step, uint8_t *rgb)
{
    const size_t row = 3 * (size_t)f->cfg.width_px;

    for (int y = first; y < f->cfg.height_px; y += step)
        for (size_t i = 0; i < row; i++) {
            const size_t at = (size_t)y * row + i;
            rgb[at] = f->cfg.noise > 0 ? grain(f, f->sum[at]) : (uint8_t)f->sum[at];
        }
}

void film_draw(film *f, int frame, uint8_t *rgb, film_dot *dot)
{
    const double at_s = frame / f->cfg.rate_hz;

    if (dot)
        film_places(f, at_s, dot);
    expose(f, at_s, dot);
    copy_rows(f, 0, f->cfg.interlaced ? 2 : 1, rgb);
    if (!f->cfg.interlaced)
        return;
    expose(f, at_s + 0.5 / f->cfg.rate_hz, NULL);
    copy_rows(f, 1, 2, rgb);
}
