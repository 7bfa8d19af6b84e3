/* SPDX-License-Identifier: BSD-2-Clause */
/* See phonemize.h. */
#define _XOPEN_SOURCE 700 /* readlink */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/child_pipe.h"
#include "common/tool.h"
#include "encoder/speech/phonemize.h"

static const char program[] = "fap-phonemes";
enum { PATH_SIZE = 4096, CHUNK = 1 << 16, MOST = 1 << 24 };

static void find_program(char path[PATH_SIZE])
{
    const ssize_t length = readlink("/proc/self/exe", path, PATH_SIZE - sizeof program - 1);

    if (length > 0) {
        path[length] = '\0';
        char *slash = strrchr(path, '/');
        if (slash) {
            memcpy(slash + 1, program, sizeof program);
            if (!access(path, X_OK))
                return;
        }
    }
    memcpy(path, program, sizeof program);
}

/* Everything it says; NULL: no memory, or more than any text has. */
static uint8_t *read_all(child_pipe *c, size_t *size)
{
    uint8_t *data = NULL;
    long got;

    *size = 0;
    do {
        uint8_t *grown = *size < MOST ? realloc(data, *size + CHUNK) : NULL;
        if (!grown) {
            free(data);
            return NULL;
        }
        data = grown;
        got = child_pipe_read(c, data + *size, CHUNK);
        *size += got > 0 ? (size_t)got : 0;
    } while (got > 0);
    return data;
}

fap_err phonemize(const char *text, const char *language, uint8_t **tsv, size_t *size, char *where)
{
    char path[PATH_SIZE];
    char *const argv[] = { path, (char *)"--language", (char *)language, (char *)"--", (char *)text, NULL };
    child_pipe c;

    *tsv = NULL;
    find_program(path);
    const int err = child_pipe_start(&c, argv, CHILD_WRITES);
    if (err) {
        snprintf(where, FAP_ERROR_TEXT_SIZE,
                 "%s: %s; it comes with libfap where libespeak-ng-dev is installed", program,
                 err == ENOENT ? "not there" : strerror(err));
        return FAP_E_UNSUPPORTED;
    }
    *tsv = read_all(&c, size);
    const int status = child_pipe_finish(&c);
    if (*tsv && !status)
        return FAP_OK;
    free(*tsv);
    *tsv = NULL;
    if (status == EXIT_MISSING || status == 127) {
        snprintf(where, FAP_ERROR_TEXT_SIZE, "%s cannot be run; is espeak-ng-data installed?", program);
        return FAP_E_UNSUPPORTED;
    }
    snprintf(where, FAP_ERROR_TEXT_SIZE, "%s made nothing of it (exit status %d)", program, status);
    return FAP_E_DATA;
}
