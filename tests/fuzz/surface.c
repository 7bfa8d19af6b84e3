/* SPDX-License-Identifier: BSD-2-Clause */
/* Surfaces of every format: read, counted, written. */
#include <stddef.h>
#include <stdint.h>

#include <fap/studio/surface.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static int swallow(void *user, const void *data, size_t size)
{
    (void)user, (void)data, (void)size;
    return 0;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const fap_writer out = { swallow, NULL };
    char where[FAP_ERROR_TEXT_SIZE];
    fap_surface_census census;
    fap_surface *s;

    if (fap_surface_read(&s, data, size, NULL, where) != FAP_OK)
        return 0;
    (void)!fap_surface_count(s, &census);
    (void)!fap_surface_write_obj(s, &out);
    (void)!fap_surface_write_ply(s, &out);
    fap_surface_close(&s);
    return 0;
}
