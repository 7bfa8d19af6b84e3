/* SPDX-License-Identifier: BSD-2-Clause */
/* FAP interpolation tables: text, node, values. */
#include "tests/test.h"

#include <stdio.h>
#include <string.h>

#include <fap/derive.h>
#include <fap/fit.h>

#define HEAD "fap-fit 1\n"

/* --- helpers --- */

static fap_fit *parse(const char *text)
{
    fap_fit *fit;
    char where[FAP_ERROR_TEXT_SIZE];

    if (fap_fit_parse(&fit, text, strlen(text), NULL, where) != FAP_OK)
        fail_msg("%s", where);
    return fit;
}

static void refuse(const char *text, fap_err err, const char *want)
{
    fap_fit *fit;
    char where[FAP_ERROR_TEXT_SIZE];

    assert_int_equal(fap_fit_parse(&fit, text, strlen(text), NULL, where), err);
    assert_null(fit);
    assert_string_equal(where, want);
    assert_int_equal(fap_fit_parse(&fit, text, strlen(text), NULL, NULL), err);
}

typedef struct sink {
    size_t size, room;
    char text[4096];
} sink;

static int write_sink(void *user, const void *data, size_t size)
{
    sink *s = user;

    if (size >= s->room - s->size)
        return 1;
    memcpy(s->text + s->size, data, size);
    s->size += size;
    s->text[s->size] = '\0';
    return 0;
}

static const char *written(const fap_fit *fit, sink *s)
{
    *s = (sink){ .room = sizeof s->text };
    assert_int_equal(fap_fit_write(fit, &(fap_writer){ write_sink, s }), FAP_OK);
    return s->text;
}

static fap_frame coded(int fap, int32_t value)
{
    fap_frame f = { 0 };

    f.state[fap] = FAP_CODED;
    f.value[fap] = value;
    return f;
}

static void code(fap_frame *f, int fap, int32_t value)
{
    f->state[fap] = FAP_CODED;
    f->value[fap] = value;
}

/* What a formula gives FAP 60 for a value of FAP 53; -1 stands for "nothing". */
static int32_t give(const char *formula, int32_t f53)
{
    char text[256] = HEAD "from f53\nf60 = ";
    fap_frame f = coded(53, f53);

    strncat(text, formula, sizeof text - strlen(text) - 1);
    fap_fit *fit = parse(text);
    fap_fit_apply(fit, &f);
    fap_fit_close(&fit);
    assert_int_equal(f.state[60], f.value[60] || f.state[60] ? FAP_DERIVED : FAP_ABSENT);
    return f.state[60] == FAP_DERIVED ? f.value[60] : -1;
}

/* --- formulas --- */

TEST(fit, a_formula_is_a_quotient_of_polynomials)
{
    assert_int_equal(give("f53", 77), 77);
    assert_int_equal(give("-f53", 77), -77);
    assert_int_equal(give("0.5*f53 + 3", 100), 53);
    assert_int_equal(give("2*f53^2 - f53 + 1", 10), 191);
    assert_int_equal(give("(6*f53) / (2 + f53)", 4), 4);
    assert_int_equal(give("+ 1e2 * f53 * f53", 2), 400);
    assert_int_equal(give("25e-1*f53^0", 9), 3);
    assert_int_equal(give("stretch_l_cornerlip_o", 8), 8);
}

TEST(fit, halves_round_away_from_zero)
{
    assert_int_equal(give("0.5*f53", 5), 3);
    assert_int_equal(give("0.5*f53", -5), -3);
    assert_int_equal(give("0.49*f53", 1), 0);
    assert_int_equal(give("0.499999999999999*f53", 1), 0);
}

TEST(fit, values_are_kept_within_two_to_the_thirty)
{
    assert_int_equal(give("f53^16", 1000), 1 << 30);
    assert_int_equal(give("-f53^16", 1000), -(1 << 30));
    assert_int_equal(give("1e22*f53^16", 2147483647), 1 << 30);
}

