/* SPDX-License-Identifier: BSD-2-Clause */
/* See map.h. */
#include <stdlib.h>
#include <string.h>

#include <fap/face.h>

#include "base/mem.h"
#include "encoder/plot/map.h"
#include "player/render/renderer.h"

enum { FACE_PX = 590, MANY_MARKERS = 70, TEXT_PX = 10 };

/* A name's place on the sheet, so that the next one finds another. */
typedef struct box {
    double x, y, width, height;
} box;

typedef struct map {
    canvas *c;
    const plot_content *p;
    renderer *renderer;
    image face;
    float *position, *normal;
    double (*dot)[2]; /* where the markers are on the sheet */
    uint8_t *seen;    /* 1: in front of the camera */
    box *taken;
    int taken_count;
} map;

static const struct {
    uint32_t rgb;
    const char *meaning;
} roles[PLOT_ROLE_COUNT] = {
    [PLOT_MOVES] = { 0x0b8a3e, "on a feature point" },
    [PLOT_NEAR] = { 0xd98e04, "near a feature point" },
    [PLOT_RIGID] = { 0x1f5fd0, "follows the head" },
    [PLOT_IDLE] = { 0x8a8a8a, "carries no FAP" },
};

static fap_err pose_neutral(map *m)
{
    const fap_allocator heap = fap_mem_allocator(NULL);
    const fap_frame still = { .number = 0 };
    fap_face *face;
    const fap_err err = fap_face_open(&face, m->p->bank, NULL);

    if (err != FAP_OK)
        return err;
    m->position = fap_mem_calloc_aligned(&heap, 3 * fap_face_stride(face), sizeof *m->position);
    m->normal = fap_mem_calloc_aligned(&heap, 3 * fap_face_stride(face), sizeof *m->normal);
    if (m->position && m->normal)
        fap_face_pose(face, &still, m->position, m->normal);
    fap_face_close(&face);
    return m->position && m->normal ? FAP_OK : FAP_E_NOMEM;
}

static fap_err make_room(map *m, char *where)
{
    const size_t markers = (size_t)m->p->marker_count + 1;

    m->dot = calloc(markers, sizeof *m->dot);
    m->seen = calloc(markers, 1);
    m->taken = calloc(markers, sizeof *m->taken);
    if (!m->dot || !m->seen || !m->taken)
        return FAP_E_NOMEM;
    fap_err err = pose_neutral(m);
    if (err == FAP_OK)
        err = image_create(&m->face, FACE_PX, FACE_PX);
    if (err == FAP_OK)
        err = renderer_create(&m->renderer, NULL, m->p->bank, FACE_PX, FACE_PX, where);
    return err;
}

static void tidy(map *m)
{
    const fap_allocator heap = fap_mem_allocator(NULL);

    renderer_destroy(&m->renderer);
    image_free(&m->face);
    fap_mem_free_aligned(&heap, m->position);
    fap_mem_free_aligned(&heap, m->normal);
    free(m->dot);
    free(m->seen);
    free(m->taken);
}

/* --- names --- */

static int overlap(const box *a, const box *b)
{
    return a->x < b->x + b->width && b->x < a->x + a->width && a->y < b->y + b->height &&
           b->y < a->y + a->height;
}

static int is_free(const map *m, const box *b)
{
    for (int i = 0; i < m->taken_count; i++)
        if (overlap(b, &m->taken[i]))
            return 0;
    for (int i = 0; i < m->p->marker_count; i++) {
        const box dot = { m->dot[i][0] - 3, m->dot[i][1] - 3, 6, 6 };
        if (m->seen[i] && overlap(b, &dot))
            return 0;
    }
    return 1;
}

