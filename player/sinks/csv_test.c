/* SPDX-License-Identifier: BSD-2-Clause */
/* What stands in the tables. */
#include "tests/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/tool.h"
#include "player/sinks/csv.h"
#include "player/sinks/export_limit.h"

/* One table of one frame of the built-in face, in memory. */
typedef struct table {
    fap_bank *bank;
    shown_frame shown;
    fap_frame frame;
    float *position, *weight, (*point)[3];
    char *text;
    size_t size;
} table;

static table make_table(void)
{
    table t = { .text = NULL };

    assert_int_equal(fap_bank_builtin(&t.bank, NULL), FAP_OK);
    const fap_mesh *mesh = fap_bank_mesh(t.bank);
    t.position = calloc((size_t)3 * mesh->stride, sizeof *t.position);
    t.weight = calloc((size_t)fap_bank_key_count(t.bank), sizeof *t.weight);
    t.point = calloc(FAP_POINT_COUNT, sizeof *t.point);
    return t;
}

static void free_table(table *t)
{
    free(t->text);
    free(t->position);
    free(t->weight);
    free(t->point);
    fap_bank_close(&t->bank);
}

/* Writes @name's header and frame into t->text. */
static void write_table(table *t, const char *name)
{
    const csv_kind *kind = csv_kind_by_name(name);
    FILE *out = open_memstream(&t->text, &t->size);

    assert_non_null(kind);
    t->shown.frame = &t->frame;
    t->shown.position = t->position;
    t->shown.weight = t->weight;
    t->shown.point = (const float(*)[3])t->point;
    void *state = NULL;
    assert_true(!kind->open || kind->open(&state));
    kind->put_names(out, t->bank);
    fputc('\n', out);
    kind->put_frame(out, "7,0.280000", &t->shown, t->bank, state);
    fclose(out);
    if (state)
        kind->close(state);
}

/* Cell under @column in line @line (1: the first frame) into @out. */
static void cell_of(const table *t, const char *column, int line, char out[64])
{
    const char *start = t->text;
    const size_t length = strlen(column);
    int at = 0;

    for (const char *c = start; strncmp(c, column, length) || (c[length] != ',' && c[length] != '\n'); at++) {
        c += strcspn(c, ",\n");
        assert_int_equal(*c, ','); /* else there is no such column */
        c++;
    }
    for (; line; line--)
        start = strchr(start, '\n') + 1;
    for (; at; at--)
        start = strchr(start, ',') + 1;
    snprintf(out, 64, "%.*s", (int)strcspn(start, ",\n"), start);
}

static void has(const table *t, const char *column, int line, const char *expected)
{
    char got[64];

    cell_of(t, column, line, got);
    assert_string_equal(got, expected);
}

static int count_of(const char *text, char c)
{
    int count = 0;

    for (; *text && *text != '\n'; text++)
        count += *text == c;
    return count;
}

TEST(csv, every_kind_has_as_many_cells_as_names)
{
    for (int i = 0; csv_kinds[i]; i++) {
        table t = make_table();
        write_table(&t, csv_kinds[i]->name);
        const int columns = count_of(t.text, ',');
        assert_true(columns > 2);
        for (const char *line = t.text; *line; line = strchr(line, '\n') + 1)
            assert_int_equal(count_of(line, ','), columns);
        free_table(&t);
    }
}

TEST(csv, no_frame_is_larger_than_was_announced)
{
    for (int i = 0; csv_kinds[i]; i++) {
        table t = make_table();
        for (uint32_t v = 0; v < 3 * fap_bank_mesh(t.bank)->stride; v++)
            t.position[v] = -234.5678f;
        for (int k = 0; k < fap_bank_key_count(t.bank); k++)
            t.weight[k] = 0.123456f;
        for (int p = 0; p < FAP_POINT_COUNT; p++)
            t.point[p][0] = t.point[p][1] = t.point[p][2] = -234.5678f;
        write_table(&t, csv_kinds[i]->name);
        assert_true((double)strlen(strchr(t.text, '\n') + 1) <= csv_kinds[i]->frame_size(t.bank));
        free_table(&t);
    }
}

