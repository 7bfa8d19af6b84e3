/* SPDX-License-Identifier: BSD-2-Clause */
/* Why a FAP is not sent: what the take would have to show. */
#include "capture/performance.h"

enum { FAP_OPEN_JAW = 3, FAP_DEPRESS_CHIN = 18 };

static const char *reason_of_part(int group, int point_group)
{
    if (group == 3)
        return "no marker is on the lid or the pupil, and skin beside the eye does not tell what they do";
    switch (point_group) {
    case 2: return "no marker tells the jaw or the lip at this point";
    case 4: return "no marker is on the brow near this point";
    case 5: return "no marker is on the cheek near this point";
    case 6: return "no marker is on the tongue";
    case 8: return "no marker is on the lip near this point";
    case 9: return "no marker is on the nose near this point";
    case 10: return "no marker is on the ear";
    default: return "no marker is near its feature point";
    }
}

static const char *reason_of_motion(int fap)
{
    if (fap == FAP_DEPRESS_CHIN)
        return "one marker on the chin moves with the jaw: its skin's own motion needs another";
    switch (fap_info_get(fap)->motion) {
    case FAP_MOTION_Z: return "a pupil's depth shows the eye's turning and not its thrust";
    case FAP_MOTION_SIZE: return "one marker on a pupil does not show its size";
    case FAP_MOTION_CURL: return "the tongue's curl needs markers on both its borders";
    default: return "markers do not show it";
    }
}

const char *reason_for(const performance *p, int fap)
{
    const fap_info *info = fap_info_get(fap);

    if (fap <= 2)
        return "visemes and expressions are names for what the others do; --visemes and --expressions find them";
    if (info->motion != FAP_MOTION_CURL && info->group == 7)
        return p->has_body ? "the head is never seen" : "no three markers keep their distances";
    if (info->point < 0)
        return "markers do not show it";
    if (info->point == head_carrier(p))
        return "the head is carried by this point (--head nose)";
    if (p->report->fap[fap].point >= 0)
        return "its markers are never seen together with the head";
    if (p->known[info->point] || (fap == FAP_DEPRESS_CHIN && p->report->fap[FAP_OPEN_JAW].coded))
        return reason_of_motion(fap);
    return reason_of_part(info->group, fap_point_get(info->point)->group);
}
