/* SPDX-License-Identifier: BSD-2-Clause */
/* --pictures: what the fit began with, and what came of it. */
#ifndef DATABANK_FIT_FIT_PICTURES_H
#define DATABANK_FIT_FIT_PICTURES_H

#include "databank/fit/fit.h"

/* points.png, before.png, after.png, distances.png, wireframe.png in opt->pictures, which is made where it is not there. */
int fit_pictures_write(fit_work *w, fault *f);

#endif
