/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Files that come from faces and hold no points: coefficients and action units. Their readers are coef_*.c; here they are
 * only recognised, so that who asks for points is told what the file is.
 */
#include "take/coef.h"

/* Below the score of a table with points: an OpenFace export may have both. */
static int coefficients_claims(const uint8_t *data, size_t size)
{
    return coef_driver_livelink.claims(data, size) || coef_driver_openface.claims(data, size) ||
                   coef_driver_json.claims(data, size) || coef_driver_packets.claims(data, size) > 50
               ? 20
               : 0;
}

static fap_err coefficients_read(take_source *src, fap_take **take)
{
    (void)take;
    return take_fail(src, FAP_E_UNSUPPORTED,
                     "ARKit coefficients or action units, not points: fap_coefficients_read() reads them");
}

const take_driver take_driver_coefficients = { "coefficients", coefficients_claims, coefficients_read };
