/* SPDX-License-Identifier: BSD-2-Clause */
/* Showing where dots are. */
#include "tests/test.h"

#include <string.h>

#include "encoder/track/pick.h"

static const char *written(const pick *p, char *text, size_t size)
{
    FILE *out = tmpfile();

    assert_non_null(out);
    pick_write(p, out);
    rewind(out);
    text[fread(text, 1, size - 1, out)] = '\0';
    fclose(out);
    return text;
}

TEST(pick, labels_are_asked_for_in_every_view)
{
    char text[256];
    pick p;

    assert_int_equal(pick_open(&p, "8.4\n# none\n\nnose,ignored\r\n8.3", 1), FAP_OK);
    assert_int_equal(p.dots.count, 3);
    assert_string_equal(p.dots.dot[1].name, "nose");
    pick_click(&p, 10.25, 20);
    pick_skip(&p);
    pick_skip(&p);
    assert_int_equal(p.view, 1);
    assert_int_equal(p.label, 0);
    pick_click(&p, 1, 2);
    pick_click(&p, 3, 4.006);
    pick_skip(&p);
    assert_true(p.finished);
    pick_click(&p, 9, 9); /* too late */
    assert_string_equal(written(&p, text, sizeof text),
                        "label,x,y,mirror1_x,mirror1_y\n8.4,10.25,20.00,1.00,2.00\nnose,,,3.00,4.01\n");
    pick_close(&p);
}

TEST(pick, going_back_forgets)
{
    pick p;

    assert_int_equal(pick_open(&p, "a\nb\n", 2), FAP_OK);
    pick_back(&p);
    assert_int_equal(p.label, 0);
    pick_click(&p, 1, 1);
    pick_click(&p, 2, 2);
    pick_click(&p, 3, 3);
    assert_int_equal(p.view, 1);
    pick_back(&p);
    pick_back(&p);
    assert_int_equal(p.view, 0);
    assert_int_equal(p.label, 1);
    assert_int_equal(pick_count(&p, 1), 0);
    assert_int_equal(pick_count(&p, 0), 1);
    for (int i = 0; i < 5; i++)
        pick_skip(&p);
    assert_true(p.finished);
    pick_back(&p);
    assert_false(p.finished);
    assert_int_equal(p.view, 2);
    assert_int_equal(p.label, 1);
    pick_close(&p);
}

TEST(pick, a_view_is_gone_to_where_it_was_left)
{
    pick p;

    assert_int_equal(pick_open(&p, "a\nb\nc\n", 1), FAP_OK);
    pick_click(&p, 1, 1);
    pick_go_to_view(&p, 1);
    assert_int_equal(p.label, 0);
    pick_go_to_view(&p, 0);
    assert_int_equal(p.label, 1);
    pick_go_to_view(&p, 2);
    assert_int_equal(p.view, 0);
    pick_close(&p);
}

TEST(pick, what_is_written_is_what_the_tracker_reads)
{
    char text[4096], where[FAP_ERROR_TEXT_SIZE];
    fap_track_dots dots;
    pick p;

    assert_int_equal(pick_open(&p, NULL, 2), FAP_OK);
    for (int i = 0; !p.finished; i++)
        (i % 4 ? pick_click(&p, i, 2 * i) : pick_skip(&p));
    written(&p, text, sizeof text);
    assert_int_equal(fap_track_dots_read(&dots, text, strlen(text), NULL, where), FAP_OK);
    assert_int_equal(dots.mirrors, 2);
    assert_int_equal(dots.count, p.dots.count);
    fap_track_dots_close(&dots);
    pick_close(&p);
    assert_int_equal(pick_open(&p, "# nothing\n", 0), FAP_E_NOT_FOUND);
}
