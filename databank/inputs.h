/* SPDX-License-Identifier: BSD-2-Clause */
/* What fit, pick and retarget read: banks, surfaces, landmarks. 0: the fault says why. */
#ifndef DATABANK_INPUTS_H
#define DATABANK_INPUTS_H

#include <fap/bank.h>
#include <fap/studio/landmarks.h>

#include "common/fault.h"

/* "PATH: what is wrong"; @where may be "". Always 0. */
int inputs_blame(fault *f, const char *path, fap_err err, const char *where);
/* @path NULL: the default face, else the built-in one; "builtin". */
int inputs_bank(fap_bank **out, const char *path, fault *f);
int inputs_surface(fap_surface **out, const char *path, fault *f);
/* It has triangles. */
int inputs_scan(fap_surface **out, const char *path, fault *f);
/* @scan: whose vertices may be meant. */
int inputs_landmarks(fap_take **out, const char *path, const fap_surface *scan, fault *f);

#endif
