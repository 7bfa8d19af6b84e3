/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The least an avatar client does: a face, a frame of FAPs, vertices. Prints the pose as a Wavefront OBJ.
 *   cc -Iinclude docs/examples/pose.c build/release/libfap.a -lm -o pose && ./pose > smile.obj
 */
#include <stdio.h>
#include <stdlib.h>

#include <fap/fap.h>

static void command(fap_frame *frame, const char *name, int value)
{
    const int fap = fap_by_name(name);

    frame->state[fap] = FAP_CODED;
    frame->value[fap] = value; /* FAP units: 1024 are the face's own mouth width, nose height ... */
}

static void print_obj(const fap_mesh *mesh, const float *position)
{
    const float *x = position, *y = x + mesh->stride, *z = y + mesh->stride;

    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        printf("v %g %g %g\n", x[v], y[v], z[v]);
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *corner = mesh->triangle + 3 * t;
        printf("f %u %u %u\n", corner[0] + 1, corner[1] + 1, corner[2] + 1); /* OBJ counts from 1 */
    }
}

int main(void)
{
    fap_bank *bank = NULL;
    fap_face *face = NULL;
    float *position = NULL;
    fap_frame frame = { 0 }; /* everything absent: the neutral face */
    fap_face_stats stats;

    fap_err err = fap_bank_builtin(&bank, NULL);
    if (!err)
        err = fap_face_open(&face, bank, NULL);
    if (!err) {
        position = aligned_alloc(32, 3 * fap_face_stride(face) * sizeof *position);
        err = position ? FAP_OK : FAP_E_NOMEM;
    }
    if (!err) {
        command(&frame, "stretch_l_cornerlip", 120);
        command(&frame, "stretch_r_cornerlip", 120);
        command(&frame, "raise_l_cornerlip", 150);
        command(&frame, "raise_r_cornerlip", 150);
        command(&frame, "head_yaw", 20000); /* 1e-5 rad */
        fap_face_pose(face, &frame, position, NULL);
        fap_face_last_stats(face, &stats);
        print_obj(fap_bank_mesh(bank), position);
        fprintf(stderr, "%d commanded axes, %.4f mm off\n", stats.target_count, stats.residual_error_mm);
    }
    if (err)
        fprintf(stderr, "pose: %s\n", fap_strerror(err));
    free(position);
    fap_face_close(&face);
    fap_bank_close(&bank);
    return err != FAP_OK;
}
