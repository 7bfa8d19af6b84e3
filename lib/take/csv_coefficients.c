/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Files that come from faces and hold no points: coefficients and action units. Their readers are coef_*.c; here they are
 * only recognised, so that who asks for points is told what the file is.
 */
#include "take/coef.h"

/* Below the score of a table with points: a file may have both. But what looks like a point in OpenFace's units is the gaze,
 * gaze_0_x to gaze_1_z, unless OpenFace's points are there too, which their own reader knows. */
static int coefficients_claims(const uint8_t *data, size_t size)
{
    enum { BELOW_TABLES = 20, ABOVE_TABLES = 35 };

    if (coef_driver_openface.claims(data, size))
        return ABOVE_TABLES;
    return coef_driver_livelink.claims(data, size) || coef_driver_json.claims(data, size) ||
                   coef_driver_packets.claims(data, size) > 50
               ? BELOW_TABLES
               : 0;
}

static fap_err coefficients_read(take_source *src, fap_take **take)
{
    (void)take;
    return take_fail(src, FAP_E_UNSUPPORTED,
                     "ARKit coefficients or action units, not points: fap_coefficients_read() reads them");
}

const take_driver take_driver_coefficients = { "coefficients", coefficients_claims, coefficients_read };
