/* SPDX-License-Identifier: BSD-2-Clause */
/* Any bytes as phoneme times, whole and then with every allocation failing; the first byte chooses a tier's name. */
#include <stdlib.h>

#include <fap/studio/speech.h>

#include "tests/fuzz/alloc.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void check(const fap_speech *s)
{
    double at = 0;

    if (!s->count || s->count > FAP_SPEECH_MAX_PHONEMES || !fap_alphabet_name(s->alphabet))
        abort();
    for (uint32_t i = 0; i < s->count; i++) {
        const fap_phoneme *p = &s->phoneme[i];
        if (!(p->start_s >= at && p->end_s > p->start_s))
            abort();
        fap_phoneme_visemes(s->alphabet, p->name, NULL);
        at = p->end_s;
    }
    if (!(s->length_s >= at))
        abort();
}

static fap_err read_all(const uint8_t *data, size_t size, const char *tier, fuzz_memory *m)
{
    char where[FAP_ERROR_TEXT_SIZE];
    fap_speech_read_config cfg;
    fap_speech *s;

    fap_speech_read_config_init(&cfg);
    cfg.tier = tier;
    cfg.alloc = fuzz_allocator(m);
    const fap_err err = fap_speech_read(&s, data, size, &cfg, where);
    if ((err == FAP_OK) != (s != NULL))
        abort();
    if (s)
        check(s);
    fap_speech_close(&s);
    fuzz_memory_check(m);
    return err;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_memory all = { 0 };

    if (!size)
        return 0;
    const char *tier = data[0] & 1 ? "phones" : NULL;
    const fap_err whole = read_all(data + 1, size - 1, tier, &all);
    for (long n = 1; n <= all.asked; n++)
        fuzz_memory_error(whole, read_all(data + 1, size - 1, tier, &(fuzz_memory){ .fail_at = n }));
    return 0;
}