TEST(fit, a_formula_without_a_value_gives_nothing)
{
    assert_int_equal(give("(5) / (f53)", 0), -1);
    assert_int_equal(give("(5) / (f53 - 3)", 3), -1);
    assert_int_equal(give("(5) / (1e-9*f53)", 1), 1 << 30);
    assert_int_equal(give("(5) / (0.9e-9*f53)", 1), -1);
    /* 2^31 to the 40th is more than a double holds */
    char text[] = HEAD "from f3 f4 f5\nf60 = f3^16*f4^16*f5^16\n";
    fap_frame f = coded(3, 2147483647);
    code(&f, 4, 2147483647), code(&f, 5, -2147483647);
    fap_fit *fit = parse(text);
    fap_fit_apply(fit, &f);
    assert_int_equal(f.state[60], FAP_ABSENT);
    fap_fit_close(&fit);
}

TEST(fit, a_condition_makes_a_term_count)
{
    fap_fit *fit = parse(HEAD "from viseme_select1 viseme_blend\n"
                              "f3 = 10*viseme_blend*[viseme_select1 = 10] + 5*[viseme_select1 = 2] - 1\n");
    fap_frame f = { .viseme = { .select1 = 10, .blend = 63 } };

    f.state[1] = FAP_CODED;
    fap_fit_apply(fit, &f);
    assert_int_equal(f.value[3], 629);
    f.state[3] = FAP_ABSENT, f.viseme.select1 = 2;
    fap_fit_apply(fit, &f);
    assert_int_equal(f.value[3], 4);
    f.state[3] = FAP_ABSENT, f.value[3] = 0, f.state[1] = FAP_ABSENT;
    fap_fit_apply(fit, &f);
    assert_int_equal(f.state[3], FAP_ABSENT);
    fap_fit_close(&fit);
}

/* --- the graph --- */

TEST(fit, only_absent_faps_with_known_sources_are_given)
{
    fap_fit *fit = parse(HEAD "from f53 f55\nf54 = f53\nf56 = f55\n");
    fap_frame f = coded(53, 5);

    fap_fit_apply(fit, &f);
    assert_int_equal(f.state[54], FAP_ABSENT);
    f.state[55] = FAP_HELD, f.value[55] = 6;
    f.state[56] = FAP_CONCEALED, f.value[56] = 9;
    fap_fit_apply(fit, &f);
    assert_int_equal(f.state[54], FAP_DERIVED);
    assert_int_equal(f.value[54], 5);
    assert_int_equal(f.state[56], FAP_CONCEALED);
    assert_int_equal(f.value[56], 9);
    assert_true(fap_fit_gives(fit, 54) && fap_fit_gives(fit, 56));
    assert_false(fap_fit_gives(fit, 53) || fap_fit_gives(fit, 0) || fap_fit_gives(fit, 69) ||
                 fap_fit_gives(fit, -1) || fap_fit_gives(NULL, 54));
    fap_fit_close(&fit);
}

TEST(fit, the_first_edge_that_can_give_a_fap_gives_it)
{
    fap_fit *fit =
        parse(HEAD "from f3\nf60 = 1\nfrom f4\nf60 = 2\nfrom f5\nf60 = (3) / (f5)\nfrom f5\nf60 = 4\n");
    fap_frame f = coded(4, 0), g = coded(5, 0);

    fap_fit_apply(fit, &f);
    assert_int_equal(f.value[60], 2);
    f = coded(4, 0), f.state[3] = FAP_CODED;
    fap_fit_apply(fit, &f);
    assert_int_equal(f.value[60], 1);
    fap_fit_apply(fit, &g);
    assert_int_equal(g.value[60], 4);
    fap_fit_close(&fit);
}

TEST(fit, what_is_given_gives_on_and_cycles_end)
{
    fap_fit *fit =
        parse(HEAD "from f5\nf6 = f5 + 1\nfrom f4\nf5 = f4 + 1\nfrom f6\nf4 = f6 + 1\nfrom f7\nf7 = f7\n");
    fap_frame f = coded(4, 10), again;

    fap_fit_apply(fit, &f);
    assert_int_equal(f.value[5], 11);
    assert_int_equal(f.value[6], 12);
    assert_int_equal(f.value[4], 10);
    assert_int_equal(f.state[7], FAP_ABSENT);
    again = f;
    fap_fit_apply(fit, &again);
    assert_memory_equal(&again, &f, sizeof f);
    fap_fit_close(&fit);
}

TEST(fit, an_edge_from_nothing_gives_constants)
{
    fap_fit *fit = parse(HEAD "from\nf3 = 7\n");
    fap_frame f = { 0 };

    fap_fit_apply(fit, &f);
    assert_int_equal(f.value[3], 7);
    assert_int_equal(f.state[3], FAP_DERIVED);
    fap_fit_close(&fit);
}

