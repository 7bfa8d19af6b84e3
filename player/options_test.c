/* SPDX-License-Identifier: BSD-2-Clause */
/* The command line of fapplay. What is refused also says so on stderr. */
#include "tests/test.h"

#include <stdio.h>
#include <string.h>

#include "common/tool.h"
#include "player/options.h"
#include "player/sinks/csv.h"

enum { MOST_WORDS = 32 };

/* Parses "fapplay " and the blank-separated words of @line; o's strings live in @room. */
static int parse(play_options *o, const char *line)
{
    static char room[512];
    char *argv[MOST_WORDS + 1] = { "fapplay" }, *rest;
    int argc = 1;

    snprintf(room, sizeof room, "%s", line);
    for (char *word = strtok_r(room, " ", &rest); word && argc < MOST_WORDS;
         word = strtok_r(NULL, " ", &rest))
        argv[argc++] = word;
    return play_options_parse(o, argc, argv);
}

static void takes(play_options *o, const char *line)
{
    assert_true(parse(o, line));
}

static void refuses(const char *line)
{
    play_options o;

    assert_false(parse(&o, line));
    assert_int_equal(o.exit_status, EXIT_USAGE);
}

TEST(play_options, defaults_are_those_of_the_help)
{
    play_options o;

    takes(&o, "a.fap -o a.png");
    assert_string_equal(o.stream, "a.fap");
    assert_string_equal(o.output, "a.png");
    assert_ptr_equal(o.sink, &sink_png);
    assert_null(o.bank);
    assert_int_equal(o.face.blend, FAP_BLEND_GA);
    assert_int_equal(o.face.generations, 70);
    assert_int_equal(o.face.residual, 1);
    assert_int_equal(o.width, 720);
    assert_int_equal(o.tolerance, 2);
    assert_false(o.has_range);
}

TEST(play_options, without_output_there_is_a_window)
{
    play_options o;

    takes(&o, "a.fap --audio a.wav --audio-offset -40 --loop --paused --camera left --blend rbf");
    assert_null(o.sink);
    assert_float_equal(o.audio_offset_ms, -40, 0);
    assert_true(o.loop && o.paused && !o.fullscreen);
    assert_int_equal(o.width, 1180);
    takes(&o, "a.fap --size 640x480");
    assert_int_equal(o.height, 480);
}

TEST(play_options, every_option_of_the_face_arrives)
{
    play_options o;

    takes(&o,
          "--bank b.fbank --blend zhu --crossover blx --generations 5 --emphasis 1.5 --temporal 20 --seed 9 "
          "--no-residual --blink --regions 4 --overlap 12.5 "
          "- --output null");
    assert_string_equal(o.stream, "-");
    assert_string_equal(o.bank, "b.fbank");
    assert_int_equal(o.face.blend, FAP_BLEND_ZHU);
    assert_int_equal(o.face.crossover, FAP_CROSSOVER_BLX);
    assert_int_equal(o.face.generations, 5);
    assert_float_equal(o.face.emphasis, 1.5, 0);
    assert_float_equal(o.face.temporal_mm2, 20, 0);
    assert_int_equal(o.face.seed, 9);
    assert_int_equal(o.face.residual, 0);
    assert_int_equal(o.face.blink, 1);
    assert_int_equal(o.face.regions, 4);
    assert_float_equal(o.face.overlap_percent, 12.5, 0);
}

TEST(play_options, every_method_has_its_name)
{
    for (int i = 0; fap_blend_name(i); i++) {
        play_options o;
        char line[64];
        snprintf(line, sizeof line, "a.fap -o a.png --blend %s", fap_blend_name(i));
        takes(&o, line);
        assert_int_equal(o.face.blend, i);
    }
}

