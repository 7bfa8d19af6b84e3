/* SPDX-License-Identifier: BSD-2-Clause */
/* See dress.h. */
#include <stdio.h>
#include <string.h>

#include "common/tool.h"
#include "player/dress.h"

static int parse_colour(const char *text, uint8_t rgb[3])
{
    unsigned value[3];
    int end = 0;

    if (strspn(text, "0123456789abcdefABCDEF") != 6 || text[6])
        return 0;
    if (sscanf(text, "%2x%2x%2x%n", &value[0], &value[1], &value[2], &end) != 3 || end != 6)
        return 0;
    for (int i = 0; i < 3; i++)
        rgb[i] = (uint8_t)value[i];
    return 1;
}

int dress_parse_background(dress_options *o, const char *text)
{
    o->picture = NULL;
    if (text[0] == '#') {
        o->backdrop = BACKDROP_COLOUR;
        return parse_colour(text + 1, o->rgb);
    }
    o->backdrop = !strcmp(text, "studio") ? BACKDROP_STUDIO
                  : !strcmp(text, "none") ? BACKDROP_NOTHING
                                          : BACKDROP_PICTURE;
    if (o->backdrop == BACKDROP_PICTURE)
        o->picture = text;
    return text[0] != '\0';
}

/* @path NULL: no picture, which is fine. */
static int read_picture(image *im, const char *path, fault *f)
{
    const fap_err err = path ? image_read_png(im, path) : FAP_OK;

    if (err == FAP_E_UNSUPPORTED)
        return fault_set(f, EXIT_MISSING,
                         "this fapplay was built without libpng; install it and build again");
    if (err == FAP_E_DATA)
        return fault_set(f, EXIT_DATA, "%s: no PNG picture; others can be converted (convert in.jpg out.png)",
                         path);
    return err ? fault_set(f, EXIT_DATA, "%s: %s", path, fap_strerror(err)) : 1;
}

static int put_on(renderer *r, const dress_options *o, const image *picture, const image *skin, fault *f)
{
    const render_look look = {
        .backdrop = o->backdrop,
        .rgb = { o->rgb[0], o->rgb[1], o->rgb[2] },
        .picture = o->picture ? picture : NULL,
        .skin = o->skin ? skin : NULL,
    };
    char where[FAP_ERROR_TEXT_SIZE];
    const fap_err err = renderer_dress(r, &look, where);

    return err ? fault_set(f, EXIT_DATA, "%s", where[0] ? where : fap_strerror(err)) : 1;
}

int dress_renderer(renderer *r, const dress_options *o, fault *f)
{
    image picture = { 0 }, skin = { 0 };

    if (o->backdrop == BACKDROP_STUDIO && !o->skin)
        return 1;
    const int ok = read_picture(&picture, o->picture, f) && read_picture(&skin, o->skin, f) &&
                   put_on(r, o, &picture, &skin, f);
    image_free(&picture);
    image_free(&skin);
    return ok;
}