/* Beside its dot, on the first side that is free; nowhere when none is. */
static void draw_label(map *m, int i)
{
    const plot_marker *k = &m->p->marker[i];
    const double w = canvas_text_width(m->c, TEXT_PX, k->label), x = m->dot[i][0], y = m->dot[i][1];
    const box places[] = {
        { x + 6, y - 5, w, TEXT_PX },      { x - 6 - w, y - 5, w, TEXT_PX },
        { x - w / 2, y - 17, w, TEXT_PX }, { x - w / 2, y + 7, w, TEXT_PX },
        { x + 5, y - 15, w, TEXT_PX },     { x + 5, y + 5, w, TEXT_PX },
        { x - 5 - w, y - 15, w, TEXT_PX }, { x - 5 - w, y + 5, w, TEXT_PX },
    };

    for (size_t at = 0; at < sizeof places / sizeof *places; at++) {
        const box b = places[at];
        if (!is_free(m, &b))
            continue;
        m->taken[m->taken_count++] = b;
        canvas_colour(m->c, 0xffffff, 0.6);
        canvas_box(m->c, b.x - 1, b.y - 1, b.width + 2, b.height + 3);
        canvas_colour(m->c, 0x111111, 1);
        canvas_text(m->c, b.x, b.y + TEXT_PX - 1, TEXT_PX, CANVAS_LEFT, k->label);
        return;
    }
}

/* Hundreds of landmarks would hide each other's names: then those that move something have them. */
static int wants_label(const plot_content *p, int i)
{
    return p->marker_count <= MANY_MARKERS || p->marker[i].role <= PLOT_NEAR;
}

/* --- a view --- */

static void draw_dots(map *m)
{
    for (int role = PLOT_ROLE_COUNT - 1; role >= 0; role--)
        for (int i = 0; i < m->p->marker_count; i++) {
            if (!m->seen[i] || (int)m->p->marker[i].role != role)
                continue;
            canvas_colour(m->c, 0xffffff, 1);
            canvas_disc(m->c, m->dot[i][0], m->dot[i][1], 5);
            canvas_colour(m->c, roles[role].rgb, 1);
            canvas_disc(m->c, m->dot[i][0], m->dot[i][1], 4);
        }
}

static void place_dots(map *m, const render_view *view, double x, double y)
{
    for (int i = 0; i < m->p->marker_count; i++) {
        float pixel[3];
        m->seen[i] = (uint8_t)renderer_project(m->renderer, view, m->p->marker[i].place_mm, pixel);
        m->seen[i] &= pixel[0] >= 0 && pixel[0] < FACE_PX && pixel[1] >= 0 && pixel[1] < FACE_PX;
        m->dot[i][0] = x + (double)pixel[0];
        m->dot[i][1] = y + (double)pixel[1];
    }
}

static fap_err draw_view(map *m, render_camera camera, double x, double y)
{
    render_view view = render_view_of(camera);
    view.distance *= 0.8F; /* the face, not its neck */
    const render_scene scene = { .position = m->position, .normal = m->normal, .view = view };
    const fap_err err = renderer_draw(m->renderer, &scene, &m->face);

    if (err != FAP_OK)
        return err;
    canvas_picture(m->c, x, y, m->face.rgba, FACE_PX, FACE_PX);
    place_dots(m, &view, x, y);
    draw_dots(m);
    m->taken_count = 0;
    for (int i = 0; i < m->p->marker_count; i++)
        if (m->seen[i] && wants_label(m->p, i))
            draw_label(m, i);
    return FAP_OK;
}

static void draw_key(map *m, double x, double y)
{
    for (int role = 0; role < PLOT_ROLE_COUNT; role++) {
        canvas_colour(m->c, roles[role].rgb, 1);
        canvas_disc(m->c, x, y - 4, 4);
        canvas_colour(m->c, 0x222222, 1);
        canvas_text(m->c, x + 10, y, 11, CANVAS_LEFT, roles[role].meaning);
        x += 170;
    }
}

fap_err map_draw(canvas *c, const plot_content *p, double y, int width, char *where)
{
    map m = { .c = c, .p = p };
    const double margin = (width - 2 * FACE_PX) / 3.0;

    fap_err err = make_room(&m, where);
    if (err == FAP_OK)
        err = draw_view(&m, CAMERA_FRONT, margin, y);
    if (err == FAP_OK)
        err = draw_view(&m, CAMERA_THREE_QUARTER, 2 * margin + FACE_PX, y);
    if (err == FAP_OK)
        draw_key(&m, margin + 4, y + FACE_PX + 22);
    tidy(&m);
    return err;
}
