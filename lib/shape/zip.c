/* SPDX-License-Identifier: BSD-2-Clause */
/* See zip.h. Sizes and the CRC are the central directory's; local headers only say where the bytes start. */
#include <stdlib.h>
#include <string.h>

#include "bank/format.h"
#include "shape/inflate.h"
#include "shape/zip.h"

enum { END_SIZE = 22, CENTRAL_SIZE = 46, LOCAL_SIZE = 30, STORED = 0, DEFLATED = 8, MAX_COMMENT = 65535 };

static uint32_t get16(const uint8_t *p)
{
    return p[0] | (uint32_t)p[1] << 8;
}

static uint32_t get32(const uint8_t *p)
{
    return get16(p) | get16(p + 2) << 16;
}

/* The end record stands before a comment of unknown length: searched from the back. */
static const uint8_t *find_end(const uint8_t *data, size_t size)
{
    for (size_t back = END_SIZE; back <= size && back <= END_SIZE + MAX_COMMENT; back++)
        if (!memcmp(data + size - back, "PK\5\6", 4))
            return data + size - back;
    return NULL;
}

fap_err fap_zip_open(fap_zip *zip, const void *data, size_t size)
{
    const uint8_t *end = size >= END_SIZE ? find_end(data, size) : NULL;

    if (!end)
        return FAP_E_UNKNOWN_FORMAT;
    *zip = (fap_zip){ data, size, get32(end + 16), get16(end + 10) };
    return zip->directory <= size ? FAP_OK : FAP_E_DATA;
}

/* The central header of @p name, NULL where it is not there or the directory breaks off. */
static const uint8_t *find_entry(const fap_zip *zip, const char *name)
{
    const size_t length = strlen(name);
    size_t at = zip->directory;

    for (uint32_t i = 0; i < zip->count; i++) {
        const uint8_t *e = zip->data + at;
        if (zip->size - at < CENTRAL_SIZE || memcmp(e, "PK\1\2", 4))
            return NULL;
        const size_t name_size = get16(e + 28),
                     entry = CENTRAL_SIZE + name_size + get16(e + 30) + get16(e + 32);
        if (zip->size - at < entry)
            return NULL;
        if (name_size == length && !memcmp(e + CENTRAL_SIZE, name, length))
            return e;
        at += entry;
    }
    return NULL;
}

/* Where the packed bytes of a central header's entry stand; NULL where they do not fit into the file. */
static const uint8_t *packed_bytes(const fap_zip *zip, const uint8_t *e)
{
    const size_t local = get32(e + 42), packed = get32(e + 20);

    if (local > zip->size || zip->size - local < LOCAL_SIZE || memcmp(zip->data + local, "PK\3\4", 4))
        return NULL;
    const size_t head = LOCAL_SIZE + get16(zip->data + local + 26) + get16(zip->data + local + 28);
    if (zip->size - local < head || zip->size - local - head < packed)
        return NULL;
    return zip->data + local + head;
}

static fap_err unpack(int method, const uint8_t *in, size_t packed, uint8_t *out, size_t size)
{
    if (method == DEFLATED)
        return fap_inflate(in, packed, out, size);
    if (method != STORED)
        return FAP_E_UNSUPPORTED;
    if (packed != size)
        return FAP_E_DATA;
    memcpy(out, in, size);
    return FAP_OK;
}

fap_err fap_zip_extract(const fap_zip *zip, const char *name, size_t max, uint8_t **out, size_t *out_size)
{
    const uint8_t *e = find_entry(zip, name);
    if (!e)
        return FAP_E_NOT_FOUND;
    const size_t packed = get32(e + 20), size = get32(e + 24);
    const uint8_t *in = packed_bytes(zip, e);
    if (!in)
        return FAP_E_DATA;
    if (size > max)
        return FAP_E_LIMIT;
    uint8_t *buf = malloc(size + 1);
    if (!buf)
        return FAP_E_NOMEM;
    fap_err err = unpack((int)get16(e + 10), in, packed, buf, size);
    if (!err && fbank_crc32(buf, size) != get32(e + 16))
        err = FAP_E_DATA;
    if (err) {
        free(buf);
        return err;
    }
    buf[size] = '\0';
    *out = buf;
    *out_size = size;
    return FAP_OK;
}
