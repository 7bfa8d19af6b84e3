/* SPDX-License-Identifier: BSD-2-Clause */
/* See bone_pull.h. Each step of fap_planar_bone_set() and _carry(), transposed, last first. */
#include <math.h>
#include <string.h>

#include "registration/bone_pull.h"

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void add(double out[3], const double a[3], double by)
{
    for (int i = 0; i < 3; i++)
        out[i] += by * a[i];
}

/* out += a x b */
static void add_cross(double out[3], const double a[3], const double b[3])
{
    out[0] += a[1] * b[2] - a[2] * b[1];
    out[1] += a[2] * b[0] - a[0] * b[2];
    out[2] += a[0] * b[1] - a[1] * b[0];
}

static void widen(const float a[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = (double)a[i];
}

/* What is drawn at v / |v| moves v across itself only. */
static void through_unit(const double unit[3], double length, double pull[3])
{
    add(pull, unit, -dot(unit, pull));
    for (int i = 0; i < 3; i++)
        pull[i] /= length;
}

/* Eq. 10. */
static void add_beyond_corner(bone_pull *p, const fap_planar_bone *b, int i, const fap_bone_place *place,
                              const double pull[3])
{
    const int before = (i + 2) % 3;
    double way[3] = { 0 }, side[2][3], drawn[3];

    widen(b->side[i], side[0]);
    widen(b->side[before], side[1]);
    add(way, side[0], (double)place->local[0]);
    add(way, side[1], (double)place->local[1]);
    const double length = sqrt(dot(way, way));
    if (!(length > 0))
        return;
    for (int a = 0; a < 3; a++)
        way[a] /= length;
    memcpy(drawn, pull, sizeof drawn);
    through_unit(way, length / (double)place->beyond, drawn);
    add(p->side[i], drawn, (double)place->local[0]);
    add(p->side[before], drawn, (double)place->local[1]);
}

void bone_pull_add(bone_pull *p, const fap_planar_bone *bone, const fap_bone_place *place,
                   const double pull[3], double weight)
{
    const int i = place->region == 0 ? 0 : (place->region - 1) % 3;
    double drawn[3] = { 0 };

    add(drawn, pull, weight);
    add(p->corner[i], drawn, 1);
    add(p->normal, drawn, (double)place->local[2]);
    if (place->region == 0) {
        add(p->edge[0], drawn, (double)place->local[0]);
        add(p->edge[2], drawn, -(double)place->local[1]);
    } else if (place->region < 4) {
        add(p->edge[i], drawn, (double)place->local[0]);
        add(p->side[i], drawn, (double)place->local[1]);
    } else if (place->beyond > 0) {
        add_beyond_corner(p, bone, i, place, drawn);
    }
}

void bone_pull_corners(const bone_pull *p, const fap_planar_bone *bone, double corner[3][3])
{
    bone_pull q = *p;
    double edge[3][3], normal[3], area[3] = { 0 };

    widen(bone->normal, normal);
    for (int i = 0; i < 3; i++)
        widen(bone->edge[i], edge[i]);
    for (int i = 0; i < 3; i++) { /* side = unit(edge x normal) */
        double side[3];
        widen(bone->side[i], side);
        through_unit(side, sqrt(dot(edge[i], edge[i])), q.side[i]);
        add_cross(q.edge[i], normal, q.side[i]);
        add_cross(q.normal, q.side[i], edge[i]);
    }
    add_cross(area, edge[0], edge[1]); /* normal = unit(edge 0 x edge 1) */
    through_unit(normal, sqrt(dot(area, area)), q.normal);
    add_cross(q.edge[0], edge[1], q.normal);
    add_cross(q.edge[1], q.normal, edge[0]);
    memcpy(corner, q.corner, sizeof q.corner);
    for (int i = 0; i < 3; i++) {
        add(corner[i], q.edge[i], -1);
        add(corner[(i + 1) % 3], q.edge[i], 1);
    }
}
