/* SPDX-License-Identifier: BSD-2-Clause */
/* Any text as a file of FAPU: five lengths that make sense, or words on what is wrong. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "common/fapu_file.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static int makes_sense(float mm)
{
    return mm > 0 && mm <= 1000;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char where[FAP_ERROR_TEXT_SIZE] = "";
    char *text = malloc(size + 1);
    fap_fapu f;

    if (!text)
        return 0;
    if (size)
        memcpy(text, data, size);
    text[size] = '\0';
    const fap_err err = fapu_file_parse(text, &f, where);
    free(text);
    const int sound = makes_sense(f.irisd_mm) && makes_sense(f.es_mm) && makes_sense(f.ens_mm) &&
                      makes_sense(f.mns_mm) && makes_sense(f.mw_mm);
    if (err == FAP_OK ? !sound : !*where || !memchr(where, '\0', sizeof where))
        abort();
    return 0;
}