TEST(fit, goes_before_lips_and_sides)
{
    fap_fit *fit = parse(HEAD "from f6\nf7 = 2*f6\n");
    fap_frame f = coded(6, 10);

    fap_derive_with(fit, &f);
    assert_int_equal(f.value[7], 20);
    assert_int_equal(f.value[53], 10);
    assert_int_equal(f.value[54], 20); /* from the lip 7; the side would give 10 */
    f = coded(6, 10);
    fap_derive_with(NULL, &f);
    assert_int_equal(f.value[7], 10);
    fap_fit_close(&fit);
}

/* --- text --- */

TEST(fit, the_text_may_be_laid_out_freely)
{
    sink s;
    fap_fit *fit = parse("\r\n# of a take\r\n\tfap-fit  1 # version\r\n\r\nfrom open_jaw f4 # two\r\n"
                         "lower_t_midlip=3.50*open_jaw*f4-f3*f4^2\r\n  f60 = ( 1 + f3*f3 ) / ( 2 )");

    assert_string_equal(written(fit, &s), HEAD "\nfrom f3 f4\n"
                                               "    f4 = 3.5*f3*f4 - f3*f4^2  # lower_t_midlip\n"
                                               "    f60 = (1 + f3^2) / (2)  # raise_r_cornerlip_o\n");
    fap_fit_close(&fit);
}

TEST(fit, an_empty_table_gives_nothing)
{
    sink s;
    fap_fit *fit = parse("fap-fit 1");
    fap_frame f = coded(3, 1);

    fap_fit_apply(fit, &f);
    assert_string_equal(written(fit, &s), HEAD);
    fap_fit_close(&fit);
    fap_fit_close(&fit);
    fap_fit_close(NULL);
    fap_fit_apply(NULL, &f);
}

static void write_reads_back(const char *text)
{
    sink first, second;
    fap_fit *fit = parse(text);
    fap_fit *again = parse(written(fit, &first));

    assert_string_equal(written(again, &second), first.text);
    fap_fit_close(&fit);
    fap_fit_close(&again);
}

TEST(fit, what_is_written_reads_back)
{
    write_reads_back(HEAD "from\nf3 = 0\nf4 = -0.0\nf5 = 1 - 1\n");
    write_reads_back(HEAD "from f68\nf3 = 123456789012345*f68 - 123456789012345e3*f68^2 + 1e-22*f68^3\n");
    write_reads_back(HEAD "from f9\nf3 = 0.001*f9 + 0.000123*f9 + 1234.5*f9 + 1200000*f9 + .5*f9 + 5.*f9\n");
    write_reads_back(HEAD "from expression_intensity1 f3\nf4 = -expression_intensity1^16*[f3 = -1]\n"
                          "f5 = (-[f3 = 2]) / (-1 - f3)\n");
}

