/* SPDX-License-Identifier: BSD-2-Clause */
/* See find_bank.h. */
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "common/file.h"
#include "common/tool.h"
#include "player/find_bank.h"

enum { PATH_SIZE = 4096 };

static int builtin_bank(fap_bank **bank, play_report *r)
{
    const fap_err err = fap_bank_builtin(bank, NULL);
    return err ? fault_set(&r->fault, EXIT_DATA, "the built-in face: %s", fap_strerror(err)) : 1;
}

static int load_bank(fap_bank **bank, const char *path, play_report *r)
{
    FILE *f = fopen(path, "rb");

    if (!f)
        return fault_set(&r->fault, EXIT_DATA, "%s: %s", path, strerror(errno));
    const fap_reader in = file_reader(f);
    const fap_err err = fap_bank_read(bank, &in, NULL);
    fclose(f);
    return err ? fault_set(&r->fault, EXIT_DATA, "%s: not a face: %s", path, fap_strerror(err)) : 1;
}

/* @path: PATH_SIZE bytes; becomes the folder of this program with @below behind it. */
static int beside_program(char *path, const char *below)
{
    const ssize_t length = readlink("/proc/self/exe", path, PATH_SIZE - 1);

    if (length <= 0)
        return 0;
    path[length] = '\0';
    char *slash = strrchr(path, '/');
    const size_t room = PATH_SIZE - (size_t)(slash ? slash + 1 - path : 0);
    return slash && (size_t)snprintf(slash + 1, room, "%s", below) < room;
}

/* In the build tree first: whoever builds means the face that was built. */
static int default_path(char *path)
{
    static const char *const places[] = { "../default.fbank", "../share/libfap/default.fbank" };

    for (size_t i = 0; i < sizeof places / sizeof *places; i++)
        if (beside_program(path, places[i]) && !access(path, R_OK))
            return 1;
    return 0;
}

int find_bank(fap_bank **bank, const char *name, play_report *r)
{
    char path[PATH_SIZE];

    *bank = NULL;
    if (name)
        return strcmp(name, "builtin") ? load_bank(bank, name, r) : builtin_bank(bank, r);
    if (default_path(path))
        return load_bank(bank, path, r);
    play_report_note(r, "no default face here (make face builds it): this is the small built-in one");
    return builtin_bank(bank, r);
}
