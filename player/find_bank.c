/* SPDX-License-Identifier: BSD-2-Clause */
/* See find_bank.h. */
#include <string.h>

#include "common/bank_file.h"
#include "common/tool.h"
#include "player/find_bank.h"

static int builtin_bank(fap_bank **bank, play_report *r)
{
    const fap_err err = fap_bank_builtin(bank, NULL);
    return err ? fault_set(&r->fault, EXIT_DATA, "the built-in face: %s", fap_strerror(err)) : 1;
}

static int load_bank(fap_bank **bank, const char *path, play_report *r)
{
    char where[FAP_ERROR_TEXT_SIZE];

    return bank_file_read(bank, path, where) ? fault_set(&r->fault, EXIT_DATA, "%s: %s", path, where) : 1;
}

int find_bank(fap_bank **bank, const char *name, play_report *r)
{
    char path[BANK_PATH_SIZE];

    *bank = NULL;
    if (name)
        return strcmp(name, "builtin") ? load_bank(bank, name, r) : builtin_bank(bank, r);
    if (bank_file_default(path))
        return load_bank(bank, path, r);
    play_report_note(r, "no default face here (make face builds it): this is the small built-in one");
    return builtin_bank(bank, r);
}
