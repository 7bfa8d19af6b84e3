/* SPDX-License-Identifier: BSD-2-Clause */
/** @file
 * ARKit's 52 face coefficients and FAPs, both ways, for avatars that know the one and streams of the other. Coefficients
 * are not points: what one means in FAPs is a convention, ours is fap_tables/arkit.csv, measured on two faces.
 * Source: Live Link Face's column layout; the shapes' names are Apple's. docs/export.md has the measured losses.
 */
#ifndef FAP_ARKIT_H
#define FAP_ARKIT_H

#include <fap/alloc.h>
#include <fap/error.h>
#include <fap/frame.h>

#ifdef __cplusplus
extern "C" {
#endif

#define FAP_ARKIT_COUNT 52

/**
 * Angles behind the 52, in Live Link Face's order. The eyes' senses are measured on its files: yaw is positive to the
 * face's right, pitch down. UNVERIFIED: the head's senses; no file says what its head did. They are opposite to the
 * eyes' (yaw positive to the left, pitch up, roll to the right): in the one recording there is, that way eyes hold
 * on to something while the head turns.
 */
typedef enum fap_arkit_angle {
    FAP_ARKIT_HEAD_YAW,
    FAP_ARKIT_HEAD_PITCH,
    FAP_ARKIT_HEAD_ROLL,
    FAP_ARKIT_LEFT_EYE_YAW,
    FAP_ARKIT_LEFT_EYE_PITCH,
    FAP_ARKIT_LEFT_EYE_ROLL,
    FAP_ARKIT_RIGHT_EYE_YAW,
    FAP_ARKIT_RIGHT_EYE_PITCH,
    FAP_ARKIT_RIGHT_EYE_ROLL,
    FAP_ARKIT_ANGLE_COUNT
} fap_arkit_angle;

/** One instant. */
typedef struct fap_arkit {
    float shape[FAP_ARKIT_COUNT];       /**< 0 to 1, in the order of fap_arkit_name() */
    float angle[FAP_ARKIT_ANGLE_COUNT]; /**< radians, a ::fap_arkit_angle each */
    uint8_t has_head,
        has_eyes; /**< 1: these angles count. Without eyes' angles the shapes EyeLook... say where eyes look */
} fap_arkit;

/** "EyeBlinkLeft", as Live Link Face has it (ARKit's own begin small); NULL for another number. */
FAP_API const char *fap_arkit_name(int shape);
/** "HeadYaw"; NULL for another number. */
FAP_API const char *fap_arkit_angle_name(int angle);
/** Number of the shape of that name, large and small letters alike; -1: none. */
FAP_API int fap_arkit_by_name(const char *name);
/** FAP value that @p shape at 1 stands for; 0 where it leaves the FAP alone. */
FAP_API int fap_arkit_value(int shape, int fap);

/**
 * Coefficients to FAPs: their weighted sum. FAPs that no coefficient moves are FAP_ABSENT, all others FAP_CODED; number,
 * time, viseme and expression of @p frame are left as they are. Coefficients beyond 0 and 1 are taken as they are (calibrated
 * takes have 1.05); what is no number counts as 0.
 */
FAP_API void fap_arkit_to_faps(const fap_arkit *in, fap_frame *frame);
/** What the other way needs: some 100 KB, taken once. One thread each. */
typedef struct fap_arkit_fit fap_arkit_fit;
/** @param alloc NULL: malloc. @return FAP_OK or FAP_E_NOMEM; @p *fit is NULL unless FAP_OK. */
FAP_API FAP_NODISCARD fap_err fap_arkit_fit_open(fap_arkit_fit **fit, const fap_allocator *alloc);
/** Sets @p *fit to NULL; accepts NULL. */
FAP_API void fap_arkit_fit_close(fap_arkit_fit **fit);
/**
 * FAPs to coefficients: those whose FAPs come nearest, in square millimetres on a typical face, lips and lids first.
 * A function of @p frame alone. FAPs of state FAP_ABSENT ask for nothing. Visemes and expressions are not looked at: for
 * the face as it is shown, fap_face_complete() the frame first. Coefficients are never beyond 0 and 1; MouthClose is at most
 * JawOpen.
 */
FAP_API void fap_arkit_from_faps(fap_arkit_fit *fit, const fap_frame *frame, fap_arkit *out);

#ifdef __cplusplus
}
#endif
#endif