TEST(fit, says_where_and_what_was_expected)
{
    refuse("", FAP_E_SYNTAX, "line 0, column 1: \"fap-fit 1\" was expected");
    refuse("# nothing\n\n", FAP_E_SYNTAX, "line 2, column 1: \"fap-fit 1\" was expected");
    refuse("fap-fit 2\n", FAP_E_SYNTAX, "line 1, column 10: only version 1 is known");
    refuse("fap-fit 1 2\n", FAP_E_SYNTAX, "line 1, column 11: the end of the line was expected");
    refuse(HEAD "f3 = 1", FAP_E_SYNTAX,
           "line 2, column 1: \"from\" and the FAPs to interpolate from were expected");
    refuse(HEAD "from f3 60", FAP_E_SYNTAX, "line 2, column 9: a FAP was expected, like f53 or open_jaw");
    refuse(HEAD "from f69", FAP_E_SYNTAX, "line 2, column 6: f69 is no FAP");
    refuse(HEAD "from f03", FAP_E_SYNTAX, "line 2, column 6: f03 is no FAP");
    refuse(HEAD "from viseme", FAP_E_SYNTAX,
           "line 2, column 6: viseme has parts: viseme_select1, viseme_select2, viseme_blend");
    refuse(HEAD "from f2", FAP_E_SYNTAX,
           "line 2, column 6: f2 has parts: expression_select1, expression_intensity1, ...");
    refuse(HEAD "from f3\nviseme_blend = 1", FAP_E_SYNTAX,
           "line 3, column 1: visemes and expressions cannot be interpolated");
    refuse(HEAD "from f3\nf4 f3", FAP_E_SYNTAX, "line 3, column 4: \"=\" was expected");
    refuse(HEAD "from f3\nf4 = f5", FAP_E_SYNTAX,
           "line 3, column 6: f5 is not among the FAPs behind \"from\"");
    refuse(HEAD "from f3\nf4 = ", FAP_E_SYNTAX, "line 3, column 6: a number was expected");
    refuse(HEAD "from f3\nf4 = 3f3", FAP_E_SYNTAX, "line 3, column 6: a number was expected");
    refuse(HEAD "from f3\nf4 = 3 f3", FAP_E_SYNTAX,
           "line 3, column 8: \"+\", \"-\", \"*\" or the end of the line was expected");
    refuse(HEAD "from f3\nf4 = f3 / (2)", FAP_E_SYNTAX,
           "line 3, column 9: the numerator of a quotient stands in parentheses");
    refuse(HEAD "from f3\nf4 = (f3) / 2", FAP_E_SYNTAX,
           "line 3, column 13: \"(\" was expected: denominators stand in parentheses");
    refuse(HEAD "from f3\nf4 = (f3", FAP_E_SYNTAX,
           "line 3, column 9: \"+\", \"-\", \"*\" or \")\" was expected");
    refuse(HEAD "from f3\nf4 = [f3 = 1]*[f3 = 2]", FAP_E_SYNTAX,
           "line 3, column 16: a term has one [condition] at most");
    refuse(HEAD "from f3\nf4 = (1) / ([f3 = 1])", FAP_E_SYNTAX,
           "line 3, column 14: a denominator has no [conditions]");
    refuse(HEAD "from f3\nf4 = [f3 = 1.5]", FAP_E_SYNTAX,
           "line 3, column 12: this number is not an integer in range");
    refuse(HEAD "from f3\nf4 = [f3 = 1", FAP_E_SYNTAX, "line 3, column 13: \"]\" was expected");
    refuse(HEAD "from f3\nf4 = 1e23", FAP_E_SYNTAX,
           "line 3, column 6: this number is beyond what a coefficient can be (1e-22 to 1e22)");
    refuse(HEAD "from f3\nf4 = 1234567890123456", FAP_E_SYNTAX,
           "line 3, column 6: a number of more than 15 digits");
    refuse(HEAD "from f3\nf4 = inf", FAP_E_SYNTAX, "line 3, column 6: inf is no FAP");
}

TEST(fit, limits_hold)
{
    static char text[FAP_FIT_MAX_TEXT + 2];
    fap_fit *fit;

    refuse(HEAD "from f3\nf4 = f3^17", FAP_E_SYNTAX,
           "line 3, column 9: this number is not an integer in range");
    refuse(HEAD "from f3\nf4 = f3^-1", FAP_E_LIMIT, "line 3, column 11: exponents go from 0 to 16");
    refuse(HEAD "from f3\nf4 = f3^9*f3^8", FAP_E_LIMIT, "line 3, column 15: exponents go from 0 to 16");

    strcpy(text, HEAD);
    for (int i = 0; i < FAP_FIT_MAX_EDGES; i++)
        strcat(text, "from\n");
    fit = parse(text);
    fap_fit_close(&fit);
    strcat(text, "from\n");
    refuse(text, FAP_E_LIMIT, "line 258, column 5: the table is too big");

    strcpy(text, HEAD "from f3\nf4 = 0");
    for (int i = 1; i < FAP_FIT_MAX_TERMS; i++)
        strcat(text, "+1");
    fit = parse(text);
    fap_fit_close(&fit);
    strcat(text, "+1");
    assert_int_equal(fap_fit_parse(&fit, text, strlen(text), NULL, NULL), FAP_E_LIMIT);

    memset(text, ' ', sizeof text);
    memcpy(text, HEAD, strlen(HEAD));
    assert_int_equal(fap_fit_parse(&fit, text, FAP_FIT_MAX_TEXT, NULL, NULL), FAP_OK);
    fap_fit_close(&fit);
    assert_int_equal(fap_fit_parse(&fit, text, FAP_FIT_MAX_TEXT + 1, NULL, NULL), FAP_E_LIMIT);
    assert_int_equal(fap_fit_parse(NULL, text, 1, NULL, NULL), FAP_E_ARG);
    assert_int_equal(fap_fit_parse(&fit, NULL, 1, NULL, NULL), FAP_E_ARG);
}

