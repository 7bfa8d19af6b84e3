/* SPDX-License-Identifier: BSD-2-Clause */
/* What an encoder of bits needs beside numbers: the face that errors are measured on, the interpolation table. */
#ifndef ENCODER_SETUP_H
#define ENCODER_SETUP_H

#include "encoder/options.h"
#include "encoder/source.h"

typedef struct encoder_setup {
    fap_sensitivity sensitivity;
    char face[128];          /* the face's name; "" for a typical one */
    const fap_fit *fit;      /* NULL: none */
    fap_fit *learnt;         /* the setup's own */
    int learnt_gives;        /* FAPs that it gives */
    fap_encoder_config bits; /* what the options say, with these */
} encoder_setup;

/* --bank: a file, or "builtin". */
fap_err encoder_bank_read(fap_bank **bank, const char *path, char *where);

/*
 * @p fit    of --fit, or NULL; must live as long as the setup
 * @p path   set to the file that is to blame where the error is in one
 * @p where  FAP_ERROR_TEXT_SIZE bytes
 */
fap_err encoder_setup_open(encoder_setup *s, const options *opt, const fap_fit *fit, const frame_source *src,
                           const char **path, char *where);
void encoder_setup_close(encoder_setup *s);

#endif
