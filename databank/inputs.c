/* SPDX-License-Identifier: BSD-2-Clause */
/* See inputs.h. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "common/bank_file.h"
#include "common/file.h"
#include "common/tool.h"
#include "databank/inputs.h"
#include "databank/range/range_file.h"

static const size_t most_scan = (size_t)4 << 30, most_landmarks = (size_t)1 << 22;

int inputs_blame(fault *f, const char *path, fap_err err, const char *where)
{
    return fault_set(f, err == FAP_E_UNSUPPORTED ? EXIT_MISSING : tool_exit_code(err), "%s: %s", path,
                     *where                     ? where
                     : err == FAP_E_IO && errno ? strerror(errno)
                                                : fap_strerror(err));
}

int inputs_bank(fap_bank **out, const char *path, fault *f)
{
    char found[BANK_PATH_SIZE], where[FAP_ERROR_TEXT_SIZE] = "";

    if (!path && bank_file_default(found))
        path = found;
    const fap_err err =
        !path || !strcmp(path, "builtin") ? fap_bank_builtin(out, NULL) : bank_file_read(out, path, where);
    return err == FAP_OK || inputs_blame(f, path ? path : "builtin", err, where);
}

int inputs_surface(fap_surface **out, const char *path, fault *f)
{
    char where[FAP_ERROR_TEXT_SIZE] = "";
    uint8_t *data;
    size_t size;

    errno = 0;
    fap_err err = file_read(path, most_scan, &data, &size);
    if (err == FAP_OK) {
        err = fap_surface_read(out, data, size, NULL, where);
        if (err == FAP_E_UNKNOWN_FORMAT && range_file_may_be(data, size))
            err = range_file_read_beside(out, path, data, size, where);
        free(data);
    }
    return err == FAP_OK || inputs_blame(f, path, err == FAP_E_UNSUPPORTED ? FAP_E_DATA : err, where);
}

int inputs_scan(fap_surface **out, const char *path, fault *f)
{
    return inputs_surface(out, path, f) &&
           ((*out)->triangle_count ||
            fault_set(f, EXIT_DATA, "%s: points without triangles; mesh them first", path));
}

int inputs_landmarks(fap_take **out, const char *path, const fap_surface *scan, fault *f)
{
    char where[FAP_ERROR_TEXT_SIZE] = "";
    uint8_t *data;
    size_t size;

    errno = 0;
    fap_err err = file_read(path, most_landmarks, &data, &size);
    if (err == FAP_OK) {
        err = fap_landmarks_read(out, data, size, scan, NULL, where);
        free(data);
    }
    return err == FAP_OK || inputs_blame(f, path, err, where);
}
