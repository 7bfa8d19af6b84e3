/* SPDX-License-Identifier: BSD-2-Clause */
#include "tests/test.h"

#include <stdlib.h>
#include <string.h>

#include <fap/studio/speech.h>

static fap_speech *read_text(const char *text)
{
    char where[FAP_ERROR_TEXT_SIZE];
    fap_speech *s;

    if (fap_speech_read(&s, text, strlen(text), NULL, where) != FAP_OK)
        fail_msg("%s", where);
    return s;
}

static void says(const fap_speech *s, uint32_t i, double start, double end, const char *name)
{
    assert_true(i < s->count);
    assert_float_equal(s->phoneme[i].start_s, start, 1e-9);
    assert_float_equal(s->phoneme[i].end_s, end, 1e-9);
    assert_string_equal(s->phoneme[i].name, name);
}

static const char long_grid[] =
    "File type = \"ooTextFile\"\nObject class = \"TextGrid\"\n\nxmin = 0 \nxmax = 1.5 \ntiers? <exists> \n"
    "size = 3 \nitem []: \n    item [1]:\n        class = \"IntervalTier\" \n        name = \"words\" \n"
    "        xmin = 0 \n        xmax = 1.5 \n        intervals: size = 1 \n        intervals [1]:\n"
    "            xmin = 0 \n            xmax = 1.5 \n            text = \"a \"\"map\"\"\" \n"
    "    item [2]:\n        class = \"TextTier\" \n        name = \"clicks\" \n        xmin = 0 \n"
    "        xmax = 1.5 \n        points: size = 1 \n        points [1]:\n            number = 0.3 \n"
    "            mark = \"!\" \n"
    "    item [3]:\n        class = \"IntervalTier\" \n        name = \"anna - phones\" \n        xmin = 0 \n"
    "        xmax = 1.5 \n        intervals: size = 3 \n        intervals [1]:\n            xmin = 0 \n"
    "            xmax = 0.5 \n            text = \"\" \n        intervals [2]:\n            xmin = 0.5 \n"
    "            xmax = 0.6 \n            text = \"M\" \n        intervals [3]:\n            xmin = 0.6 \n"
    "            xmax = 0.9 \n            text = \"AE1\" \n";
static const char short_grid[] =
    "File type = "
    "\"ooTextFile\"\r\n\"TextGrid\"\r\n\r\n0\r\n1.5\r\n<exists>\r\n1\r\n\"IntervalTier\"\r\n\"x\"\r\n"
    "0\r\n1.5\r\n2\r\n0\r\n0.5\r\n\"m\"\r\n0.5\r\n1.5\r\n\"aɪ\"\r\n! a remark \"\r\n";

TEST(speech, a_long_textgrid_gives_the_tier_of_phonemes_and_not_the_words)
{
    fap_speech *s = read_text(long_grid);

    assert_string_equal(s->format, "textgrid");
    assert_string_equal(s->tier, "anna - phones");
    assert_int_equal(s->alphabet, FAP_ALPHABET_ARPABET);
    assert_int_equal(s->count, 3);
    says(s, 1, 0.5, 0.6, "M");
    says(s, 2, 0.6, 0.9, "AE1");
    assert_float_equal(s->length_s, 1.5, 1e-9);
    fap_speech_close(&s);
    assert_null(s);
}

TEST(speech, a_short_textgrid_reads_as_well)
{
    fap_speech *s = read_text(short_grid);

    assert_int_equal(s->count, 2);
    says(s, 1, 0.5, 1.5, "aɪ");
    assert_int_equal(s->alphabet, FAP_ALPHABET_IPA);
    fap_speech_close(&s);
}

TEST(speech, a_tier_is_taken_by_its_name_or_not_at_all)
{
    fap_speech_read_config cfg;
    char where[FAP_ERROR_TEXT_SIZE];
    fap_speech *s;

    fap_speech_read_config_init(&cfg);
    cfg.tier = "words";
    assert_int_equal(fap_speech_read(&s, long_grid, sizeof long_grid - 1, &cfg, where), FAP_OK);
    assert_int_equal(s->count, 1);
    fap_speech_close(&s);
    cfg.tier = "clicks";
    assert_int_equal(fap_speech_read(&s, long_grid, sizeof long_grid - 1, &cfg, where), FAP_E_NOT_FOUND);
    assert_non_null(strstr(where, "clicks"));
    assert_null(s);
}

