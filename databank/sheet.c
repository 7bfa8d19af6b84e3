/* SPDX-License-Identifier: BSD-2-Clause */
/* See sheet.h. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <fap/face.h>

#include "base/mem.h"
#include "common/file.h"
#include "common/tool.h"
#include "databank/sheet.h"

enum {
    LABEL_PX = 7,
    MARGIN_PX = 4,
    NEUTRAL = -1,
    FULL_LOOK = 55000 /* 1e-5 rad: an eyeLook unit fully on */
};

typedef struct sheet {
    const fap_bank *bank;
    const sheet_style *style;
    fap_face *face;
    renderer *renderer;
    image tile, whole;
    float *position, *normal, *weight;
    float *other, *other_normal; /* a second pose, for eyeballs */
    int drawn;
    progress progress;
} sheet;

static int wanted(const sheet *s, int key)
{
    return key == NEUTRAL || (fap_bank_key_get(s->bank, key)->kind == FAP_KEY_UNIT) == s->style->units;
}

static int count_wanted(const sheet *s)
{
    int count = 0;

    for (int k = NEUTRAL; k < fap_bank_key_count(s->bank); k++)
        count += wanted(s, k);
    return count;
}

static void name_of(const sheet *s, int key, char *out, size_t size)
{
    const fap_key *k = key == NEUTRAL ? NULL : fap_bank_key_get(s->bank, key);

    if (k && k->number)
        snprintf(out, size, "%d %s", k->number, k->name);
    else
        snprintf(out, size, "%s", k ? k->name : "neutral");
}

/* Keys that are gazes, and the FAPs that turn the eyeballs as far: 23 to 26, left and right. */
typedef struct gaze {
    const char *name;
    int yaw[2], pitch[2]; /* left eye, right eye: 1 is to the face's left, downwards */
} gaze;

static const gaze gazes[] = {
    { "look_left", { 1, 1 }, { 0, 0 } },        { "look_right", { -1, -1 }, { 0, 0 } },
    { "look_up", { 0, 0 }, { -1, -1 } },        { "look_down", { 0, 0 }, { 1, 1 } },
    { "eyeLookOutLeft", { 1, 0 }, { 0, 0 } },   { "eyeLookInLeft", { -1, 0 }, { 0, 0 } },
    { "eyeLookOutRight", { 0, -1 }, { 0, 0 } }, { "eyeLookInRight", { 0, 1 }, { 0, 0 } },
    { "eyeLookUpLeft", { 0, 0 }, { -1, 0 } },   { "eyeLookDownLeft", { 0, 0 }, { 1, 0 } },
    { "eyeLookUpRight", { 0, 0 }, { 0, -1 } },  { "eyeLookDownRight", { 0, 0 }, { 0, 1 } },
};

static const gaze *gaze_of(const sheet *s, int key)
{
    for (size_t i = 0; key != NEUTRAL && i < sizeof gazes / sizeof *gazes; i++)
        if (!strcmp(gazes[i].name, fap_bank_key_get(s->bank, key)->name))
            return &gazes[i];
    return NULL;
}

static fap_frame frame_of(const gaze *g)
{
    fap_frame frame = { .number = 0 };

    for (int eye = 0; eye < 2; eye++) {
        frame.state[23 + eye] = frame.state[25 + eye] = FAP_CODED;
        frame.value[23 + eye] = g->yaw[eye] * FULL_LOOK;
        frame.value[25 + eye] = g->pitch[eye] * FULL_LOOK;
    }
    return frame;
}

static void swap(float **a, float **b)
{
    float *t = *a;

    *a = *b;
    *b = t;
}

/* Keys do not turn eyeballs: those of the pose just made come from a frame that does. */
static void turn_eyes(sheet *s, const gaze *g)
{
    const fap_mesh *mesh = fap_bank_mesh(s->bank);
    const fap_frame frame = frame_of(g);

    swap(&s->position, &s->other);
    swap(&s->normal, &s->other_normal);
    fap_face_pose(s->face, &frame, s->position, s->normal);
    for (size_t i = 0; i < 3 * (size_t)mesh->stride; i++) {
        const uint8_t part = mesh->part[i % mesh->stride];
        if (part == FAP_PART_EYE_LEFT || part == FAP_PART_EYE_RIGHT) {
            s->other[i] = s->position[i];
            s->other_normal[i] = s->normal[i];
        }
    }
    swap(&s->position, &s->other);
    swap(&s->normal, &s->other_normal);
}

