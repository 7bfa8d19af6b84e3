/* SPDX-License-Identifier: BSD-2-Clause */
/* See bank_file.h. */
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "common/bank_file.h"
#include "common/file.h"

fap_err bank_file_read(fap_bank **bank, const char *path, char *where)
{
    FILE *f = fopen(path, "rb");

    *bank = NULL;
    if (!f) {
        snprintf(where, FAP_ERROR_TEXT_SIZE, "%s", strerror(errno));
        return FAP_E_IO;
    }
    const fap_reader in = file_reader(f);
    const fap_err err = fap_bank_read(bank, &in, NULL);
    fclose(f);
    if (err)
        snprintf(where, FAP_ERROR_TEXT_SIZE, "not a face: %s", fap_strerror(err));
    return err;
}

/* @path: BANK_PATH_SIZE bytes; becomes the folder of this program with @below behind it. */
static int beside_program(char *path, const char *below)
{
    const ssize_t length = readlink("/proc/self/exe", path, BANK_PATH_SIZE - 1);

    if (length <= 0)
        return 0;
    path[length] = '\0';
    char *slash = strrchr(path, '/');
    const size_t room = BANK_PATH_SIZE - (size_t)(slash ? slash + 1 - path : 0);
    return slash && (size_t)snprintf(slash + 1, room, "%s", below) < room;
}

int bank_file_default(char *path)
{
    static const char *const places[] = { "../default.fbank", "../share/libfap/default.fbank" };

    for (size_t i = 0; i < sizeof places / sizeof *places; i++)
        if (beside_program(path, places[i]) && !access(path, R_OK))
            return 1;
    return 0;
}
