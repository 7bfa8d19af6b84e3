/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * See video_in.h. Pictures come as PPM, each with its own size, as a turned film's is not what its header says. Of an interlaced film
 * every field is made a whole picture by ffmpeg's bwdif, so that a dot's two places in one frame are not mixed.
 */
#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/tool.h"
#include "encoder/track/video_in.h"
#include "take/json_text.h"

enum { PROBE_SIZE = 1 << 16, MOST_SIDE = 16384, MOST_PIXELS = 1 << 26 };

/* What ffprobe tells. */
typedef struct probed {
    int is_video;
    double rate_hz, length_s;
    char order[16];
} probed;

/* --- ffprobe --- */

static int missing_program(const char *name, int err, fault *f)
{
    return err == ENOENT
               ? fault_set(f, EXIT_MISSING,
                           "videos need the program %s; install it (Debian: apt install ffmpeg)", name)
               : fault_set(f, EXIT_MISSING, "cannot start %s: %s", name, strerror(err));
}

/* "30000/1001" */
static double read_ratio(text t)
{
    char word[40];
    double above = 0, below = 1;

    snprintf(word, sizeof word, "%.*s", (int)(t.length < sizeof word ? t.length : 0), t.start);
    return sscanf(word, "%lf/%lf", &above, &below) >= 1 && below > 0 && above > 0 ? above / below : 0;
}

static void read_stream(json_text *j, probed *p)
{
    int first = 1;
    text key, value;

    if (!json_text_enter(j, '{'))
        return;
    p->is_video = 1;
    while (json_text_next(j, '}', &first) && json_text_key(j, &key)) {
        if (!json_text_string(j, &value))
            return;
        if (text_is(key, "avg_frame_rate") && read_ratio(value) > 0)
            p->rate_hz = read_ratio(value);
        else if (text_is(key, "r_frame_rate") && !(p->rate_hz > 0))
            p->rate_hz = read_ratio(value);
        else if (text_is(key, "duration") && !(p->length_s > 0))
            text_number(value, &p->length_s);
        else if (text_is(key, "field_order"))
            snprintf(p->order, sizeof p->order, "%.*s", (int)(value.length < 16 ? value.length : 0),
                     value.start);
    }
}

/* {"streams":[{...}],"format":{...}}; both have a duration, the first one counts. */
static void read_probe(const char *said, size_t size, probed *p)
{
    json_text j = json_text_open((const uint8_t *)said, size);
    int first = 1, first_stream = 1;
    text key;

    if (!json_text_enter(&j, '{'))
        return;
    while (json_text_next(&j, '}', &first) && json_text_key(&j, &key)) {
        if (text_is(key, "streams") && json_text_enter(&j, '[')) {
            while (json_text_next(&j, ']', &first_stream))
                read_stream(&j, p);
        } else if (text_is(key, "format")) {
            const int is_video = p->is_video;
            read_stream(&j, p);
            p->is_video = is_video;
        } else {
            json_text_skip(&j);
        }
    }
}

static int probe(const video_in *v, const char *url, probed *p, fault *f)
{
    const char *const argv[] = { "ffprobe",
                                 "-v",
                                 "error",
                                 "-select_streams",
                                 "v:0",
                                 "-show_entries",
                                 "stream=avg_frame_rate,r_frame_rate,field_order,duration:format=duration",
                                 "-of",
                                 "json",
                                 url,
                                 NULL };
    char *arguments[sizeof argv / sizeof *argv];
    child_pipe pipe;

    *p = (probed){ .is_video = 0 };
    for (size_t i = 0; i < sizeof argv / sizeof *argv; i++)
        arguments[i] = (char *)(uintptr_t)argv[i]; /* spawn takes what exec takes, and changes nothing */
    const int err = child_pipe_start(&pipe, arguments, CHILD_WRITES);
    if (err)
        return missing_program("ffprobe", err, f);
    char *said = malloc(PROBE_SIZE);
    const long size = said ? child_pipe_read(&pipe, said, PROBE_SIZE) : -1;
    if (size > 0)
        read_probe(said, (size_t)size, p);
    free(said);
    if (child_pipe_finish(&pipe))
        return fault_set(f, EXIT_DATA, "%s: ffprobe cannot read it; its own words are above", v->path);
    if (!p->is_video || !(p->rate_hz > 0))
        return fault_set(f, EXIT_DATA, "%s: there are no moving pictures in it", v->path);
    return 1;
}

/* --- ffmpeg --- */

/* As ffprobe has it: the second letter is the field that is shown first. */
static track_fields fields_of(const probed *p, track_fields wanted)
{
    if (wanted != FIELDS_AUTO)
        return wanted;
    if (!strcmp(p->order, "tt") || !strcmp(p->order, "bt"))
        return FIELDS_TOP_FIRST;
    if (!strcmp(p->order, "bb") || !strcmp(p->order, "tb"))
        return FIELDS_BOTTOM_FIRST;
    return FIELDS_NONE;
}

