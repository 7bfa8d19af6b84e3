/* SPDX-License-Identifier: BSD-2-Clause */
/* How far the glTF export of the demo take leaves vertices from where the player has them. */
#include <math.h>
#include <stdlib.h>

#include <fap/face.h>

#include "bench.h"
#include "player/sinks/glb_shape.h"
#include "takes.h"

typedef struct export
{
    fap_bank *bank;
    fap_face *face;
    float *position, *weight;
    glb_rig rig;
    glb_shape shape;
    double worst_mm, square_mm2;
}
export;

static int open_export(export *e)
{
    e->bank = bench_bank();
    if (!e->bank || fap_face_open(&e->face, e->bank, NULL) != FAP_OK)
        return 0;
    e->position = aligned_alloc(32, 3 * fap_face_stride(e->face) * sizeof *e->position);
    return e->position && glb_rig_open(&e->rig, e->bank) && glb_shape_open(&e->shape, e->bank, &e->rig);
}

static void close_export(export *e)
{
    glb_shape_close(&e->shape);
    glb_rig_close(&e->rig);
    free(e->position);
    free(e->weight);
    fap_face_close(&e->face);
    fap_bank_close(&e->bank);
}

static void show(export *e, const fap_frame *frame, int pass)
{
    glb_motion motion[JOINT_COUNT];
    glb_affine affine[JOINT_COUNT];
    double worst_mm, square_mm2;

    fap_face_pose(e->face, frame, e->position, NULL);
    glb_rig_move(&e->rig, frame, e->position, motion);
    glb_rig_affines(&e->rig, motion, affine);
    if (!pass) {
        glb_shape_learn(&e->shape, e->position, fap_face_weights(e->face), affine);
        return;
    }
    glb_shape_fit(&e->shape, e->position, fap_face_weights(e->face), affine, e->weight, &worst_mm,
                  &square_mm2);
    e->worst_mm = fmax(e->worst_mm, worst_mm);
    e->square_mm2 += square_mm2;
}

static int measure(export *e, const bench_take *demo)
{
    for (int i = 0; i < demo->count; i++)
        show(e, &demo->frame[i], 0);
    glb_shape_settle(&e->shape);
    e->weight = calloc((size_t)glb_shape_target_count(&e->shape), sizeof *e->weight);
    for (int i = 0; e->weight && i < demo->count; i++)
        show(e, &demo->frame[i], 1);
    return e->weight != NULL;
}

double bench_glb_worst_mm(void)
{
    static bench_takes takes;
    export e = { 0 };
    double worst_mm = -1;

    bench_takes_add_every(&takes);
    if (takes.count && open_export(&e)) {
        const bench_take *demo = &takes.take[takes.count - 1];
        if (measure(&e, demo)) {
            worst_mm = e.worst_mm;
            bench_note("root_mean_square", sqrt(e.square_mm2 / demo->count), "mm");
            bench_note("corrections", e.shape.correction_count, "targets");
        }
    }
    close_export(&e);
    bench_takes_free(&takes);
    return worst_mm;
}
