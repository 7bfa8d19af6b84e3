/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * NAME.glb: the face as a glTF 2.0 file for Blender, three.js and viewers. All frames come twice: the first time
 * to learn what weights of key models do not say, the second time to write down how much of it each frame has, and how
 * far that leaves vertices from where the player puts them.
 */
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <fap/version.h>

#include "common/file.h"
#include "common/tool.h"
#include "player/sinks/export_limit.h"
#include "player/sinks/glb_content.h"
#include "player/sinks/sink.h"

typedef struct glb_state {
    out_file file;
    const sink_setup *setup;
    glb_rig rig;
    glb_shape shape;
    glb_track track;
    double worst_mm, square_mm2; /* the sum of each frame's mean */
    uint8_t *texture;            /* of --texture, as it is */
    size_t texture_size;
} glb_state;

static const size_t most_texture = (size_t)64 << 20;

static int failed(const glb_state *s, const char *why, fault *f)
{
    return fault_set(f, EXIT_DATA, "%s: %s", s->setup->output, why);
}

static int read_texture(glb_state *s, fault *f)
{
    static const uint8_t png[8] = { 0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n' };
    const char *path = s->setup->texture;

    if (!path)
        return 1;
    if (!fap_bank_mesh(s->setup->bank)->uv)
        return fault_set(f, EXIT_DATA, "--texture: the face %s has no texture coordinates",
                         fap_bank_name(s->setup->bank));
    const fap_err err = file_read(path, most_texture, &s->texture, &s->texture_size);
    if (err)
        return fault_set(f, EXIT_DATA, "%s: %s", path, err == FAP_E_IO ? strerror(errno) : fap_strerror(err));
    if (s->texture_size < sizeof png || memcmp(s->texture, png, sizeof png) != 0)
        return fault_set(f, EXIT_DATA, "%s: no PNG picture; others can be converted (convert in.jpg out.png)",
                         path);
    return 1;
}

static int glb_open(void *state, const sink_setup *setup, fault *f)
{
    glb_state *s = state;

    s->setup = setup;
    if (!export_fits(setup, glb_estimate(setup->bank, setup->count), f))
        return 0;
    if (!read_texture(s, f))
        return 0;
    if (!glb_rig_open(&s->rig, setup->bank) || !glb_shape_open(&s->shape, setup->bank, &s->rig))
        return failed(s, "out of memory", f);
    return out_file_open(&s->file, setup->output) ? failed(s, strerror(errno), f) : 1;
}

/* Between the first time and the second. */
static int settle(glb_state *s)
{
    glb_shape_settle(&s->shape);
    return glb_track_open(&s->track, (uint32_t)s->setup->count, glb_shape_target_count(&s->shape));
}

static void write_down(glb_state *s, const shown_frame *shown, const glb_motion motion[JOINT_COUNT],
                       const glb_affine affine[JOINT_COUNT])
{
    const uint32_t i = (uint32_t)(shown->number - s->setup->from);
    double worst_mm, square_mm2;

    glb_shape_fit(&s->shape, shown->position, shown->weight, affine,
                  s->track.weight + (size_t)i * (size_t)s->track.target_count, &worst_mm, &square_mm2);
    glb_track_set(&s->track, i, (double)i / s->setup->rate_hz, motion);
    s->worst_mm = fmax(s->worst_mm, worst_mm);
    s->square_mm2 += square_mm2;
}

static int glb_show(void *state, const shown_frame *shown, fault *f)
{
    glb_state *s = state;
    glb_motion motion[JOINT_COUNT];
    glb_affine affine[JOINT_COUNT];

    glb_rig_move(&s->rig, shown->frame, shown->position, motion);
    glb_rig_affines(&s->rig, motion, affine);
    if (!shown->pass) {
        glb_shape_learn(&s->shape, shown->position, shown->weight, affine);
        return 1;
    }
    if (!s->track.frame_count && !settle(s))
        return failed(s, "out of memory", f);
    write_down(s, shown, motion, affine);
    return 1;
}

static int glb_finish(void *state, sink_result *result, fault *f)
{
    glb_state *s = state;

    result->has_error = 1;
    result->worst_error_mm = s->worst_mm;
    result->rms_error_mm = sqrt(s->square_mm2 / (double)s->setup->count);
    const glb_about about = { "fapplay " FAP_VERSION_STRING, result->worst_error_mm, result->rms_error_mm,
                              s->texture, s->texture_size };
    glb_shape_fold(&s->shape, s->track.weight, s->track.frame_count, s->track.target_count);
    errno = ENOMEM;
    if (!glb_write_face(&s->rig, &s->shape, &s->track, &about, s->file.stream))
        return failed(s, strerror(errno), f);
    return out_file_commit(&s->file) ? failed(s, strerror(errno), f) : 1;
}

static void glb_close(void *state)
{
    glb_state *s = state;

    out_file_abandon(&s->file);
    glb_track_close(&s->track);
    glb_shape_close(&s->shape);
    glb_rig_close(&s->rig);
    free(s->texture);
}

const play_sink sink_glb = {
    .name = "glb",
    .summary = "NAME.glb            the moving face, glTF 2.0: Blender, three.js, viewers",
    .passes = 2,
    .state_size = sizeof(glb_state),
    .open = glb_open,
    .show = glb_show,
    .finish = glb_finish,
    .close = glb_close,
};
