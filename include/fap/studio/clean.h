/* SPDX-License-Identifier: BSD-2-Clause */
/** @file
 * A take as it comes from the cameras to a take that can be measured: spikes out, short gaps closed, another
 * rate. Sources: Hampel 1974 (median and median deviation); zero-phase windowed-sinc resampling.
 */
#ifndef FAP_STUDIO_CLEAN_H
#define FAP_STUDIO_CLEAN_H

#include <fap/studio/take.h>

#ifdef __cplusplus
extern "C" {
#endif

/** How a sample of a take came to be: what its @c valid holds. The later, the less was seen of it. */
typedef enum fap_sample {
    FAP_SAMPLE_MISSING,  /**< not there */
    FAP_SAMPLE_MEASURED, /**< as the file has it */
    FAP_SAMPLE_SPLINE,   /**< a curve from before the gap to after it */
    FAP_SAMPLE_RIGID,    /**< carried by markers that keep their distances to it */
    FAP_SAMPLE_SURFACE, /**< an offset in the frame that its neighbours make (Sanchez Lorenzo, section 5.2) */
    FAP_SAMPLE_MOTION,  /**< how it moves with all others in the rest of the take */
    FAP_SAMPLE_BANK,    /**< what the databank's key models make of the points in sight */
    FAP_SAMPLE_EASED,   /**< nothing was known: from its last place to its next one */
    FAP_SAMPLE_KINDS
} fap_sample;
/** "missing", "measured", "spline", "rigid", "surface", "motion", "bank", "eased"; static. */
FAP_API const char *fap_sample_name(fap_sample sample);

/** Start from fap_clean_config_init(). */
typedef struct fap_clean_config {
    size_t struct_size;
    double spike_mm; /**< 3: nothing closer than this to its neighbours' median is a spike; 0: keep spikes */
    double
        gap_s; /**< 0.2: what counts as short: such a gap is always closed, by a curve if nothing is better */
    uint8_t average;  /**< 0; 1: instead of taking spikes out, the mean of three frames (Zhu 2006, chapter 6) */
    uint32_t methods; /**< FAP_CLEAN_TAKE; what may close gaps, bits 1 << FAP_SAMPLE_SPLINE ...; 0: keep gaps */
} fap_clean_config;
/** Gaps of one point from the point itself; from all that the take tells. */
#define FAP_CLEAN_SPLINE (1u << FAP_SAMPLE_SPLINE)
#define FAP_CLEAN_TAKE                                                                                       \
    (FAP_CLEAN_SPLINE | 1u << FAP_SAMPLE_RIGID | 1u << FAP_SAMPLE_SURFACE | 1u << FAP_SAMPLE_MOTION)
FAP_API void fap_clean_config_init(fap_clean_config *cfg);

/** What was done, in samples and gaps, over all points. */
typedef struct fap_clean_report {
    uint32_t spikes, gaps_closed, samples_filled, gaps_left;
} fap_clean_report;

/** The same for one point of the take. */
typedef struct fap_clean_point {
    uint32_t spikes, gaps, longest_gap; /**< gaps: spikes count as such; longest_gap in frames of the take */
    uint32_t gaps_by[FAP_SAMPLE_KINDS]; /**< gaps closed, by method */
    uint32_t filled[FAP_SAMPLE_KINDS];  /**< samples filled, by method */
    uint32_t unfilled;                  /**< samples still missing */
    float
        error_mm; /**< rms error of the fills, as measured where the point was hidden on purpose: the worst of its gaps */
} fap_clean_point;

/**
 * Clean in place. Gaps longer than 0.1 s are closed by the method that predicts the point best where it is seen, unless
 * none is better than a straight line, or the point is seen for less than an eighth of the gap.
 * @param cfg     NULL: defaults. A take without a rate counts as 60 Hz.
 * @param points  [point_count], may be NULL
 * @return FAP_OK, FAP_E_NOMEM (spikes are out, gaps may be open)
 */
FAP_API FAP_NODISCARD fap_err fap_take_clean(fap_take *take, const fap_clean_config *cfg,
                                             fap_clean_report *report, fap_clean_point *points);

/**
 * The same take at another rate, low-passed without shifting it in time. Each unbroken run of a point is
 * filtered by itself; a gap stays a gap.
 * @param rate_hz    wanted frames a second
 * @param cutoff_hz  half-amplitude frequency; 0: none but what the lower of the two rates asks for (0.4 of
 * it), and the samples themselves where the rates are equal; negative: interpolate only
 * @return FAP_OK, FAP_E_ARG (a rate is missing or not positive), FAP_E_LIMIT, FAP_E_NOMEM
 */
FAP_API FAP_NODISCARD fap_err fap_take_resample(const fap_take *take, double rate_hz, double cutoff_hz,
                                                fap_take **out);

#ifdef __cplusplus
}
#endif
#endif
