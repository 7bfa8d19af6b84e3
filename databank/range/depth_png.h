/* SPDX-License-Identifier: BSD-2-Clause */
/* Grey pictures of 16 bits through libpng, as they are: depth is no light, and no gamma is its. */
#ifndef DATABANK_RANGE_DEPTH_PNG_H
#define DATABANK_RANGE_DEPTH_PNG_H

#include <stdint.h>

#include <fap/error.h>

/* @depth is malloc'ed. FAP_E_UNKNOWN_FORMAT no PNG; FAP_E_DATA damaged, or not grey; FAP_E_LIMIT; FAP_E_UNSUPPORTED no libpng. */
fap_err depth_png_read(float **depth, uint32_t *columns, uint32_t *rows, const uint8_t *data, size_t size);

/* Any PNG as red, green and blue; @rgb is malloc'ed. */
fap_err colour_png_read(uint8_t **rgb, uint32_t *columns, uint32_t *rows, const uint8_t *data, size_t size);

#endif