TEST(csv, points_stand_under_their_names)
{
    table t = make_table();

    t.point[fap_point_by_name("8.4")][1] = -12.34567f;
    write_table(&t, "points");
    has(&t, "frame", 1, "7");
    has(&t, "time_s", 1, "0.280000");
    has(&t, "8.4.y", 1, "-12.3457");
    has(&t, "8.4.x", 1, "0.0000");
    free_table(&t);
}

TEST(csv, vertices_have_a_line_each)
{
    table t = make_table();
    const uint32_t stride = fap_bank_mesh(t.bank)->stride;

    t.position[3] = 1.5f;
    t.position[stride + 3] = 2.5f;
    t.position[2 * stride + 3] = -3.5f;
    write_table(&t, "vertices");
    has(&t, "vertex", 4, "3");
    has(&t, "x", 4, "1.5000");
    has(&t, "y", 4, "2.5000");
    has(&t, "z", 4, "-3.5000");
    has(&t, "x", 5, "0.0000");
    free_table(&t);
}

TEST(csv, weights_stand_under_kind_and_name)
{
    table t = make_table();
    const int joy = fap_bank_key_find(t.bank, FAP_KEY_EXPRESSION, "joy");

    assert_true(joy >= 0);
    t.weight[joy] = 0.25f;
    write_table(&t, "weights");
    has(&t, "expression.joy", 1, "0.25");
    has(&t, "viseme.PP", 1, "0");
    free_table(&t);
}

TEST(csv, faps_without_a_value_are_empty_and_the_others_name_their_unit)
{
    table t = make_table();

    t.frame.state[3] = FAP_CODED;
    t.frame.value[3] = -321;
    t.frame.state[48] = FAP_HELD;
    t.frame.value[48] = 12345;
    t.frame.state[1] = FAP_CODED;
    t.frame.viseme = (fap_viseme){ .select1 = 5, .select2 = 7, .blend = 63 };
    write_table(&t, "faps");
    has(&t, "open_jaw.MNS", 1, "-321");
    has(&t, "head_pitch.AU", 1, "12345");
    has(&t, "close_t_l_eyelid.IRISD", 1, "");
    has(&t, "viseme.select2", 1, "7");
    has(&t, "viseme.blend", 1, "63");
    has(&t, "expression.select1", 1, "");
    free_table(&t);
}

TEST(csv, gigabytes_are_refused_in_front)
{
    const sink_setup setup = { .output = "a.csv", .count = 1000000 };
    fault f = { 0 };

    assert_true(export_fits(&setup, 1e9, &f));
    assert_int_equal(f.exit_status, EXIT_OK);
    assert_false(export_fits(&setup, 1.001e9, &f));
    assert_int_equal(f.exit_status, EXIT_USAGE);
    assert_non_null(strstr(f.text, "--frames"));
}

TEST(csv, arkit_is_laid_out_as_live_link_face_does)
{
    table t = make_table();

    for (int p = 0; p < FAP_POINT_COUNT; p++)
        memcpy(t.point[p], fap_bank_point_get(t.bank, p)->position_mm, sizeof t.point[p]);
    t.shown.time_s = 3723.5 + 1.0 / 25;
    t.frame.state[19] = t.frame.state[49] = t.frame.state[23] = FAP_CODED;
    t.frame.value[19] = 1024;
    t.frame.value[23] = 20000;
    write_table(&t, "arkit");
    assert_int_equal(count_of(t.text, ','), 62);
    has(&t, "Timecode", 1, "01:02:03:32.400");
    has(&t, "BlendShapeCount", 1, "61");
    has(&t, "TongueOut", 1, "0.000000");
    has(&t, "LeftEyeYaw", 1, "-0.200000");
    has(&t, "HeadYaw", 1, "0.000000");
    char blink[64];
    cell_of(&t, "EyeBlinkLeft", 1, blink);
    assert_true(strtod(blink, NULL) > 0.9);
    cell_of(&t, "EyeBlinkRight", 1, blink);
    assert_true(strtod(blink, NULL) < 0.05);
    free_table(&t);
}
