/* SPDX-License-Identifier: BSD-2-Clause */
/* See setup.h. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/bank_file.h"
#include "encoder/setup.h"

fap_err encoder_bank_read(fap_bank **bank, const char *path, char *where)
{
    return strcmp(path, "builtin") ? bank_file_read(bank, path, where) : fap_bank_builtin(bank, NULL);
}

/* Millimetres are those of --bank, of the face that fapplay would show, or of a typical one. */
static fap_err measure_face(encoder_setup *s, const options *opt, const char **path, char *where)
{
    char found[BANK_PATH_SIZE];
    fap_bank *bank;
    fap_err err;

    if (opt->bank_path) {
        *path = opt->bank_path;
        err = encoder_bank_read(&bank, opt->bank_path, where);
    } else if (bank_file_default(found)) {
        err = bank_file_read(&bank, found, where);
    } else {
        fap_sensitivity_typical(&s->sensitivity);
        return FAP_OK;
    }
    if (err != FAP_OK && !opt->bank_path) {
        fap_sensitivity_typical(&s->sensitivity); /* nobody asked for this file */
        return FAP_OK;
    }
    if (err != FAP_OK)
        return err;
    snprintf(s->face, sizeof s->face, "%s", fap_bank_name(bank));
    fap_sensitivity_of_bank(bank, &s->sensitivity);
    fap_bank_close(&bank);
    return FAP_OK;
}

static fap_err learn(encoder_setup *s, const options *opt, const frame_source *src)
{
    fap_fit_learn_config cfg;
    fap_frame *frames;
    size_t count;

    fap_fit_learn_config_init(&cfg);
    cfg.sensitivity = &s->sensitivity;
    if (opt->bits.mode == FAP_ENCODE_ERROR)
        cfg.error_nm = (uint32_t)lround(opt->bits.max_error_mm * 1e6 / 2);
    if (opt->bits.mode == FAP_ENCODE_QUANT)
        cfg.quant = opt->bits.quant;
    fap_err err = frame_source_load(src, &frames, &count);
    if (err != FAP_OK)
        return err;
    err = fap_fit_learn(&s->learnt, frames, count, &cfg);
    free(frames);
    for (int fap = 1; err == FAP_OK && fap <= FAP_COUNT; fap++)
        s->learnt_gives += fap_fit_gives(s->learnt, fap);
    return err;
}

fap_err encoder_setup_open(encoder_setup *s, const options *opt, const fap_fit *fit, const frame_source *src,
                           const char **path, char *where)
{
    *s = (encoder_setup){ .fit = fit, .bits = opt->bits };
    *path = NULL;
    *where = '\0';
    fap_err err = measure_face(s, opt, path, where);
    if (err == FAP_OK && opt->learn_path) {
        *path = opt->learn_path;
        err = learn(s, opt, src);
        s->fit = s->learnt;
    }
    if (err != FAP_OK)
        return err;
    s->bits.sensitivity = &s->sensitivity;
    s->bits.fit = s->fit;
    s->bits.rate_hz = src->rate_hz;
    /* A file has no borders between packets. */
    s->bits.plane_codes |= !s->bits.look_ahead;
    /* Whoever gives a table wants it used. */
    if (s->fit && s->bits.derive < 0)
        s->bits.derive = 1;
    return FAP_OK;
}

void encoder_setup_close(encoder_setup *s)
{
    fap_fit_close(&s->learnt);
}
