/* SPDX-License-Identifier: BSD-2-Clause */
/* See inflate.h. The room for a gzip is found by doubling, never taken from the file's own word for it. */
#include <stdlib.h>
#include <string.h>

#include "shape/inflate.h"

#ifdef HAVE_ZLIB
#include <zlib.h>

enum { RAW = -15, GZIP = 15 + 16 };

static int begin(z_stream *z, int window, const uint8_t *data, size_t size)
{
    memset(z, 0, sizeof *z);
    z->next_in = (Bytef *)data;
    z->avail_in = (uInt)size;
    return size <= 0x7fffffff && inflateInit2(z, window) == Z_OK;
}

fap_err fap_inflate(const uint8_t *data, size_t size, uint8_t *out, size_t out_size)
{
    z_stream z;

    if (out_size > 0x7fffffff || !begin(&z, RAW, data, size))
        return FAP_E_DATA;
    z.next_out = out;
    z.avail_out = (uInt)out_size;
    const int status = inflate(&z, Z_FINISH);
    const int whole = status == Z_STREAM_END && z.avail_out == 0;
    inflateEnd(&z);
    return whole ? FAP_OK : FAP_E_DATA;
}

/* Inflates on into @p out, which grows up to @p max. */
static fap_err inflate_growing(z_stream *z, size_t max, uint8_t **out, size_t *out_size)
{
    size_t room = 64 << 10, used = 0;
    uint8_t *buf = malloc(room + 1);

    while (buf) {
        z->next_out = buf + used;
        z->avail_out = (uInt)(room - used);
        const int status = inflate(z, Z_NO_FLUSH);
        used = room - z->avail_out;
        if (used > max || (status != Z_OK && status != Z_STREAM_END) || (status == Z_OK && z->avail_out)) {
            free(buf);
            return used > max ? FAP_E_LIMIT : FAP_E_DATA;
        }
        if (status == Z_STREAM_END) {
            buf[used] = '\0';
            *out = buf;
            *out_size = used;
            return FAP_OK;
        }
        room *= 2;
        uint8_t *grown = realloc(buf, room + 1);
        if (!grown)
            free(buf);
        buf = grown;
    }
    return FAP_E_NOMEM;
}

fap_err fap_gunzip(const uint8_t *data, size_t size, size_t max, uint8_t **out, size_t *out_size)
{
    z_stream z;

    if (max > 1 << 30 || !begin(&z, GZIP, data, size))
        return FAP_E_DATA;
    const fap_err err = inflate_growing(&z, max, out, out_size);
    inflateEnd(&z);
    return err;
}

#else

fap_err fap_inflate(const uint8_t *data, size_t size, uint8_t *out, size_t out_size)
{
    (void)data, (void)size, (void)out, (void)out_size;
    return FAP_E_UNSUPPORTED;
}

fap_err fap_gunzip(const uint8_t *data, size_t size, size_t max, uint8_t **out, size_t *out_size)
{
    (void)data, (void)size, (void)max, (void)out, (void)out_size;
    return FAP_E_UNSUPPORTED;
}
#endif
