/* SPDX-License-Identifier: BSD-2-Clause */
/* See fit_file.h. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/file.h"
#include "common/fit_file.h"

fap_err fit_file_read(fap_fit **fit, const char *path, char *where)
{
    uint8_t *text;
    size_t size;

    *fit = NULL;
    errno = 0;
    fap_err err = file_read(path, FAP_FIT_MAX_TEXT, &text, &size);
    if (err) {
        snprintf(where, FAP_ERROR_TEXT_SIZE, "%s",
                 err == FAP_E_IO && errno ? strerror(errno) : fap_strerror(err));
        return err;
    }
    err = fap_fit_parse(fit, (const char *)text, size, NULL, where);
    free(text);
    return err;
}

int fit_file_name(const char *stream, char *path, size_t room)
{
    const char *slash = strrchr(stream, '/'), *dot = strrchr(stream, '.');
    const size_t length = dot && (!slash || dot > slash + 1) ? (size_t)(dot - stream) : strlen(stream);

    if (!strcmp(stream, "-"))
        return 0;
    return (size_t)snprintf(path, room, "%.*s.fit", (int)length, stream) < room;
}

int fit_file_beside(const char *stream, char *path, size_t room)
{
    return fit_file_name(stream, path, room) && !access(path, R_OK);
}
