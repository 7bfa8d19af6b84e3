/* SPDX-License-Identifier: BSD-2-Clause */
/** @file
 * A marker take to FAPs: cleaning, head motion, neutral frame, FAPU, extraction; and a full account of what
 * was done. Nothing is invented: a FAP that no marker determines is not in the mask. Sources: ISO/IEC
 * 14496-2, Annex C; K. S. Arun, T. S. Huang, S. D. Blostein 1987 and B. K. P. Horn 1987 (rigid motion).
 */
#ifndef FAP_STUDIO_CAPTURE_H
#define FAP_STUDIO_CAPTURE_H

#include <fap/bank.h>
#include <fap/fapu.h>
#include <fap/frame.h>
#include <fap/studio/clean.h>
#include <fap/studio/markers.h>
#include <fap/studio/take.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct fap_capture fap_capture;

/** What closes gaps; fap/studio/clean.h says how. */
typedef enum fap_fill {
    FAP_FILL_NONE,   /**< nothing: the FAP is masked out there */
    FAP_FILL_SPLINE, /**< gaps up to 0.2 s by a curve */
    FAP_FILL_TAKE,   /**< longer ones too, where the take's other markers tell */
    FAP_FILL_ALL, /**< the rest by the databank, if there is one, or eased from place to place with the head */
} fap_fill;

/** What is taken for the head's motion; its turning is always that of the rigid markers. */
typedef enum fap_head {
    FAP_HEAD_RIGID, /**< the rigid markers turn and carry it */
    FAP_HEAD_NOSE, /**< the tip of the nose carries it, as in Zhu's normalisation; its own FAPs are not sent then */
} fap_head;

/** Start from fap_capture_config_init(). */
typedef struct fap_capture_config {
    size_t struct_size;
    double rate_hz;        /**< 25: frames a second of the FAPs */
    double start_s, end_s; /**< 0, 0: the whole take; seconds from its first frame */
    int64_t neutral_frame; /**< -1: found; otherwise a frame of the take, the first one is 0 */
    int64_t
        neutral_last; /**< -1: that frame alone; otherwise the last of a stretch, whose mean is the face at rest */
    const char *
        axes; /**< NULL: found; "x-zy": which axes of the take are the head's x (left), y (up), z (forward) */
    const char *rigid;    /**< NULL: by the marker set, or found; "A,B,C" */
    const fap_fapu *fapu; /**< NULL: measured on the neutral frame, as far as it goes */
    const char *markers;  /**< NULL: built-in sets only; text of a marker table, see fap_markers_map() */
    size_t markers_size;
    double smooth_hz; /**< 0: as the rates ask for; > 0: low-pass; < 0: none */
    fap_fill fill;    /**< FAP_FILL_ALL */
    /** NULL: the built-in face. Markers are placed on it, and FAPU not measured have its proportions; for the call only */
    const fap_bank *bank;
    uint8_t average; /**< 0; 1: Zhu's mean of three frames instead of the search for spikes */
    fap_head head;   /**< FAP_HEAD_RIGID */
} fap_capture_config;
FAP_API void fap_capture_config_init(fap_capture_config *cfg);

/** Where the rigid markers, or a FAPU, came from. */
typedef enum fap_origin {
    FAP_ORIGIN_NONE,
    FAP_ORIGIN_GIVEN,
    FAP_ORIGIN_SET,
    FAP_ORIGIN_FOUND,
    FAP_ORIGIN_MEASURED,
    FAP_ORIGIN_SCALED, /**< of a typical face, scaled by what was measured */
    FAP_ORIGIN_BANK,   /**< of the configuration's bank, scaled likewise */
} fap_origin;
/** "given", "marker set", "found", "measured", "typical, scaled", "bank, scaled"; static. */
FAP_API const char *fap_origin_name(fap_origin origin);

/** How the motion of a feature point was found. */
typedef enum fap_how {
    FAP_HOW_NONE,
    FAP_HOW_DIRECT,  /**< a marker sits on the point, or the mean of some does */
    FAP_HOW_RBF,     /**< mixed from the markers around it */
    FAP_HOW_DERIVED, /**< follows from other points: an inner lip from the outer one */
    FAP_HOW_COPIED,  /**< of a FAP: another point of the same bone or lip stands in, the chin for the jaw */
} fap_how;
/** "direct", "RBF", "derived", "copied"; static. */
FAP_API const char *fap_how_name(fap_how how);

#define FAP_CAPTURE_MARKERS 4
/** Where the motion of a feature point comes from. */
typedef struct fap_capture_origin {
    uint8_t how;          /**< a ::fap_how */
    uint8_t marker_count; /**< those that count most */
    int16_t marker[FAP_CAPTURE_MARKERS];
    float share[FAP_CAPTURE_MARKERS]; /**< of the marker's motion; of all markers together they add up to 1 */
} fap_capture_origin;

/** One FAP over the whole take. */
typedef struct fap_capture_fap {
    uint32_t coded; /**< frames that carry it */
    int32_t min, max;
    uint32_t beyond; /**< frames outside the range that Table C-1 gives */
    int8_t point;    /**< the feature point it was taken from; -1 head rotation */
    uint8_t near;    /**< 1: from a marker near that point, or from another point that stands in for it */
    fap_capture_origin origin;
    const char *reason; /**< why it is not sent; NULL when it is. Static */
} fap_capture_fap;

