/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Tables that come from faces and hold no points: ARKit coefficients, and OpenFace exports with its points
 * switched off. They are recognised so that the answer is better than "unknown format".
 */
#include "take/take_driver.h"
#include "take/text.h"

static int first_line_has(const uint8_t *data, size_t size, const char *word)
{
    text_lines lines = text_open(data, size);
    text line;

    if (!text_next(&lines, &line))
        return 0;
    for (; line.length; line.start++, line.length--)
        if (text_starts(line, word))
            return 1;
    return 0;
}

static int is_arkit(const uint8_t *data, size_t size)
{
    return first_line_has(data, size, "BlendShapeCount") || first_line_has(data, size, "eyeBlink");
}

/* Below the score of a table with points: an OpenFace export may have both. */
static int coefficients_claims(const uint8_t *data, size_t size)
{
    return is_arkit(data, size) || first_line_has(data, size, "AU01_r") ? 20 : 0;
}

static fap_err coefficients_read(take_source *src, fap_take **take)
{
    (void)take;
    if (is_arkit(src->data, src->size))
        return take_fail(src, FAP_E_UNSUPPORTED,
                         "ARKit coefficients (Live Link Face), not points: not supported yet");
    return take_fail(src, FAP_E_UNSUPPORTED,
                     "OpenFace action units without points: export 3D landmarks too (-3Dfp)");
}

const take_driver take_driver_coefficients = { "coefficients", coefficients_claims, coefficients_read };