TEST(speech, utf_16_of_either_order_reads_like_utf_8)
{
    static const char grid[] = "File type = \"ooTextFile\"\n\"TextGrid\"\n0 1 <exists> 1 \"IntervalTier\" "
                               "\"phones\" 0 1 1 0 1 \"\x01\"";
    const size_t n = sizeof grid - 1;

    for (int big = 0; big < 2; big++) {
        uint8_t bytes[2 * sizeof grid] = { big ? 0xfe : 0xff, big ? 0xff : 0xfe };
        fap_speech *s;
        for (size_t i = 0; i < n; i++) {
            const unsigned c = grid[i] == 1 ? 0x0283 : (unsigned char)grid[i];
            bytes[2 + 2 * i + (size_t)!big] = (uint8_t)(c >> 8);
            bytes[2 + 2 * i + (size_t)big] = (uint8_t)c;
        }
        assert_int_equal(fap_speech_read(&s, bytes, 2 + 2 * n, NULL, NULL), FAP_OK);
        says(s, 0, 0, 1, "ʃ");
        fap_speech_close(&s);
    }
}

TEST(speech, a_textgrid_cut_at_any_byte_gives_what_it_has_or_an_error)
{
    for (size_t size = 0; size < sizeof long_grid - 1; size++) {
        char *cut = malloc(size + 1);
        fap_speech *s;
        assert_non_null(cut);
        memcpy(cut, long_grid, size);
        if (fap_speech_read(&s, cut, size, NULL, NULL) == FAP_OK)
            assert_true(s->count > 0 && s->count <= 3);
        else
            assert_null(s);
        fap_speech_close(&s);
        free(cut);
    }
}

TEST(speech, counts_that_a_textgrid_only_claims_cost_nothing)
{
    fap_speech *s;
    static const char grid[] =
        "\"ooTextFile\" \"TextGrid\" 0 1 <exists> 1e30 \"IntervalTier\" \"phones\" 0 1 1e30 0 1 \"a\"";

    assert_int_equal(fap_speech_read(&s, grid, sizeof grid - 1, NULL, NULL), FAP_OK);
    assert_int_equal(s->count, 1);
    assert_int_equal(s->note_count, 1);
    fap_speech_close(&s);
}

TEST(speech, a_binary_textgrid_is_refused_with_advice)
{
    char where[FAP_ERROR_TEXT_SIZE];
    fap_speech *s;

    assert_int_equal(fap_speech_read(&s, "ooBinaryFile\010TextGrid", 21, NULL, where), FAP_E_UNSUPPORTED);
    assert_non_null(strstr(where, "text file"));
}

TEST(speech, rhubarb_cues_are_mouth_shapes)
{
    fap_speech *s = read_text(
        "{\"metadata\":{\"soundFile\":\"a.wav\",\"duration\":2.5},\"mouthCues\":["
        "{\"start\":0.00,\"end\":0.05,\"value\":\"X\"},{\"start\":0.05,\"end\":0.27,\"value\":\"D\"}]}");

    assert_string_equal(s->format, "rhubarb");
    assert_int_equal(s->alphabet, FAP_ALPHABET_RHUBARB);
    says(s, 1, 0.05, 0.27, "D");
    assert_float_equal(s->length_s, 2.5, 1e-9);
    fap_speech_close(&s);
}

TEST(speech, rhubarbs_plain_lines_end_where_the_next_begins)
{
    fap_speech *s = read_text("0.00\tX\n0.05\tD\n0.27\tB\n0.50\tX\n");

    assert_int_equal(s->alphabet, FAP_ALPHABET_RHUBARB);
    assert_int_equal(s->count, 4);
    says(s, 1, 0.05, 0.27, "D");
    fap_speech_close(&s);
}