#define FAP_CAPTURE_MAX_RIGID 16

typedef struct fap_capture_report {
    const char *format;
    double take_rate_hz, rate_hz, take_length_s;
    uint32_t take_frames, take_points, frames;
    fap_clean_report clean;
    uint32_t gaps_by_bank;        /**< long gaps, per feature point, closed by the bank's units */
    uint32_t gaps_eased;          /**< others: eased from place to place */
    uint32_t frames_without_head; /**< too few rigid markers in sight */
    fap_origin rigid_origin;
    uint32_t rigid_count;
    int16_t rigid[FAP_CAPTURE_MAX_RIGID]; /**< points of the take */
    double rigid_rms_mm;
    uint32_t frames_without_nose; /**< FAP_HEAD_NOSE: carried by the rigid markers, the nose is hidden */
    char axes[16];                /**< nearest axes of the take: "x y z" of the head */
    double axes_turn_deg;         /**< how far the head's axes are turned from those */
    uint8_t axes_found, sides_swapped;
    double neutral_s; /**< middle of the neutral stretch, from the start of the take */
    double neutral_length_s;
    uint8_t neutral_found;
    fap_fapu fapu;
    fap_origin fapu_origin[5]; /**< IRISD, ES, ENS, MNS, MW */
    double fapu_scale;         /**< measured over typical; 1 where nothing could be measured */
    fap_capture_fap fap[FAP_COUNT + 1];
    fap_markers markers;
    uint32_t fitted; /**< points of the take mapped by where they lie, as no label is known; 0: by labels */
    uint32_t fitted_usual; /**< of these, on feature points that markers usually are put on */
    double fit_mm; /**< how far they are from there on the bank's face, its features bent to fit: RMS */
    uint32_t note_count;
    char note[FAP_TAKE_MAX_NOTES][FAP_TAKE_NOTE_SIZE];
} fap_capture_report;

/**
 * Encode a take.
 * @param take  read only; needs a rate
 * @param cfg   NULL: defaults
 * @return FAP_OK; FAP_E_NOT_FOUND no known marker; FAP_E_SYNTAX the marker table; FAP_E_ARG an option does
 * not fit the take; FAP_E_DATA the markers do not form a face; FAP_E_LIMIT; FAP_E_NOMEM. *out is NULL on
 * error and
 *         @p where (may be NULL, FAP_ERROR_TEXT_SIZE bytes) says what to do.
 */
FAP_API FAP_NODISCARD fap_err fap_capture_encode(fap_capture **out, const fap_take *take,
                                                 const fap_capture_config *cfg, char *where);
/** fap_capture_report_get()->frames of them, numbered from 0. */
FAP_API const fap_frame *fap_capture_frames(const fap_capture *c);
FAP_API const fap_capture_report *fap_capture_report_get(const fap_capture *c);
/**
 * Where a FAP's value in a frame comes from: FAP_SAMPLE_MISSING where it is held or absent, else the least sure of
 * the markers it was taken from.
 * @param frame  0 .. report.frames - 1
 * @param fap    1 .. FAP_COUNT
 */
FAP_API fap_sample fap_capture_fill_of(const fap_capture *c, uint32_t frame, int fap);
/**
 * Where a point of the take sits on the neutral face, head motion taken out: x left, y up, z forward, millimetres of the
 * take. What it is there for: report.markers.role[point].
 * @param point  0 .. report.take_points - 1
 * @return 0: it has no place, as it is never seen together with the head; @p xyz_mm is not set
 */
FAP_API int fap_capture_marker_place(const fap_capture *c, uint32_t point, float xyz_mm[3]);
/** The skin below a marker, were it glued to the bank's face: a place in a triangle. */
typedef struct fap_capture_spot {
    float mm[3];        /**< on the bank's neutral face */
    float off_mm;       /**< how far from the skin the fit had put it */
    uint32_t vertex[3]; /**< of the bank's mesh */
    float share[3];     /**< of each vertex */
} fap_capture_spot;
/**
 * Where a point of the take sits on the face of the configuration's bank (NULL: the built-in one).
 * @return 0: too few feature points to tell, or it is not on the skin
 */
FAP_API int fap_capture_marker_on_face(const fap_capture *c, uint32_t point, fap_capture_spot *out);
/** Millimetres of the bank's face in one of the take's; 0: too few feature points to tell. */
FAP_API double fap_capture_face_scale(const fap_capture *c);
/** Displacement of a point of the take from its place at rest, head motion taken out, head axes, millimetres; 0: not seen. */
FAP_API int fap_capture_marker_moved(const fap_capture *c, uint32_t frame, uint32_t point, float xyz_mm[3]);
/** What was done to each point of the take: [report.take_points]; valid as long as @p c. */
FAP_API const fap_clean_point *fap_capture_clean_points(const fap_capture *c);
/** Sets @p *c to NULL; accepts NULL. */
FAP_API void fap_capture_close(fap_capture **c);

#ifdef __cplusplus
}
#endif
#endif