TEST(play_options, every_option_of_the_picture_arrives)
{
    play_options o;

    takes(&o, "a.fap -o a.mp4 --size 64x32 --fps 29.97 --frames 3:9 --camera three-quarter --audio a.wav "
              "--gl egl "
              "--json --quiet");
    assert_int_equal(o.width, 64);
    assert_int_equal(o.height, 32);
    assert_float_equal(o.rate_hz, 29.97, 1e-12);
    assert_int_equal(o.from, 3);
    assert_int_equal(o.to, 9);
    assert_int_equal(o.camera, CAMERA_THREE_QUARTER);
    assert_string_equal(o.gl, "egl");
    assert_string_equal(o.audio, "a.wav");
    assert_true(o.json && o.quiet);
}

TEST(play_options, backgrounds_and_textures_arrive)
{
    const uint8_t rgb[3] = { 0x20, 0x40, 0xff };
    play_options o;

    takes(&o, "a.fap -o a.png --background #2040fF --texture skin.png");
    assert_int_equal(o.dress.backdrop, BACKDROP_COLOUR);
    assert_memory_equal(o.dress.rgb, rgb, 3);
    assert_string_equal(o.dress.skin, "skin.png");
    takes(&o, "a.fap --background wall.png");
    assert_int_equal(o.dress.backdrop, BACKDROP_PICTURE);
    assert_string_equal(o.dress.picture, "wall.png");
    takes(&o, "a.fap --background wall.png --background studio");
    assert_int_equal(o.dress.backdrop, BACKDROP_STUDIO);
    assert_null(o.dress.picture);
    takes(&o, "a.fap -o a_%d.png --background none");
    assert_int_equal(o.dress.backdrop, BACKDROP_NOTHING);
}

TEST(play_options, backgrounds_that_cannot_be_are_refused)
{
    refuses("a.fap --background #12345");
    refuses("a.fap --background #1234567");
    refuses("a.fap --background #12 456");
    refuses("a.fap --background #-12345");
    refuses("a.fap --background none"); /* a window shows no holes */
    refuses("a.fap --background none -o a.mp4");
}

TEST(play_options, either_end_of_a_range_may_be_left_out)
{
    play_options o;

    takes(&o, "a.fap -o null --frames 5:");
    assert_int_equal(o.from, 5);
    assert_true(o.to == INT64_MAX);
    takes(&o, "a.fap -o null --frames :7");
    assert_int_equal(o.from, 0);
    assert_int_equal(o.to, 7);
}

TEST(play_options, sheet_and_golden_choose_their_sinks)
{
    play_options o;

    takes(&o, "a.fap --sheet 6 -o a.png");
    assert_ptr_equal(o.sink, &sink_sheet);
    assert_int_equal(o.moments, 6);
    assert_int_equal(o.width, 320);
    takes(&o, "a.fap --sheet 6 -o -");
    assert_ptr_equal(o.sink, &sink_sheet);
    takes(&o, "a.fap --golden dir --update --tolerance 0");
    assert_ptr_equal(o.sink, &sink_golden);
    assert_int_equal(o.tolerance, 0);
}

TEST(play_options, help_and_version_are_no_errors)
{
    play_options o;

    assert_false(parse(&o, "--version"));
    assert_int_equal(o.exit_status, EXIT_OK);
}

TEST(play_options, lines_arrive)
{
    play_options o;

    takes(&o, "a.fap -o null --trigger 0:1:falling --tally 0:2 --frame-sync 0:SYNC --end-pulse 0:4:20");
    assert_string_equal(o.lines.trigger.line, "1");
    assert_int_equal(o.lines.trigger.edge, GPIO_FALLING);
    assert_string_equal(o.lines.tally.line, "2");
    assert_string_equal(o.lines.frame_sync.line, "SYNC");
    assert_int_equal(o.lines.end_pulse.pulse_ns, 20000000);
    refuses("a.fap -o null --trigger 0");
    refuses("a.fap -o null --tally 0:1:pull-up");
    refuses("a.fap -o null --frame-sync 0:1:rising");
    refuses("a.fap -o null --end-pulse 0:1:0");
    refuses("a.fap -o null --button 0:1=dance");
    refuses("a.fap -o null --button 0:1=pause");
}