TEST(fit, a_writer_that_fails_is_told_of)
{
    fap_fit *fit = parse(HEAD "from f3\nf4 = f3\n");
    sink s = { .room = 20 };

    assert_int_equal(fap_fit_write(fit, &(fap_writer){ write_sink, &s }), FAP_E_IO);
    assert_int_equal(fap_fit_write(fit, NULL), FAP_E_ARG);
    fap_fit_close(&fit);
}

static void *no_memory(void *user, size_t size)
{
    (void)user;
    (void)size;
    return NULL;
}

static void free_nothing(void *user, void *ptr)
{
    (void)user;
    (void)ptr;
}

TEST(fit, no_memory_is_an_error)
{
    const fap_allocator none = { no_memory, free_nothing, NULL };
    fap_fit *fit;

    assert_int_equal(fap_fit_parse(&fit, HEAD, strlen(HEAD), &none, NULL), FAP_E_NOMEM);
    assert_null(fit);
}

/* --- node --- */

#define LIST(name, ...)                                                                                      \
    .name = (const int32_t[]){ __VA_ARGS__ }, .name##_count = sizeof((const int32_t[]){ __VA_ARGS__ }) / 4
#define FLOATS(name, ...)                                                                                    \
    .name = (const float[]){ __VA_ARGS__ }, .name##_count = sizeof((const float[]){ __VA_ARGS__ }) / 4

/* f60 = (0.5 f59 + 0.1 f53^2) / (1 + 0.01 f53); f54 = 2 f3 [viseme_select1 = 4] - 1, f56 = 0 */
static const fap_fit_node sample = {
    LIST(faps, 53, 59, -1, 60, -1, 3, 69, -1, 54, 56, -1),
    LIST(graph, 0, 1, 2, 3),
    LIST(numerator_terms, 2, 2, 0),
    LIST(denominator_terms, 2, 0, 0),
    LIST(numerator_exp, 0, 1, 2, 0, 1, 0, 0, 0),
    LIST(denominator_exp, 0, 0, 1, 0),
    LIST(numerator_impulse, 69, 4, 0, 0),
    FLOATS(numerator_coefs, 0.5f, 0.1f, 2, -1),
    FLOATS(denominator_coefs, 1, 0.01f),
};

TEST(fit, a_node_makes_the_table_its_fields_say)
{
    sink s;
    fap_fit *fit;

    assert_int_equal(fap_fit_open(&fit, &sample, NULL, NULL), FAP_OK);
    assert_string_equal(written(fit, &s),
                        HEAD "\nfrom f53 f59\n"
                             "    f60 = (0.5*f59 + 0.1*f53^2) / (1 + 0.01*f53)  # raise_r_cornerlip_o\n"
                             "\nfrom f3 viseme_select1\n"
                             "    f54 = 2*f3*[viseme_select1 = 4] - 1  # stretch_r_cornerlip_o\n"
                             "    f56 = 0  # lower_t_lip_rm_o\n");
    fap_fit_close(&fit);
}

static void refuse_node(fap_fit_node node, fap_err err, const char *want)
{
    fap_fit *fit;
    char where[FAP_ERROR_TEXT_SIZE];

    assert_int_equal(fap_fit_open(&fit, &node, NULL, where), err);
    assert_null(fit);
    assert_string_equal(where, want);
}

