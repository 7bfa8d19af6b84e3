/* SPDX-License-Identifier: BSD-2-Clause */
/** @file
 * Speech as phonemes in time, and the mouth that speaks them. Who found the times (a person with Praat, an aligner, a
 * synthesizer) does not matter. docs/speech.md lists what the readers tolerate and shows how sounds blend.
 * Source: Cohen and Massaro 1993, Modeling coarticulation in synthetic visual speech.
 */
#ifndef FAP_STUDIO_SPEECH_H
#define FAP_STUDIO_SPEECH_H

#include <stddef.h>
#include <stdint.h>

#include <fap/alloc.h>
#include <fap/error.h>
#include <fap/frame.h>
#include <fap/studio/take.h>
#include <fap/tables.h>

#ifdef __cplusplus
extern "C" {
#endif

#define FAP_PHONEME_NAME_SIZE   16        /**< bytes of a name, UTF-8, its NUL included */
#define FAP_SPEECH_MAX_PHONEMES (1 << 18) /**< more are refused with FAP_E_LIMIT */

/** How phonemes are spelt. The same letter is not the same sound in all of them: T is t in ARPAbet, th in SAMPA. */
typedef enum fap_alphabet {
    FAP_ALPHABET_AUTO, /**< whichever knows most of the names */
    FAP_ALPHABET_IPA,
    FAP_ALPHABET_ARPABET,
    FAP_ALPHABET_SAMPA, /**< and X-SAMPA */
    FAP_ALPHABET_ESPEAK,
    FAP_ALPHABET_RHUBARB, /**< mouth shapes A to H and X */
    FAP_ALPHABET_COUNT
} fap_alphabet;
/** "ipa", "arpabet", "sampa", "espeak", "rhubarb"; NULL for AUTO and other numbers. */
FAP_API const char *fap_alphabet_name(int alphabet);

/** One sound. Silence has a name too, or "". */
typedef struct fap_phoneme {
    double start_s, end_s;
    char name[FAP_PHONEME_NAME_SIZE];
} fap_phoneme;

/** Plain data, free to change in place as long as it stays in order. */
typedef struct fap_speech {
    const char *format; /**< "textgrid", "rhubarb", "tsv"; static */
    fap_alphabet alphabet;
    double length_s; /**< as the file says, at least the end of the last phoneme */
    uint32_t count;
    fap_phoneme *phoneme; /**< ascending, none begins before the one in front of it ends */
    char tier[64];        /**< of a TextGrid: which was read */
    uint32_t note_count;
    char note[FAP_TAKE_MAX_NOTES][FAP_TAKE_NOTE_SIZE]; /**< what was tolerated or left out, in words */
    fap_allocator alloc;
} fap_speech;

/** What to believe instead of the file; start from fap_speech_read_config_init(). */
typedef struct fap_speech_read_config {
    size_t struct_size;
    fap_alphabet alphabet; /**< FAP_ALPHABET_AUTO */
    const char *tier;      /**< of a TextGrid; NULL: the one that looks like phonemes */
    fap_allocator alloc;
} fap_speech_read_config;
FAP_API void fap_speech_read_config_init(fap_speech_read_config *cfg);

/**
 * Read a file of any known format, found by its content: Praat TextGrid (long or short), Rhubarb's JSON, and lines of
 * start, end and phoneme.
 * @param cfg    NULL: defaults
 * @param where  FAP_ERROR_TEXT_SIZE bytes, may be NULL: what is wrong, and what to do
 * @return FAP_OK; FAP_E_UNKNOWN_FORMAT; FAP_E_UNSUPPORTED a relative of a known format; FAP_E_NOT_FOUND no phoneme in it, or
 *         not that tier; FAP_E_LIMIT; FAP_E_NOMEM. @p *speech is NULL on error.
 */
FAP_API FAP_NODISCARD fap_err fap_speech_read(fap_speech **speech, const void *data, size_t size,
                                              const fap_speech_read_config *cfg, char *where);
/** Sets @p *speech to NULL; accepts NULL. */
FAP_API void fap_speech_close(fap_speech **speech);

/**
 * The visemes (fap/tables.h) a phoneme is spoken with. Stress marks, tones and length are passed over.
 * @param second  0, or what a diphthong ends with; may be NULL
 * @return 1 to 14; 0: silence, or a sound that is seen in no lips (h); -1: not a name of that alphabet
 */
FAP_API int fap_phoneme_visemes(fap_alphabet alphabet, const char *name, int *second);

/** What moves by itself when one speaks. Each viseme rules each of them for a time of its own. */
typedef enum fap_articulator { FAP_LIPS, FAP_JAW, FAP_TONGUE, FAP_ARTICULATOR_COUNT } fap_articulator;

/** How a mouth is said in FAPs. */
typedef enum fap_mouth_way {
    FAP_MOUTH_VISEMES, /**< FAP 1 alone: two visemes and their blend, any face in its own way */
    FAP_MOUTH_LIPS     /**< the FAPs of jaw, lips and tongue, each as its articulator goes */
} fap_mouth_way;

/** Start from fap_mouth_config_init(). */
typedef struct fap_mouth_config {
    size_t struct_size;
    fap_mouth_way way; /**< FAP_MOUTH_VISEMES */
    fap_allocator alloc;
} fap_mouth_config;
FAP_API void fap_mouth_config_init(fap_mouth_config *cfg);

#define FAP_MOUTH_MAX_UNKNOWN 8

/** What the mouth made of the names. */
typedef struct fap_mouth_report {
    uint32_t sounds, silences; /**< silences: pauses that the file names, and those between what it names */
    uint32_t unknown;          /**< sounds that no viseme is known for: spoken as their neighbours are */
    uint32_t unknown_names;    /**< how many of them stand in */
    char unknown_name[FAP_MOUTH_MAX_UNKNOWN][FAP_PHONEME_NAME_SIZE]; /**< each once */
} fap_mouth_report;

typedef struct fap_mouth fap_mouth;

/**
 * A mouth that speaks. @p speech is not kept.
 * @param cfg  NULL: defaults
 * @return FAP_OK, FAP_E_NOMEM; @p *mouth is NULL on error
 */
FAP_API FAP_NODISCARD fap_err fap_mouth_open(fap_mouth **mouth, const fap_speech *speech,
                                             const fap_mouth_config *cfg);
/** Sets @p *mouth to NULL; accepts NULL. */
FAP_API void fap_mouth_close(fap_mouth **mouth);
/**
 * The frame of an instant; a function of @p t_s alone. Number and time of @p frame are left as they are. Before and after all
 * sounds the face is at rest.
 */
FAP_API void fap_mouth_at(const fap_mouth *mouth, double t_s, fap_frame *frame);
/** What each viseme's share of an articulator is then: 0 to 1, their sum is 1; [0] is rest. */
FAP_API void fap_mouth_shares(const fap_mouth *mouth, fap_articulator part, double t_s,
                              double share[FAP_VISEME_COUNT + 1]);
FAP_API const fap_mouth_report *fap_mouth_report_get(const fap_mouth *mouth);

#ifdef __cplusplus
}
#endif
#endif
