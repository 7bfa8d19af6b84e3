/* SPDX-License-Identifier: BSD-2-Clause */
/* See plot.h. */
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "common/file.h"
#include "common/canvas/canvas.h"
#include "encoder/plot/curves.h"
#include "encoder/plot/map.h"
#include "encoder/plot/plot.h"

enum { WIDTH_PX = 1400, HEAD_PX = 62 };

static int has_ending(const char *path, const char *ending)
{
    const char *dot = strrchr(path, '.');
    return dot && !strcasecmp(dot, ending);
}

int plot_name_known(const char *path)
{
    return has_ending(path, ".png") || has_ending(path, ".svg");
}

int plot_available(void)
{
    return canvas_available();
}

static void draw_head(canvas *c, const plot_content *p)
{
    canvas_colour(c, 0x111111, 1);
    canvas_text(c, 20, 28, 19, CANVAS_LEFT, p->title);
    canvas_colour(c, 0x555555, 1);
    canvas_text(c, 20, 49, 12, CANVAS_LEFT, p->subtitle);
}

static fap_err draw(canvas *c, const plot_content *p, char *where)
{
    draw_head(c, p);
    if (!p->bank)
        return curves_draw(c, p, HEAD_PX, WIDTH_PX);
    const fap_err err = map_draw(c, p, HEAD_PX, WIDTH_PX, where);
    return err == FAP_OK ? curves_draw(c, p, HEAD_PX + MAP_HEIGHT_PX, WIDTH_PX) : err;
}

static fap_err save(canvas *c, const char *path)
{
    out_file out;

    errno = 0;
    fap_err err = out_file_open(&out, path);
    if (err != FAP_OK)
        return err;
    const fap_writer writer = file_writer(out.stream);
    err = canvas_save(c, &writer);
    if (err == FAP_OK)
        return out_file_commit(&out);
    const int why = errno;
    out_file_abandon(&out);
    errno = why;
    return err;
}

fap_err plot_write(const char *path, const plot_content *p, char *where)
{
    const int height = HEAD_PX + (p->bank ? MAP_HEIGHT_PX : 0) + curves_height(p);
    canvas *c;

    *where = '\0';
    if (!p->frame_count)
        return FAP_E_NOT_FOUND;
    fap_err err =
        canvas_open(&c, has_ending(path, ".svg") ? CANVAS_SVG : CANVAS_PNG, WIDTH_PX, height, where);
    if (err != FAP_OK)
        return err;
    err = draw(c, p, where);
    if (err == FAP_OK)
        err = save(c, path);
    canvas_close(&c);
    return err;
}
