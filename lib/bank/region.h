/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The face in one, two (left, right) or four regions (each half in upper and lower) that overlap: how much
 * each has to say about every feature point and every vertex. Shares of all regions sum to one. Source: Zhu
 * 2006 section 3.4.2, eq. 3.7.
 */
#ifndef LIB_BANK_REGION_H
#define LIB_BANK_REGION_H

#include <fap/bank.h>

enum { FAP_REGION_MAX = 4 };

typedef struct fap_regions {
    int count;                                    /* 1, 2 or 4 */
    float point[FAP_REGION_MAX][FAP_POINT_COUNT]; /* shares of feature points */
    float *map; /* [stride / FAP_BLOCK][FAP_REGION_MAX][FAP_BLOCK]: shares of vertices; NULL for one region */
} fap_regions;

/*
 * @param overlap  share of the face's width (height) on either side of a border that both neighbours shape
 * @return non-zero: no memory. Close in either case.
 */
int fap_regions_open(fap_regions *r, const fap_bank *bank, int count, float overlap,
                     const fap_allocator *alloc);
/* Borders of a face from its feature points, for a bank that has none of its own; from is NULL. */
void fap_region_measure(const fap_bank *bank, fap_region_lines *lines);
/* @p from  [2][stride]: how far each vertex is from those borders; what is no skin counts as one body. */
void fap_region_distances(const fap_bank *bank, const fap_region_lines *lines, float *from);
void fap_regions_close(fap_regions *r, const fap_allocator *alloc);

#endif
