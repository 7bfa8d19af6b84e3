/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Text to phonemes by fap-phonemes, a program of its own: it links espeak-ng, whose licence (GPL) this one's users need not
 * take on. It is looked for beside this program, then in PATH.
 */
#ifndef ENCODER_SPEECH_PHONEMIZE_H
#define ENCODER_SPEECH_PHONEMIZE_H

#include <stddef.h>
#include <stdint.h>

#include <fap/error.h>

/* @p tsv: what it says, to free(). FAP_E_UNSUPPORTED: there is no such program, or it lacks what it needs. */
fap_err phonemize(const char *text, const char *language, uint8_t **tsv, size_t *size, char *where);

#endif
