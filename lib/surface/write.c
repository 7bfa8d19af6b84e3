/* SPDX-License-Identifier: BSD-2-Clause */
/* Surfaces to files. */
#include <fap/studio/surface.h>

#include "shape/bytes.h"
#include "take/text_out.h"

enum { DECIMALS = 6 };

static void put_row(text_out *o, const char *word, const float *number, int count)
{
    text_put(o, word);
    for (int i = 0; i < count; i++) {
        text_put(o, " ");
        text_put_number(o, (double)number[i], DECIMALS);
    }
    text_put(o, "\n");
}

static void put_face(text_out *o, const fap_surface *s, const uint32_t v[3])
{
    text_put(o, "f");
    for (int c = 0; c < 3; c++) {
        text_put(o, " ");
        text_put_number(o, (double)v[c] + 1, 0);
        if (!s->uv)
            continue;
        text_put(o, "/");
        text_put_number(o, (double)v[c] + 1, 0);
    }
    text_put(o, "\n");
}

fap_err fap_surface_write_obj(const fap_surface *s, const fap_writer *out)
{
    text_out o = { .to = out };

    for (uint32_t i = 0; i < s->vertex_count && !o.failed; i++)
        put_row(&o, "v", s->position[i], 3);
    for (uint32_t i = 0; s->uv && i < s->vertex_count && !o.failed; i++)
        put_row(&o, "vt", s->uv[i], 2);
    for (uint32_t t = 0; t < s->triangle_count && !o.failed; t++)
        put_face(&o, s, s->triangle[t]);
    return o.failed ? FAP_E_IO : FAP_OK;
}

static int put_ply_header(const fap_surface *s, const fap_writer *out)
{
    text_out o = { .to = out };

    text_put(&o, "ply\nformat binary_little_endian 1.0\nelement vertex ");
    text_put_number(&o, (double)s->vertex_count, 0);
    text_put(&o, "\nproperty float x\nproperty float y\nproperty float z\n");
    if (s->colour)
        text_put(&o, "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\n");
    if (s->uv)
        text_put(&o, "property float u\nproperty float v\n");
    text_put(&o, "element face ");
    text_put_number(&o, (double)s->triangle_count, 0);
    text_put(&o, "\nproperty list uchar int vertex_indices\nend_header\n");
    return !o.failed;
}

fap_err fap_surface_write_ply(const fap_surface *s, const fap_writer *out)
{
    fap_bytes b = { 0 };

    if (!put_ply_header(s, out))
        return FAP_E_IO;
    for (uint32_t i = 0; i < s->vertex_count; i++) {
        for (int a = 0; a < 3; a++)
            fap_bytes_float(&b, s->position[i][a]);
        if (s->colour)
            fap_bytes_put(&b, s->colour[i], sizeof s->colour[i]);
        for (int a = 0; s->uv && a < 2; a++)
            fap_bytes_float(&b, s->uv[i][a]);
    }
    for (uint32_t t = 0; t < s->triangle_count; t++) {
        fap_bytes_8(&b, 3);
        for (int c = 0; c < 3; c++)
            fap_bytes_32(&b, s->triangle[t][c]);
    }
    const int ok = !b.failed && !out->write(out->user, b.data, b.size);
    const fap_err err = b.failed ? FAP_E_NOMEM : ok ? FAP_OK : FAP_E_IO;
    fap_bytes_free(&b);
    return err;
}
