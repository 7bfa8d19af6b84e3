/* SPDX-License-Identifier: BSD-2-Clause */
/* See picture_file.h. */
#include <errno.h>
#include <string.h>

#include "common/file.h"
#include "common/tool.h"
#include "player/sinks/picture_file.h"

int picture_write(const image *picture, const char *path, int level, fault *f)
{
    out_file file;

    if (out_file_open(&file, path))
        return fault_set(f, EXIT_DATA, "%s: %s", path, strerror(errno));
    fap_err err = image_write_png(picture, file.stream, level);
    if (err)
        out_file_abandon(&file);
    else
        err = out_file_commit(&file);
    if (err == FAP_E_UNSUPPORTED)
        return fault_set(f, EXIT_MISSING,
                         "this fapplay was built without libpng; install it and build again");
    return err ? fault_set(f, EXIT_DATA, "%s: %s", path, errno ? strerror(errno) : fap_strerror(err)) : 1;
}
