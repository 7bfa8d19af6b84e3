/* SPDX-License-Identifier: BSD-2-Clause */
/* Pixels and rays. See <fap/studio/mirror.h>. */
#include <math.h>

#include <fap/studio/mirror.h>

void fap_camera_guess(fap_camera *cam, int width_px, int height_px, double view_deg)
{
    const double half = view_deg * 3.14159265358979323846 / 360, f = width_px / (2 * tan(half));

    *cam = (fap_camera){ width_px, height_px, f, f, (width_px - 1) / 2.0, (height_px - 1) / 2.0, { 0 } };
}

/* Pixel centres are whole numbers: the edges of the picture are at -0.5. */
void fap_camera_resize(fap_camera *cam, int width_px, int height_px)
{
    const double x = (double)width_px / cam->width_px, y = (double)height_px / cam->height_px;

    cam->fx_px *= x;
    cam->fy_px *= y;
    cam->cx_px = (cam->cx_px + 0.5) * x - 0.5;
    cam->cy_px = (cam->cy_px + 0.5) * y - 0.5;
    cam->width_px = width_px;
    cam->height_px = height_px;
}

static void bend(const fap_camera *cam, const double at[2], double bent[2])
{
    const double *k = cam->k, x = at[0], y = at[1], r2 = x * x + y * y;
    const double radial = 1 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]));

    bent[0] = x * radial + 2 * k[2] * x * y + k[3] * (r2 + 2 * x * x);
    bent[1] = y * radial + k[2] * (r2 + 2 * y * y) + 2 * k[3] * x * y;
}

/* What bends to @p bent, by going back by the error again and again: lenses bend little. */
void fap_camera_ray(const fap_camera *cam, const double pixel[2], double ray[2])
{
    enum { STEPS = 20 };
    const double bent[2] = { (pixel[0] - cam->cx_px) / cam->fx_px, (pixel[1] - cam->cy_px) / cam->fy_px };

    ray[0] = bent[0];
    ray[1] = bent[1];
    for (int i = 0; i < STEPS; i++) {
        double got[2];
        bend(cam, ray, got);
        ray[0] += bent[0] - got[0];
        ray[1] += bent[1] - got[1];
    }
}

int fap_camera_project(const fap_camera *cam, const double place[3], double pixel[2])
{
    double bent[2];

    if (!(place[2] > 0))
        return 0;
    bend(cam, (const double[2]){ place[0] / place[2], place[1] / place[2] }, bent);
    pixel[0] = cam->fx_px * bent[0] + cam->cx_px;
    pixel[1] = cam->fy_px * bent[1] + cam->cy_px;
    return 1;
}