static void pose(sheet *s, int key)
{
    const gaze *g = gaze_of(s, key);

    if (key != NEUTRAL)
        s->weight[key] = 1;
    fap_face_pose_keys(s->face, s->weight, s->position, s->normal);
    if (key != NEUTRAL)
        s->weight[key] = 0;
    if (g)
        turn_eyes(s, g);
}

static fap_err draw(sheet *s, int key)
{
    static const uint8_t black[3] = { 0, 0, 0 };
    const int x = s->drawn % s->style->columns * s->style->tile_px,
              y = s->drawn / s->style->columns * s->style->tile_px;
    char name[64];

    pose(s, key);
    const render_scene scene = { s->position, s->normal, .view = render_view_of(s->style->camera) };
    const fap_err err = renderer_draw(s->renderer, &scene, &s->tile);
    if (err)
        return err;
    name_of(s, key, name, sizeof name);
    image_blit(&s->whole, &s->tile, x, y);
    image_text(&s->whole, x + MARGIN_PX, y + MARGIN_PX,
               s->style->tile_px >= 24 * LABEL_PX ? 1 + s->style->tile_px / 400 : 1, black, name);
    progress_step(&s->progress, ++s->drawn);
    return FAP_OK;
}

static fap_err draw_all(sheet *s)
{
    fap_err err = FAP_OK;

    progress_start(&s->progress, "render", count_wanted(s));
    for (int k = NEUTRAL; !err && k < fap_bank_key_count(s->bank); k++)
        if (wanted(s, k))
            err = draw(s, k);
    progress_end(&s->progress);
    return err;
}

static fap_err open_face(sheet *s)
{
    const fap_allocator heap = fap_mem_allocator(NULL);
    const fap_err err = fap_face_open(&s->face, s->bank, NULL);
    if (err)
        return err;
    const size_t floats = 3 * fap_face_stride(s->face);
    s->position = fap_mem_calloc_aligned(&heap, floats, sizeof *s->position);
    s->normal = fap_mem_calloc_aligned(&heap, floats, sizeof *s->normal);
    s->weight = calloc((size_t)fap_bank_key_count(s->bank) + 1, sizeof *s->weight);
    s->other = fap_mem_calloc_aligned(&heap, floats, sizeof *s->other);
    s->other_normal = fap_mem_calloc_aligned(&heap, floats, sizeof *s->other_normal);
    return s->position && s->normal && s->weight && s->other && s->other_normal ? FAP_OK : FAP_E_NOMEM;
}

static fap_err open_pictures(sheet *s, char *where)
{
    const int rows = (count_wanted(s) + s->style->columns - 1) / s->style->columns;
    fap_err err =
        renderer_create(&s->renderer, s->style->gl, s->bank, s->style->tile_px, s->style->tile_px, where);

    if (!err)
        err = image_create(&s->tile, s->style->tile_px, s->style->tile_px);
    if (!err)
        err = image_create(&s->whole, s->style->columns * s->style->tile_px, rows * s->style->tile_px);
    return err;
}

static void sheet_close(sheet *s)
{
    const fap_allocator heap = fap_mem_allocator(NULL);

    renderer_destroy(&s->renderer);
    image_free(&s->tile);
    image_free(&s->whole);
    fap_mem_free_aligned(&heap, s->position);
    fap_mem_free_aligned(&heap, s->normal);
    fap_mem_free_aligned(&heap, s->other);
    fap_mem_free_aligned(&heap, s->other_normal);
    free(s->weight);
    fap_face_close(&s->face);
}

static fap_err save(const image *im, const char *path)
{
    out_file out;
    fap_err err = out_file_open(&out, path);

    if (err)
        return err;
    err = image_write_png(im, out.stream, 6);
    if (!err)
        return out_file_commit(&out);
    out_file_abandon(&out);
    return err;
}

fap_err sheet_write(const fap_bank *bank, const char *path, const sheet_style *style, char *where)
{
    sheet s = { .bank = bank, .style = style };

    snprintf(where, FAP_ERROR_TEXT_SIZE, "%s", path);
    fap_err err = open_face(&s);
    if (!err)
        err = open_pictures(&s, where);
    if (!err)
        err = draw_all(&s);
    if (!err)
        err = save(&s.whole, path);
    sheet_close(&s);
    return err;
}
