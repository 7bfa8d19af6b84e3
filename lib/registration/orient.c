/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * fap_face_orient(): the three turns of Zhu 2006 section 4.7. The "two nose ridge points" are 9.12 and 9.3, whose line the side
 * view shows; the angle that the text keeps constant for all models of a person is that of the face at rest. The turns about y
 * and z bring the line of the eyes to that of the face at rest, not to the x axis: the head's axes are a face's own already.
 */
#include <math.h>
#include <string.h>

#include <fap/studio/expression.h>

enum { MIDDLE_LEFT, MIDDLE_RIGHT, RIDGE_TOP, RIDGE_TIP, LANDMARKS };

static int add_place(const fap_bank *bank, const float (*at)[3], const char *name, double share,
                     double out[3])
{
    const fap_bank_point *p = fap_bank_point_get(bank, fap_point_by_name(name));

    if (!p->present || !p->vertex_count)
        return 0;
    for (int a = 0; a < 3; a++)
        out[a] += share * (double)at[p->vertex[0]][a];
    return 1;
}

static int find_places(const fap_bank *bank, const float (*at)[3], double out[LANDMARKS][3])
{
    memset(out, 0, LANDMARKS * sizeof *out);
    return add_place(bank, at, "3.7", 0.5, out[MIDDLE_LEFT]) &&
           add_place(bank, at, "3.11", 0.5, out[MIDDLE_LEFT]) &&
           add_place(bank, at, "3.8", 0.5, out[MIDDLE_RIGHT]) &&
           add_place(bank, at, "3.12", 0.5, out[MIDDLE_RIGHT]) &&
           add_place(bank, at, "9.12", 1, out[RIDGE_TOP]) && add_place(bank, at, "9.3", 1, out[RIDGE_TIP]);
}

/* Turns the plane of two axes by an angle about the origin. */
static void turn(float (*at)[3], uint32_t count, int first, int second, double angle)
{
    const double c = cos(angle), s = sin(angle);

    for (uint32_t i = 0; i < count; i++) {
        const double u = (double)at[i][first], v = (double)at[i][second];
        at[i][first] = (float)(c * u - s * v);
        at[i][second] = (float)(s * u + c * v);
    }
}

/* Of the line from one place to another, in the plane of two axes. */
static double angle_of(double p[LANDMARKS][3], int from, int to, int first, int second)
{
    return atan2(p[to][second] - p[from][second], p[to][first] - p[from][first]);
}

static const struct step {
    int from, to, first, second; /* the line, and the plane it is looked at in */
} steps[] = {
    { RIDGE_TOP, RIDGE_TIP, 1, 2 },      /* about x */
    { MIDDLE_RIGHT, MIDDLE_LEFT, 2, 0 }, /* about y */
    { MIDDLE_RIGHT, MIDDLE_LEFT, 0, 1 }, /* about z */
};
/* A turn about one axis disturbs the others a little; three times through, nothing is left of it. */
enum { STEPS = sizeof steps / sizeof *steps, ROUNDS = 4 };

fap_err fap_face_orient(float (*position)[3], const fap_bank *bank, const float (*like)[3])
{
    const uint32_t n = fap_bank_mesh(bank)->vertex_count;
    double want[LANDMARKS][3], have[LANDMARKS][3];

    if (!find_places(bank, like, want))
        return FAP_E_DATA;
    for (int i = 0; i < ROUNDS * STEPS; i++) {
        const struct step *s = &steps[i % STEPS];
        find_places(bank, (const float(*)[3])position, have);
        turn(position, n, s->first, s->second,
             angle_of(want, s->from, s->to, s->first, s->second) -
                 angle_of(have, s->from, s->to, s->first, s->second));
    }
    find_places(bank, (const float(*)[3])position, have);
    for (uint32_t i = 0; i < n; i++)
        for (int a = 0; a < 3; a++)
            position[i][a] += (float)((want[MIDDLE_LEFT][a] + want[MIDDLE_RIGHT][a] - have[MIDDLE_LEFT][a] -
                                       have[MIDDLE_RIGHT][a]) /
                                      2);
    return FAP_OK;
}