TEST(play_options, wrong_values_are_refused)
{
    static const char *const wrong[] = {
        "--size 0x5",
        "--size 5x0",
        "--size 5",
        "--size 5x",
        "--size x5",
        "--size 8193x1",
        "--size -5x5",
        "--size 5x5x5",
        "--fps 0",
        "--fps -1",
        "--fps nan",
        "--fps inf",
        "--fps 1001",
        "--fps 5x",
        "--frames 5",
        "--frames 5:5",
        "--frames 6:5",
        "--frames -1:5",
        "--frames a:b",
        "--frames 1:2:3",
        "--frames 99999999999999999999:",
        "--blend best",
        "--regions 3",
        "--regions 0",
        "--overlap 51",
        "--overlap -1",
        "--crossover two",
        "--generations -1",
        "--generations 100001",
        "--emphasis -1",
        "--emphasis 11",
        "--temporal -1",
        "--seed -1",
        "--seed 0x1",
        "--camera back",
        "--gl vulkan",
        "--tolerance 256",
        "--sheet 0",
        "--sheet 1025",
        "--update",
    };
    char line[128];

    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        snprintf(line, sizeof line, "a.fap -o a.png %s", wrong[i]);
        refuses(line);
    }
}

TEST(play_options, wrong_combinations_are_refused)
{
    refuses("");
    refuses("a.fap --frames 1:2");
    refuses("a.fap --gl egl");
    refuses("a.fap -o a.png --loop");
    refuses("a.fap -o a.png --paused");
    refuses("a.fap -o a.mp4 --audio a.wav --audio-offset 20");
    refuses("a.fap --audio-offset 60001");
    refuses("a.fap --audio-offset nan");
    refuses("-o a.png");
    refuses("a.fap b.fap -o a.png");
    refuses("a.fap -o a.tiff");
    refuses("a.fap -o a_%s.png");
    refuses("a.fap -o a_%04d_%04d.png");
    refuses("a.fap -o a.mp4 --size 63x64");
    refuses("a.fap -o a.png --audio a.wav");
    refuses("a.fap -o - --json");
    refuses("a.fap -o a.mp4 --sheet 4");
    refuses("a.fap -o a_%04d.png --sheet 4");
    refuses("a.fap --sheet 4");
    refuses("a.fap --sheet 4 --golden d");
    refuses("a.fap -o a.csv --y4m");
    refuses("a.fap -o a.y4m --y4m");
    refuses("a.fap --y4m");
    refuses("a.fap -o - --y4m --csv faps");
    refuses("a.fap --no-such-option");
    refuses("a.fap -o");
    refuses("a.fap -x -o a.png");
}

TEST(play_options, a_pipe_takes_numbers_or_video)
{
    play_options o;

    takes(&o, "a.fap -o -");
    assert_ptr_equal(o.sink, &sink_csv);
    takes(&o, "a.fap -o - --y4m");
    assert_ptr_equal(o.sink, &sink_y4m);
    takes(&o, "a.fap -o a.y4m --size 63x31");
    assert_ptr_equal(o.sink, &sink_y4m);
}

TEST(play_options, tables_have_a_kind)
{
    play_options o;

    takes(&o, "a.fap -o a.csv --csv weights");
    assert_string_equal(o.csv->name, "weights");
    takes(&o, "a.fap -o - --csv faps");
    assert_string_equal(o.csv->name, "faps");
    refuses("a.fap -o a.csv --csv Weights");
    refuses("a.fap -o a.png --csv weights");
    refuses("a.fap --csv weights");
    refuses("a.fap --golden dir --csv weights");
}

TEST(play_options, a_glb_is_one_file)
{
    play_options o;

    takes(&o, "a.fap -o a.glb --frames 3:5 --fps 30");
    assert_ptr_equal(o.sink, &sink_glb);
    refuses("a.fap -o a_%04d.glb");
    refuses("a.fap -o a.glb --audio a.wav");
}
