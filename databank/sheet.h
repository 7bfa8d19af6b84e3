/* SPDX-License-Identifier: BSD-2-Clause */
/* A contact sheet: the neutral face and every key model of a bank, with names. */
#ifndef DATABANK_SHEET_H
#define DATABANK_SHEET_H

#include <fap/bank.h>

#include "player/render/renderer.h"

typedef struct sheet_style {
    int columns, tile_px;
    int units; /* the units instead of the key models */
    render_camera camera;
    const char *gl; /* NULL: the first way to draw that works */
} sheet_style;

/* @p where (FAP_ERROR_TEXT_SIZE) says what failed; FAP_E_UNSUPPORTED: no way to render in this build or here.
 */
fap_err sheet_write(const fap_bank *bank, const char *path, const sheet_style *style, char *where);

#endif