static void tell(const char **argv, int *count, const char *one, const char *two)
{
    argv[(*count)++] = one;
    argv[(*count)++] = two;
}

static int start(video_in *v, const char *url, const track_options *opt, track_fields fields, fault *f)
{
    char from[32], length[32], rate[32];
    const char *argv[32] = { "ffmpeg", "-hide_banner", "-nostdin" };
    char *arguments[32];
    int count = 3;

    snprintf(from, sizeof from, "%.6f", opt->start_s);
    snprintf(length, sizeof length, "%.6f", opt->end_s - opt->start_s);
    snprintf(rate, sizeof rate, "%.9g", v->rate_hz);
    tell(argv, &count, "-loglevel", "error");
    if (opt->start_s > 0)
        tell(argv, &count, "-ss", from);
    tell(argv, &count, "-i", url);
    if (opt->end_s > 0)
        tell(argv, &count, "-t", length);
    if (v->fields)
        tell(argv, &count, "-vf",
             fields == FIELDS_TOP_FIRST ? "bwdif=mode=send_field:parity=tff:deint=all"
                                        : "bwdif=mode=send_field:parity=bff:deint=all");
    tell(argv, &count, "-map", "0:v:0");
    tell(argv, &count, "-r", rate);
    tell(argv, &count, "-f", "image2pipe");
    tell(argv, &count, "-c:v", "ppm");
    argv[count++] = "pipe:1";
    for (int i = 0; i <= count; i++)
        arguments[i] = (char *)(uintptr_t)argv[i];
    const int err = child_pipe_start(&v->pipe, arguments, CHILD_WRITES);
    return err ? missing_program("ffmpeg", err, f) : 1;
}

int video_in_open(video_in *v, const track_options *opt, fault *f)
{
    const size_t size = strlen(opt->video) + sizeof "file:";
    char *url = malloc(size);
    probed p;

    *v = (video_in){ .path = opt->video };
    if (!url)
        return fault_set(f, EXIT_DATA, "out of memory");
    snprintf(url, size, "file:%s", opt->video); /* "-x.mp4" and "http:x.mp4" are names too */
    int opened = probe(v, url, &p, f);
    if (opened) {
        const track_fields fields = fields_of(&p, opt->fields);
        const double end_s = opt->end_s > 0 ? opt->end_s : p.length_s;
        v->fields = fields != FIELDS_NONE;
        v->rate_hz = p.rate_hz * (v->fields ? 2 : 1);
        v->expected = end_s > opt->start_s ? llround((end_s - opt->start_s) * v->rate_hz) : 0;
        opened = start(v, url, opt, fields, f);
    }
    free(url);
    return opened;
}

/* --- pictures --- */

/* The next number of the head, which blanks end; -1: it is none. */
static int read_whole(video_in *v)
{
    int value = 0, digits = 0;
    char c = ' ';

    while (child_pipe_read(&v->pipe, &c, 1) == 1 && isspace((unsigned char)c) && !digits)
        continue;
    for (; isdigit((unsigned char)c); digits++) {
        value = 10 * value + (c - '0');
        if (value > MOST_SIDE || child_pipe_read(&v->pipe, &c, 1) != 1)
            return -1;
    }
    return digits && isspace((unsigned char)c) ? value : -1;
}

static int make_room(video_in *v, size_t size)
{
    if (size <= v->room)
        return 1;
    uint8_t *more = realloc(v->rgb, size);
    if (!more)
        return 0;
    v->rgb = more;
    v->room = size;
    return 1;
}

static int broken(const video_in *v, fault *f)
{
    return fault_set(f, EXIT_DATA, "%s: ffmpeg gave up at picture %u; its own words are above", v->path,
                     v->pictures + 1);
}

/* @return 1: "P6" was there; 0: the video has ended. */
static int read_magic(video_in *v, fault *f)
{
    char magic[2];
    const long got = child_pipe_read(&v->pipe, magic, sizeof magic);

    if (got == 2 && !memcmp(magic, "P6", 2))
        return 1;
    if (got || child_pipe_finish(&v->pipe))
        return broken(v, f);
    return v->pictures ? 0 : fault_set(f, EXIT_DATA, "%s: no picture in that part of it", v->path);
}

int video_in_next(video_in *v, fault *f)
{
    if (!read_magic(v, f))
        return 0;
    const int width = read_whole(v), height = read_whole(v), most = read_whole(v);
    if (width < 1 || height < 1 || most != 255 || (long)width * height > MOST_PIXELS)
        return broken(v, f);
    const size_t stride = 3 * (size_t)width, size = stride * (size_t)height;
    if (!make_room(v, size))
        return fault_set(f, EXIT_DATA, "out of memory");
    if (child_pipe_read(&v->pipe, v->rgb, size) != (long)size)
        return broken(v, f);
    v->picture = (fap_picture){ v->rgb, width, height, stride };
    v->pictures++;
    return 1;
}

void video_in_close(video_in *v)
{
    child_pipe_abandon(&v->pipe);
    free(v->rgb);
    v->rgb = NULL;
}
