/* SPDX-License-Identifier: BSD-2-Clause */
/* What the library itself asks of the tables beyond <fap/tables.h>. */
#ifndef LIB_PARAM_TABLES_H
#define LIB_PARAM_TABLES_H

#include <fap/tables.h>

/* The distance that defines a FAPU (fap_tables/units.csv), in the unit of @p point. Source: Annex C, FAPU. */
float fap_unit_distance(const float point[FAP_POINT_COUNT][3], fap_unit unit);

#endif