TEST(fit, fields_that_contradict_each_other_are_refused)
{
    const size_t offsets[] = {
        offsetof(fap_fit_node, numerator_terms_count),   offsetof(fap_fit_node, denominator_terms_count),
        offsetof(fap_fit_node, numerator_exp_count),     offsetof(fap_fit_node, denominator_exp_count),
        offsetof(fap_fit_node, numerator_impulse_count), offsetof(fap_fit_node, numerator_coefs_count),
        offsetof(fap_fit_node, denominator_coefs_count), offsetof(fap_fit_node, graph_count),
    };
    for (size_t i = 0; i < sizeof offsets / sizeof *offsets; i++) {
        fap_fit_node cut = sample;
        fap_fit *fit;
        --*(size_t *)(void *)((char *)&cut + offsets[i]);
        assert_int_equal(fap_fit_open(&fit, &cut, NULL, NULL), FAP_E_DATA);
        assert_null(fit);
    }
    fap_fit_node n = sample;
    n.graph_count = 2;
    refuse_node(n, FAP_E_DATA, "FIT.numeratorTerms: longer than the graph asks for");
    n.graph = (const int32_t[]){ 0, 4 };
    refuse_node(n, FAP_E_DATA, "FIT.Graph: no such set");
    n.graph = (const int32_t[]){ -1, 1 };
    refuse_node(n, FAP_E_DATA, "FIT.Graph: no such set");
    n.graph = (const int32_t[]){ 0, 2 };
    refuse_node(n, FAP_E_UNSUPPORTED, "FIT.FAPs: visemes and expressions cannot be interpolated");
    n = sample, n.faps = (const int32_t[]){ 53, 76, -1, 60, -1, 3, 69, -1, 54, 56, -1 };
    refuse_node(n, FAP_E_DATA, "FIT.FAPs: no such FAP");
    n.faps = (const int32_t[]){ 53, 2, -1, 60, -1, 3, 69, -1, 54, 56, -1 };
    refuse_node(n, FAP_E_UNSUPPORTED, "FIT.FAPs: FAPs 1 and 2 as a whole; their parts are 69 to 75");
    n = sample, n.numerator_exp = (const int32_t[]){ 0, 17, 2, 0, 1, 0, 0, 0 };
    refuse_node(n, FAP_E_LIMIT, "FIT.numeratorExp: a number is out of range");
    n = sample, n.numerator_impulse = (const int32_t[]){ 70, 4, 0, 0 };
    refuse_node(n, FAP_E_DATA, "FIT.numeratorImpulse: not a source of its edge");
    n = sample, n.numerator_coefs = (const float[]){ 0.5f, 1e35f, 2, -1 };
    refuse_node(n, FAP_E_DATA, "FIT.numeratorCoefs: a number is out of range");
    assert_int_equal(fap_fit_open(NULL, &sample, NULL, NULL), FAP_E_ARG);
}

/* Through the node and back: the same text. */
static void survives_as_a_node(const char *text)
{
    sink first, second;
    fap_fit *fit = parse(text), *again;
    fap_fit_node *node;

    assert_int_equal(fap_fit_to_node(fit, &node, NULL), FAP_OK);
    assert_int_equal(fap_fit_open(&again, node, NULL, NULL), FAP_OK);
    fap_fit_node_close(&node);
    assert_null(node);
    assert_string_equal(written(again, &second), written(fit, &first));
    fap_fit_close(&fit);
    fap_fit_close(&again);
}

TEST(fit, a_table_survives_as_a_node)
{
    survives_as_a_node(HEAD);
    survives_as_a_node(HEAD
                       "from f53 f59\nf60 = (0.5*f59 + 0.1*f53^2) / (1 + 0.01*f53)\nfrom\nf4 = -7\nf5 = 0\n");
    survives_as_a_node(HEAD
                       "from viseme_select1 f3\nf4 = 2*f3*[viseme_select1 = 3] - 0.123456*[f3 = -4] + f3^16\n"
                       "f6 = 1e-9*f3\nfrom f4\nf3 = f4\n");
}

TEST(fit, what_a_node_cannot_say_is_an_error)
{
    fap_fit *fit = parse(HEAD "from f3\nf4 = [f3 = 1]\n");
    fap_fit_node *node;

    assert_int_equal(fap_fit_to_node(fit, &node, NULL), FAP_E_UNSUPPORTED);
    assert_null(node);
    assert_int_equal(fap_fit_to_node(NULL, &node, NULL), FAP_E_ARG);
    fap_fit_node_close(&node);
    fap_fit_close(&fit);
}

TEST(fit, an_empty_node_is_an_empty_table)
{
    fap_fit *fit;

    assert_int_equal(fap_fit_open(&fit, &(fap_fit_node){ 0 }, NULL, NULL), FAP_OK);
    assert_false(fap_fit_gives(fit, 54));
    fap_fit_close(&fit);
}

TEST(fit, the_example_of_the_manual_parses)
{
    static char text[4096];
    FILE *file = fopen("docs/examples/mouth.fit", "rb");
    assert_non_null(file);
    text[fread(text, 1, sizeof text - 1, file)] = '\0';
    fclose(file);
    fap_fit *fit = parse(text);
    assert_true(fap_fit_gives(fit, 8) && fap_fit_gives(fit, 16));
    fap_fit_close(&fit);
}
