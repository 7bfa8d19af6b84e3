/* SPDX-License-Identifier: BSD-2-Clause */
/* Texture coordinates and colours of the scan, on the face that was laid onto it. Source: Yano & Harada 2009 section 3.1. */
#ifndef DATABANK_FIT_FIT_DRESS_H
#define DATABANK_FIT_FIT_DRESS_H

#include "databank/fit/fit.h"

/* Where the scan has any: w->uv and w->colour, one a vertex of the laid face. FAP_E_NOMEM. */
fap_err fit_dress(fit_work *w);
/* The same for a bank: skin that was seen in the scan's colours, skin that was not in their mean. */
fap_err fit_dress_bank(const fit_work *w);
void fit_undress(fit_work *w);

#endif
