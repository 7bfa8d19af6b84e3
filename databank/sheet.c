/* SPDX-License-Identifier: BSD-2-Clause */
/* See sheet.h. */
#include "databank/sheet.h"

fap_err sheet_write(const fap_bank *bank, const char *path, int columns, int tile_px, const char **missing)
{
    (void)bank, (void)path, (void)columns, (void)tile_px;
    *missing = "OSMesa";
    return FAP_E_UNSUPPORTED;
}