TEST(speech, lines_say_their_alphabet_and_length)
{
    fap_speech *s = read_text("# alphabet: espeak\n# length: 3\nstart\tend\tphoneme\n0.1\t0.2\tm\n0,2 0,3 "
                              "3:\n0.3\t0.4\t\nnonsense\n");

    assert_int_equal(s->alphabet, FAP_ALPHABET_ESPEAK);
    assert_int_equal(s->count, 3);
    says(s, 1, 0.2, 0.3, "3:");
    says(s, 2, 0.3, 0.4, "");
    assert_float_equal(s->length_s, 3, 1e-9);
    assert_int_equal(s->note_count, 1);
    assert_non_null(strstr(s->note[0], "line 7"));
    fap_speech_close(&s);
}

TEST(speech, times_are_put_in_order_and_nonsense_is_left_out)
{
    fap_speech *s = read_text("0.5 0.7 a\n0.1 0.55 m\n-1 0 p\n0.9 0.8 t\n1e300 1e301 t\n");

    assert_int_equal(s->count, 2);
    says(s, 0, 0.1, 0.5, "m");
    says(s, 1, 0.5, 0.7, "a");
    assert_int_equal(s->note_count, 3);
    fap_speech_close(&s);
}

TEST(speech, a_long_name_is_cut_between_letters)
{
    fap_speech *s = read_text("0 1 aːːːːːːːːːːː\n");

    assert_string_equal(s->phoneme[0].name, "aːːːːːːː");
    fap_speech_close(&s);
}

TEST(speech, other_files_are_unknown)
{
    static const char *const texts[] = { "", "hello", "{\"a\":1}", "frame,time\n1,2\n", "TextGrid" };
    fap_speech *s;

    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
        assert_int_equal(fap_speech_read(&s, texts[i], strlen(texts[i]), NULL, NULL), FAP_E_UNKNOWN_FORMAT);
    assert_int_equal(fap_speech_read(&s, NULL, 0, NULL, NULL), FAP_E_UNKNOWN_FORMAT);
}

/* --- phonemes --- */

static void speaks(fap_alphabet alphabet, const char *name, int first, int second)
{
    int other;

    if (fap_phoneme_visemes(alphabet, name, &other) != first || other != second)
        fail_msg("%s %s is %d %d", fap_alphabet_name(alphabet), name,
                 fap_phoneme_visemes(alphabet, name, NULL), other);
}

TEST(phonemes, the_same_letter_is_another_sound_in_another_alphabet)
{
    speaks(FAP_ALPHABET_ARPABET, "T", 4, 0);
    speaks(FAP_ALPHABET_SAMPA, "T", 3, 0);
    speaks(FAP_ALPHABET_ARPABET, "sh", 6, 0);
    speaks(FAP_ALPHABET_RHUBARB, "A", 1, 0);
    speaks(FAP_ALPHABET_ESPEAK, "tS", 6, 0);
    speaks(FAP_ALPHABET_IPA, "t͡ʃ", 6, 0);
}

TEST(phonemes, stress_length_and_marks_change_nothing)
{
    speaks(FAP_ALPHABET_ARPABET, "AY2", 10, 12);
    speaks(FAP_ALPHABET_IPA, "ˈiː", 12, 0);
    speaks(FAP_ALPHABET_IPA, "tʰ", 4, 0);
    speaks(FAP_ALPHABET_IPA, "ˌaɪ̯", 10, 12);
    speaks(FAP_ALPHABET_SAMPA, "\"aI", 10, 12);
    speaks(FAP_ALPHABET_ESPEAK, "'A:", 10, 0);
}

TEST(phonemes, silence_is_no_viseme_and_words_are_no_phonemes)
{
    speaks(FAP_ALPHABET_IPA, "", 0, 0);
    speaks(FAP_ALPHABET_ARPABET, "SIL", 0, 0);
    speaks(FAP_ALPHABET_IPA, "sil", 0, 0);
    speaks(FAP_ALPHABET_ARPABET, "hello", -1, 0);
    speaks(FAP_ALPHABET_IPA, "hello", -1, 0);
    speaks(FAP_ALPHABET_RHUBARB, "A1", -1, 0);
    speaks(FAP_ALPHABET_AUTO, "a", -1, 0);
}
