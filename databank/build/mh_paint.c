/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Colours by place at rest: skin with warmer cheeks, nose, ears and lid rims, lips and mouth from the texture
 * masks, brows as a tapering band, teeth and tongue. The fourth byte is gloss.
 */
#include <math.h>
#include <string.h>

#include "databank/build/makehuman.h"

typedef struct rgb {
    float r, g, b;
} rgb;

static const rgb skin = { 0.80f, 0.615f, 0.515f }, blush = { 0.80f, 0.50f, 0.42f },
                 lip = { 0.70f, 0.37f, 0.35f }, inside = { 0.48f, 0.17f, 0.17f },
                 brow = { 0.22f, 0.15f, 0.105f }, shade = { 0.62f, 0.44f, 0.37f },
                 tooth = { 0.97f, 0.95f, 0.90f }, gum = { 0.70f, 0.38f, 0.37f },
                 tongue = { 0.72f, 0.36f, 0.36f };

static rgb mix(rgb a, rgb b, float t)
{
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    return (rgb){ a.r + t * (b.r - a.r), a.g + t * (b.g - a.g), a.b + t * (b.b - a.b) };
}

static float smooth(float low, float high, float x)
{
    const float t = fminf(1, fmaxf(0, (x - low) / (high - low)));
    return t * t * (3 - 2 * t);
}

static float bell(const float p[3], const float centre[3], float radius)
{
    const float x = p[0] - centre[0], y = p[1] - centre[1], z = p[2] - centre[2];
    return expf(-(x * x + y * y + z * z) / (radius * radius));
}

/* Sums bells at feature points; @p names ends with NULL. */
static float bells(const mh_face *f, const float p[3], const char *const *names, float radius)
{
    float sum = 0;

    for (; *names; names++) {
        const float *centre = mh_face_point(f, *names);
        sum += centre ? bell(p, centre, radius) : 0;
    }
    return fminf(1, sum);
}

/* Height and distance of the brow's line at |x|, through the three points of that side; a parabola is close
 * enough. */
static float brow_line(const float a[3], const float b[3], const float c[3], float x)
{
    const float la = (x - b[0]) * (x - c[0]) / ((a[0] - b[0]) * (a[0] - c[0]));
    const float lb = (x - a[0]) * (x - c[0]) / ((b[0] - a[0]) * (b[0] - c[0]));
    const float lc = (x - a[0]) * (x - b[0]) / ((c[0] - a[0]) * (c[0] - b[0]));
    return la * a[1] + lb * b[1] + lc * c[1];
}

static float brow_cover(const mh_face *f, const float p[3])
{
    const int left = p[0] > 0;
    const float *a = mh_face_point(f, left ? "4.1" : "4.2"), *b = mh_face_point(f, left ? "4.3" : "4.4");
    const float *c = mh_face_point(f, left ? "4.5" : "4.6");

    if (!a || !b || !c || p[2] < c[2] - 15)
        return 0;
    const float along = (p[0] - a[0]) / (c[0] - a[0]);
    const float below = brow_line(a, b, c, p[0]) - 3 - p[1];
    const float half = (3.3f - 2 * smooth(0.3f, 1, along)) * (0.45f + 0.55f * smooth(-0.1f, 0.22f, along));
    const float ends = smooth(-0.06f, 0.06f, along) * (1 - smooth(0.82f, 1.02f, along));
    return ends * (1 - smooth(half - 1.3f, half + 1.3f, fabsf(below)));
}

/* The rims of the lids, where lashes would grow: skin that all but touches the eyeball; the lower one is
 * fainter. */
static float lash_cover(const mh_face *f, const float p[3])
{
    const int right = p[0] < 0;
    const float *c = f->eye_centre[right], x = p[0] - c[0], y = p[1] - c[1], z = p[2] - c[2];
    const float over = sqrtf(x * x + y * y + z * z) - f->eye_radius[right];

    return z < 0 ? 0 : (1 - smooth(1.6f, 3, over)) * (0.35f + 0.4f * smooth(-2, 2, y));
}

static void set(mh_face *f, uint32_t v, rgb c, float gloss)
{
    f->colour[v][0] = (uint8_t)lrintf(255 * c.r);
    f->colour[v][1] = (uint8_t)lrintf(255 * c.g);
    f->colour[v][2] = (uint8_t)lrintf(255 * c.b);
    f->colour[v][3] = (uint8_t)lrintf(255 * gloss);
}

static void paint_skin(mh_face *f, uint32_t v, const float uv[2])
{
    static const char *const warm[] = { "5.3", "5.4", NULL }, *const nose[] = { "9.3", "9.1", "9.2", NULL },
                             *const ears[] = { "10.1", "10.2", "10.3", "10.4", "10.5", "10.6", NULL },
                             *const chin[] = { "2.10", NULL }, *const eyes[] = { "3.5", "3.6", NULL },
                             *const corners[] = { "2.4", "2.5", NULL };
    const float *p = f->position[v];
    const mh_source *s = f->source;
    const float lips = mask_sample(&s->lips, uv[0], uv[1]), mouth = mask_sample(&s->mouth, uv[0], uv[1]);

    rgb c = mix(skin, blush, 0.40f * bells(f, p, warm, 19) + 0.32f * bells(f, p, nose, 11));
    c = mix(c, blush, 0.5f * bells(f, p, ears, 16) + 0.15f * bells(f, p, chin, 12));
    c = mix(c, shade, 0.45f * bells(f, p, eyes, 17));
    c = mix(c, lip, fmaxf(lips, 0.75f * bells(f, p, corners, 2.2f)));
    c = mix(c, inside, mouth);
    c = mix(c, shade, 0.7f * mask_sample(&s->lids, uv[0], uv[1]));
    c = mix(c, brow, lash_cover(f, p));
    c = mix(c, brow, 0.92f * brow_cover(f, p));
    set(f, v, c, 0.14f + 0.10f * bells(f, p, nose, 11) + 0.22f * lips * (1 - mouth) + 0.45f * mouth);
}

/* Sideways ends of the front teeth, from the midline; the ridge is one piece, shade alone parts it. */
static float tooth_edge(float x, int lower)
{
    static const float upper_mm[] = { 0, 8, 14.5f, 21, 26 }, lower_mm[] = { 0, 5.5f, 11.5f, 18, 24 };
    float nearest = 9;

    for (int i = 0; i < 5; i++)
        nearest = fminf(nearest, fabsf(fabsf(x) - (lower ? lower_mm : upper_mm)[i]));
    return 1 - smooth(0.2f, 1.3f, nearest);
}

/* The roots are gum. */
static void paint_teeth(mh_face *f, uint32_t v, int lower)
{
    const float *edge = mh_face_point(f, lower ? "9.11" : "9.10"),
                *root = mh_face_point(f, lower ? "9.9" : "9.8");
    const float *p = f->position[v], t = edge && root ? (p[1] - edge[1]) / (root[1] - edge[1]) : 0;
    const rgb ivory = mix(tooth, shade, 0.4f * tooth_edge(p[0], lower));

    set(f, v, mix(ivory, gum, smooth(0.5f, 0.68f, t)), 0.75f);
}

void mh_paint(mh_face *f)
{
    for (int i = 0; i < MH_PATCHES; i++)
        for (uint32_t v = 0; v < f->patch[i].count; v++) {
            const uint32_t at = f->patch[i].first + v;
            if (i == MH_SKIN)
                paint_skin(f, at, f->patch[i].uv[v]);
            else if (i == MH_TONGUE)
                set(f, at, tongue, 0.7f);
            else
                paint_teeth(f, at, i == MH_TEETH_LOWER);
        }
}
