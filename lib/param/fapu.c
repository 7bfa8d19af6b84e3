/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * FAPU and head angles.
 * Source: ISO/IEC 14496-2, Annex C, FAPU definition and FAPs 48 to 50.
 */
#include <math.h>

#include <fap/fapu.h>

#include "param/tables.h"

static const float radians_per_au = 1e-5f;

/* IRISD may be measured on either eye; the mean serves faces that are not quite symmetric. */
static float iris_diameter(const float points[FAP_POINT_COUNT][3])
{
    const int lids[4] = { fap_point_index(3, 1), fap_point_index(3, 3), fap_point_index(3, 2),
                          fap_point_index(3, 4) };

    return 0.5f * (points[lids[0]][1] - points[lids[1]][1] + points[lids[2]][1] - points[lids[3]][1]);
}

fap_err fap_fapu_measure(const float points[FAP_POINT_COUNT][3], fap_fapu *out)
{
    const fap_fapu m = {
        .irisd_mm = iris_diameter(points),
        .es_mm = fap_unit_distance(points, FAP_UNIT_ES),
        .ens_mm = fap_unit_distance(points, FAP_UNIT_ENS),
        .mns_mm = fap_unit_distance(points, FAP_UNIT_MNS),
        .mw_mm = fap_unit_distance(points, FAP_UNIT_MW),
    };

    /* Written so that a NaN fails too. */
    if (!(m.irisd_mm > 0 && m.es_mm > 0 && m.ens_mm > 0 && m.mns_mm > 0 && m.mw_mm > 0))
        return FAP_E_DATA;
    *out = m;
    return FAP_OK;
}

float fap_fapu_step(const fap_fapu *fapu, fap_unit unit)
{
    switch (unit) {
    case FAP_UNIT_IRISD: return fapu->irisd_mm / 1024;
    case FAP_UNIT_ES: return fapu->es_mm / 1024;
    case FAP_UNIT_ENS: return fapu->ens_mm / 1024;
    case FAP_UNIT_MNS: return fapu->mns_mm / 1024;
    case FAP_UNIT_MW: return fapu->mw_mm / 1024;
    case FAP_UNIT_AU: return radians_per_au;
    case FAP_UNIT_NONE: break;
    }
    return 0;
}

/*
 * R = Ry(yaw) Rx(pitch) Rz(roll): positive yaw turns the nose to the face's left (+x), positive pitch turns it down, and
 * positive roll tips the crown to the face's right (-x), which is the right-handed sense about +z.
 */
void fap_head_rotation(int32_t pitch_au, int32_t yaw_au, int32_t roll_au, float rotation[3][3])
{
    const float p = pitch_au * radians_per_au, y = yaw_au * radians_per_au, r = roll_au * radians_per_au;
    const float cp = cosf(p), sp = sinf(p), cy = cosf(y), sy = sinf(y), cr = cosf(r), sr = sinf(r);

    rotation[0][0] = cy * cr + sy * sp * sr;
    rotation[0][1] = -cy * sr + sy * sp * cr;
    rotation[0][2] = sy * cp;
    rotation[1][0] = cp * sr;
    rotation[1][1] = cp * cr;
    rotation[1][2] = -sp;
    rotation[2][0] = -sy * cr + cy * sp * sr;
    rotation[2][1] = sy * sr + cy * sp * cr;
    rotation[2][2] = cy * cp;
}

void fap_head_angles(const float rotation[3][3], int32_t *pitch_au, int32_t *yaw_au, int32_t *roll_au)
{
    const float sp = fminf(1, fmaxf(-1, -rotation[1][2]));

    *pitch_au = (int32_t)lrintf(asinf(sp) / radians_per_au);
    *yaw_au = (int32_t)lrintf(atan2f(rotation[0][2], rotation[2][2]) / radians_per_au);
    *roll_au = (int32_t)lrintf(atan2f(rotation[1][0], rotation[1][1]) / radians_per_au);
}
