/* SPDX-License-Identifier: BSD-2-Clause */
/* --pictures: scans and laid faces, seen by one camera, as PNG files of a folder. What fails is told to the fault; 0 then. */
#ifndef DATABANK_DRAWING_H
#define DATABANK_DRAWING_H

#include <fap/bank.h>
#include <fap/studio/surface.h>

#include "common/fault.h"
#include "player/render/renderer.h"

typedef struct drawing {
    const char *folder, *gl; /* gl: NULL: the first way that works */
    fault *f;
} drawing;

/* Made where it is not there. */
int drawing_open_folder(const drawing *d);
/*
 * A scan as a bank, which can be drawn.
 * @like     whose feature points the camera looks by
 * @in_head  [scan->vertex_count] millimetres, head axes
 */
int drawing_of_scan(const drawing *d, fap_bank **out, const fap_bank *like, const fap_surface *scan,
                    const float (*in_head)[3]);
/* The bank's face elsewhere; @colour [vertices] instead of its own, or NULL. */
int drawing_of_face(const drawing *d, fap_bank **out, const fap_bank *like, const float (*position)[3],
                    const uint8_t (*colour)[4]);
/* NAME.png: from the front and from the side. */
int drawing_save(const drawing *d, const fap_bank *bank, const char *name, int wireframe,
                 const render_mark *mark, int marks);
/* NAME.png: two beside each other, from the front and from the side. */
int drawing_save_pair(const drawing *d, const fap_bank *left, const fap_bank *right, const char *name);

#endif
