/* SPDX-License-Identifier: BSD-2-Clause */
/* Which alphabet names are of. */
#ifndef LIB_SPEECH_PHONEMES_H
#define LIB_SPEECH_PHONEMES_H

#include <fap/studio/speech.h>

/* 1: nobody speaks; 0: somebody does, or the name is unknown. */
int phonemes_is_silence(fap_alphabet alphabet, const char *name);
/* How many names the alphabet knows, silence among them. */
uint32_t phonemes_known(fap_alphabet alphabet, const fap_phoneme *phoneme, uint32_t count);
/* The alphabet that knows most of them, or of the first 2000: more would tell nothing new. */
fap_alphabet phonemes_alphabet(const fap_phoneme *phoneme, uint32_t count);

#endif
