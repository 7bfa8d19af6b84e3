/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * MakeHuman's head on its way into a databank: files read and identity applied (mh_read.c), parts cut out and
 * refined (mh_cut.c), eyeballs made (mh_eye.c), lips closed (mh_mouth.c), colours laid on (mh_paint.c), all
 * put together (import_makehuman.c). Sources: base.obj and targets of MakeHuman, "Face Units" of Mika
 * Suominen, all CC0.
 */
#ifndef DATABANK_MAKEHUMAN_H
#define DATABANK_MAKEHUMAN_H

#include <fap/studio/bank_build.h>

#include "databank/mask.h"
#include "databank/package.h"
#include "shape/obj.h"
#include "shape/subdivide.h"

enum {
    MH_UNITS = 54,
    MH_FILE_UNITS = 52,
    MH_TONGUE_UP = 52,
    MH_TONGUE_BACK = 53,
    MH_PATCHES = 4,
    MH_MAX_STEPS = 2
};
enum mh_patch_id { MH_SKIN, MH_TEETH_UPPER, MH_TEETH_LOWER, MH_TONGUE };

extern const char *const mh_unit_names[MH_UNITS];

/* What the files say, by base.obj's own vertex numbers; millimetres, origin at the top of the spine. */
typedef struct mh_source {
    fap_obj obj;
    float (*base)[3];           /* the file's own places, decimetres: where cuts are defined */
    float (*rest)[3];           /* identity applied */
    float (*unit[MH_UNITS])[3]; /* motion; NULL: the package lacks it */
    mask lips, mouth, lids;
} mh_source;

/* @p bad gets the name of the file at fault. */
fap_err mh_read(mh_source *s, const package *p, char *bad, size_t bad_size);
void mh_source_free(mh_source *s);

/* A vertex that was moved to the plane of the cut: that part of the way towards another one. */
typedef struct mh_slide {
    uint32_t towards;
    float part;
} mh_slide;

/* A part cut out of the mesh and subdivided. */
typedef struct mh_patch {
    fap_part part;
    uint32_t coarse_count, *source; /* base.obj's vertex of each coarse one */
    uint32_t *compact;              /* the other way, UINT32_MAX: not in the patch */
    mh_slide *slide;                /* of each coarse one */
    int steps;
    fap_subdivision step[MH_MAX_STEPS];
    uint32_t count, quad_count, first; /* refined; first: in the whole face */
    uint32_t (*quad)[4];
    float (*uv)[2];
} mh_patch;

/* Height over the plane in which the neck is cut, decimetres in base.obj's own axes. */
float mh_height_over_cut(const float base_dm[3]);
fap_err mh_cut(mh_patch *patch, const mh_source *s, enum mh_patch_id id);
void mh_patch_free(mh_patch *patch);
/* A field by base.obj's numbers onto the refined patch. */
fap_err mh_patch_apply(const mh_patch *patch, const float (*in)[3], float (*out)[3]);

/* The whole face in the making. */
typedef struct mh_face {
    uint32_t count, triangle_count;
    float (*position)[3], (*uv)[2];
    uint8_t *part, *weight, (*colour)[4];
    uint32_t (*triangle)[3];
    float (*unit[MH_UNITS])[3];
    uint32_t eye_first[2];
    float eye_centre[2][3], eye_radius[2];
    const mh_source *source;
    const mh_patch *patch; /* MH_PATCHES */
} mh_face;

/* Vertex of the whole face that came from @p vertex of base.obj, UINT32_MAX: was cut away. */
uint32_t mh_face_vertex(const mh_face *f, uint32_t vertex);
/* Its place, or where the feature point @p name is at rest. */
const float *mh_face_point(const mh_face *f, const char *name);

/* Vertices and triangles of one eyeball. */
uint32_t mh_eye_vertices(void);
uint32_t mh_eye_triangles(void);
/* Measures the package's eye and puts ours in its place, colours included. */
void mh_eye_build(mh_face *f, int right, uint32_t first_vertex, uint32_t first_triangle);

/* Brings the lips together at rest. */
fap_err mh_close_lips(mh_face *f);
/* Lets the upper teeth reach over the lower ones. */
void mh_lengthen_teeth(mh_face *f);

void mh_paint(mh_face *f);

#endif
