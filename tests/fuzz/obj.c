/* SPDX-License-Identifier: BSD-2-Clause */
/* Fuzzes the OBJ reader, and the subdivision with what it gives. */
#include <stdlib.h>
#include <string.h>

#include "shape/obj.h"
#include "shape/subdivide.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void split(const fap_obj *o)
{
    uint32_t *start = malloc((o->face_count + 1u) * sizeof *start);
    fap_subdivision s;

    if (!start)
        return;
    for (uint32_t f = 0; f < o->face_count; f++)
        start[f] = o->face[f].first;
    start[o->face_count] = o->corner_count;
    if (fap_subdivide(&s, &(fap_polygons){ o->face_count, o->position_count, start, o->vertex }) == FAP_OK) {
        float(*out)[3] = malloc((s.vertex_count + 1u) * sizeof *out);
        if (out)
            fap_subdivision_apply(&s, (const float(*)[3])o->position, out);
        free(out);
        fap_subdivision_free(&s);
    }
    free(start);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char *text = malloc(size + 1);
    fap_obj o;

    if (!text)
        return 0;
    if (size)
        memcpy(text, data, size);
    text[size] = '\0';
    if (fap_obj_parse(&o, text, size, NULL) == FAP_OK) {
        split(&o);
        fap_obj_free(&o);
    }
    free(text);
    return 0;
}
