/* SPDX-License-Identifier: BSD-2-Clause */
/* The times on a contact sheet, and which name asks for which sink. */
#include "tests/test.h"

#include "player/sinks/sheet.h"
#include "player/sinks/sink.h"

static void reads(double time_s, const char *text)
{
    char label[32];

    sheet_label(label, sizeof label, time_s);
    assert_string_equal(label, text);
}

TEST(sheet, labels_are_as_long_as_they_need)
{
    reads(0, "0.00 s");
    reads(1.239, "1.24 s");
    reads(59.994, "59.99 s");
    reads(127.5, "2:07.50");
    reads(3723, "1:02:03.00");
}

TEST(sheet, labels_never_show_sixty_seconds)
{
    reads(59.996, "1:00.00");
    reads(3599.999, "1:00:00.00");
}

TEST(sinks, the_name_of_the_output_chooses)
{
    assert_ptr_equal(sink_by_name("a.png"), &sink_png);
    assert_ptr_equal(sink_by_name("a_%04d.png"), &sink_png_sequence);
    assert_ptr_equal(sink_by_name("a.MP4"), &sink_video);
    assert_ptr_equal(sink_by_name("a.b.webm"), &sink_video);
    assert_ptr_equal(sink_by_name("a.csv"), &sink_csv);
    assert_ptr_equal(sink_by_name("-"), &sink_csv);
    assert_ptr_equal(sink_by_name("null"), &sink_null);
    assert_ptr_equal(sink_by_name("a.null"), &sink_null);
}

TEST(sinks, other_names_choose_nothing)
{
    assert_null(sink_by_name("a"));
    assert_null(sink_by_name("a.tiff"));
    assert_null(sink_by_name("a.png/b"));
    assert_null(sink_by_name("a_%04d.mp4"));
    assert_null(sink_by_name("a_%s.png"));
    assert_null(sink_by_name(""));
}
