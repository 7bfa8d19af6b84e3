/* SPDX-License-Identifier: BSD-2-Clause */
/* Labels follow onto a head that is the built-in one, stretched, turned, in another unit. */
#include "tests/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <fap/studio/labels.h>

typedef struct model {
    fap_bank *bank;
    fap_surface *scan;
    fap_labels labels;
    fap_label_place place[FAP_LABELS];
} model;

/* Wider, longer, in metres, looking along x. */
static void to_scanner(const float mm[3], float out[3])
{
    out[0] = mm[2] / 1000 + 0.3F;
    out[1] = mm[1] * 0.93F / 1000;
    out[2] = -mm[0] * 1.08F / 1000;
}

static void at_rest(const model *m, uint32_t v, float out[3])
{
    const fap_mesh *mesh = fap_bank_mesh(m->bank);
    for (uint32_t a = 0; a < 3; a++)
        out[a] = mesh->position[a * mesh->stride + v];
}

static fap_err open_model(model *m)
{
    memset(m, 0, sizeof *m);
    assert_int_equal(fap_bank_builtin(&m->bank, NULL), FAP_OK);
    const fap_mesh *mesh = fap_bank_mesh(m->bank);
    assert_int_equal(fap_surface_create(&m->scan, mesh->vertex_count, mesh->triangle_count, NULL), FAP_OK);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        float at[3];
        at_rest(m, v, at);
        to_scanner(at, m->scan->position[v]);
    }
    memcpy(m->scan->triangle, mesh->triangle, mesh->triangle_count * sizeof *m->scan->triangle);
    return fap_labels_of_bank(&m->labels, m->bank);
}

static void close_model(model *m)
{
    fap_surface_close(&m->scan);
    fap_bank_close(&m->bank);
}

static void place_majors(model *m, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        memcpy(m->place[i].at, m->scan->position[m->labels.vertex[i]], sizeof m->place[i].at);
        m->place[i].state = FAP_LABEL_PLACED;
    }
}

TEST(labels, twenty_eight_are_feature_points_and_all_are_different)
{
    model m;

    if (open_model(&m) == FAP_E_UNSUPPORTED) {
        close_model(&m);
        skip();
    }
    assert_int_equal(m.labels.count, FAP_LABELS);
    for (uint32_t i = 0; i < m.labels.count; i++) {
        assert_true(i >= FAP_LABELS_MAJOR || m.labels.point[i] >= 0);
        assert_int_equal(fap_bank_mesh(m.bank)->part[m.labels.vertex[i]], FAP_PART_SKIN);
        for (uint32_t k = 0; k < i; k++)
            assert_true(m.labels.point[i] < 0 || m.labels.point[i] != m.labels.point[k]);
    }
    assert_string_equal(fap_point_get(m.labels.point[0])->name, "3.7");
    close_model(&m);
}

TEST(labels, minor_ones_follow_the_major_ones)
{
    model m;
    double sum = 0;
    uint32_t met = 0;

    if (open_model(&m) == FAP_E_UNSUPPORTED) {
        close_model(&m);
        skip();
    }
    place_majors(&m, FAP_LABELS_MAJOR);
    assert_int_equal(fap_labels_follow(&m.labels, m.bank, m.scan, m.place), FAP_OK);
    for (uint32_t i = 0; i < m.labels.count; i++) {
        double off = 0;
        for (int a = 0; a < 3; a++)
            off +=
                pow(((double)m.place[i].at[a] - (double)m.scan->position[m.labels.vertex[i]][a]) * 1000, 2);
        if (i < FAP_LABELS_MAJOR)
            assert_int_equal(m.place[i].state, FAP_LABEL_PLACED);
        else if (m.place[i].state == FAP_LABEL_MET) {
            sum += off;
            met++;
        }
    }
    assert_true(met > 110);
    assert_true(sqrt(sum / met) < 6);
    close_model(&m);
}

TEST(labels, where_nothing_was_scanned_they_are_guessed)
{
    model m;

    if (open_model(&m) == FAP_E_UNSUPPORTED) {
        close_model(&m);
        skip();
    }
    place_majors(&m, 12);
    m.scan->triangle_count = 1;
    assert_int_equal(fap_labels_follow(&m.labels, m.bank, m.scan, m.place), FAP_OK);
    uint32_t guessed = 0;
    for (uint32_t i = 0; i < m.labels.count; i++)
        guessed += m.place[i].state == FAP_LABEL_GUESSED;
    assert_true(guessed > 140);
    close_model(&m);
}

TEST(labels, three_are_too_few_to_follow)
{
    model m;

    if (open_model(&m) == FAP_E_UNSUPPORTED) {
        close_model(&m);
        skip();
    }
    place_majors(&m, 3);
    assert_int_equal(fap_labels_follow(&m.labels, m.bank, m.scan, m.place), FAP_E_NOT_FOUND);
    close_model(&m);
}
