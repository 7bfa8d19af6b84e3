/* SPDX-License-Identifier: BSD-2-Clause */
/** @file
 * All of libfap in one include.
 */
#ifndef FAP_FAP_H
#define FAP_FAP_H

#include <fap/arkit.h>
#include <fap/ascii.h>
#include <fap/bank.h>
#include <fap/decoder.h>
#include <fap/derive.h>
#include <fap/encoder.h>
#include <fap/error.h>
#include <fap/face.h>
#include <fap/facs.h>
#include <fap/fapu.h>
#include <fap/fit.h>
#include <fap/frame.h>
#include <fap/rtp.h>
#include <fap/sdp.h>
#include <fap/sensitivity.h>
#include <fap/tables.h>
#include <fap/version.h>

#endif
