/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * A film, made by the program ffmpeg behind a pipe. It writes to a temporary name beside the target, which
 * gets its real name when ffmpeg says that all went well. The sound begins at stream time 0 and never makes
 * the film longer or shorter.
 */
#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "common/file.h"
#include "common/tool.h"
#include "common/child_pipe.h"
#include "player/sinks/sink.h"

enum { MOST_ARGUMENTS = 64, TEXT_SIZE = 64 };

/* What is told of each kind of film; mkv is lossless, for tests and further work. */
typedef struct film_format {
    const char *extension, *container;
    const char *const *picture, *const *sound; /* sound NULL: the format has none */
    double most_hz;                            /* frames a second that programs follow */
} film_format;

/* Tagged, because players guess the matrix of untagged films by their size. */
#define BT709                                                                                                \
    "-vf", "scale=out_color_matrix=bt709:out_range=tv", "-pix_fmt", "yuv420p", "-colorspace", "bt709",       \
        "-color_primaries", "bt709", "-color_trc", "bt709"

static const char *const x264[] = { "-c:v", "libx264", "-preset",   "veryfast",   "-crf",
                                    "18",   BT709,     "-movflags", "+faststart", NULL };
static const char *const vp9[] = { "-c:v", "libvpx-vp9", "-deadline", "realtime", "-cpu-used",
                                   "8",    "-row-mt",    "1",         "-crf",     "24",
                                   "-b:v", "0",          BT709,       NULL };
static const char *const ffv1[] = { "-c:v", "ffv1", "-pix_fmt", "bgr0", NULL };
/* Pages show these in a loop. One palette, from the first two seconds at 25 Hz: with one for each picture the background
 * flickers, and the file is four times as large. */
static const char *const webp[] = { "-c:v",     "libwebp_anim", "-lossless", "0", "-quality", "82",
                                    "-pix_fmt", "bgra",         "-loop",     "0", NULL };
static const char *const gif[] = { "-filter_complex",
                                   "split[a][b];[a]trim=end_frame=50,palettegen=stats_mode=full[p];"
                                   "[b][p]paletteuse=dither=bayer:bayer_scale=4:diff_mode=rectangle",
                                   "-loop", "0", NULL };
static const char *const aac[] = { "-c:a", "aac", "-b:a", "160k", NULL };
static const char *const opus[] = { "-c:a", "libopus", NULL };
static const char *const flac[] = { "-c:a", "flac", NULL };

static const film_format formats[] = {
    { ".mp4", "mp4", x264, aac, INFINITY },
    { ".webm", "webm", vp9, opus, INFINITY },
    { ".mkv", "matroska", ffv1, flac, INFINITY },
    { ".webp", "webp", webp, NULL, INFINITY },
    { ".gif", "gif", gif, NULL, 50 },
};

typedef struct video_state {
    const sink_setup *setup;
    out_file file;
    child_pipe child;
    const char *argument[MOST_ARGUMENTS]; /* for ffmpeg, then NULL */
    int count;
    char size[TEXT_SIZE], rate[TEXT_SIZE], start[TEXT_SIZE], length[TEXT_SIZE];
    char *sound_url, *film_url;
} video_state;

static const film_format *format_of(const char *path)
{
    const char *dot = strrchr(path, '.');

    for (size_t i = 0; dot && i < sizeof formats / sizeof *formats; i++)
        if (!strcasecmp(dot, formats[i].extension))
            return &formats[i];
    return NULL;
}

static void tell(video_state *s, const char *argument)
{
    if (s->count < MOST_ARGUMENTS - 1)
        s->argument[s->count++] = argument;
}

static void tell_all(video_state *s, const char *const *arguments)
{
    while (*arguments)
        tell(s, *arguments++);
}

/* "file:" keeps names like "http://x.mp4" or "-x.mp4" what they are: names of files. */
static char *file_url(const char *path)
{
    const size_t size = strlen(path) + sizeof "file:";
    char *url = malloc(size);

    if (url)
        snprintf(url, size, "file:%s", path);
    return url;
}

static void tell_picture_input(video_state *s)
{
    snprintf(s->size, sizeof s->size, "%dx%d", s->setup->width, s->setup->height);
    snprintf(s->rate, sizeof s->rate, "%.9g", s->setup->rate_hz);
    const char *const input[] = { "-f",         "rawvideo", "-pix_fmt", "rgba",   "-video_size", s->size,
                                  "-framerate", s->rate,    "-i",       "pipe:0", NULL };
    tell_all(s, input);
}

/* Only as much sound is read as there is film: -shortest would drop pictures where the sound ends early. */
static void tell_sound_input(video_state *s)
{
    snprintf(s->start, sizeof s->start, "%.6f", (double)s->setup->from / s->setup->rate_hz);
    snprintf(s->length, sizeof s->length, "%.6f", (double)s->setup->count / s->setup->rate_hz);
    const char *const input[] = { "-ss",  s->start, "-t",   s->length, "-i", s->sound_url,
                                  "-map", "0:v:0",  "-map", "1:a:0",   NULL };
    tell_all(s, input);
}

static int tell_everything(video_state *s)
{
    static const char *const manners[] = { "ffmpeg", "-hide_banner", "-loglevel", "error", "-y", NULL };
    const film_format *format = format_of(s->setup->output);

    s->film_url = file_url(s->file.temp);
    s->sound_url = s->setup->audio ? file_url(s->setup->audio) : NULL;
    if (!s->film_url || (s->setup->audio && !s->sound_url))
        return 0;
    tell_all(s, manners);
    tell_picture_input(s);
    if (s->sound_url)
        tell_sound_input(s);
    tell_all(s, format->picture);
    if (s->sound_url)
        tell_all(s, format->sound);
    const char *const output[] = { "-f", format->container, s->film_url, NULL };
    tell_all(s, output);
    return 1;
}

static int start_ffmpeg(video_state *s, fault *f)
{
    char *argv[MOST_ARGUMENTS];

    for (int i = 0; i <= s->count; i++)
        argv[i] = (char *)(uintptr_t)s->argument[i]; /* spawn takes what exec takes, and changes nothing */
    const int err = child_pipe_start(&s->child, argv, CHILD_READS);
    if (err == ENOENT)
        return fault_set(f, EXIT_MISSING,
                         "films need the program ffmpeg; install it (Debian: apt install ffmpeg) or "
                         "write pictures (-o NAME_%%04d.png)");
    return err ? fault_set(f, EXIT_MISSING, "cannot start ffmpeg: %s", strerror(err)) : 1;
}

static int video_open(void *state, const sink_setup *setup, fault *f)
{
    video_state *s = state;

    s->setup = setup;
    if (setup->audio && !format_of(setup->output)->sound)
        return fault_set(f, EXIT_USAGE, "%s: this format has no sound; leave --audio away, or ask for .mp4",
                         setup->output);
    if (setup->rate_hz > format_of(setup->output)->most_hz)
        return fault_set(f, EXIT_USAGE,
                         "%s: programs slow this format down above %g frames a second; use --fps",
                         setup->output, format_of(setup->output)->most_hz);
    if (out_file_open(&s->file, setup->output))
        return fault_set(f, EXIT_DATA, "%s: %s", setup->output, strerror(errno));
    return tell_everything(s) ? start_ffmpeg(s, f) : fault_set(f, EXIT_DATA, "out of memory");
}

static int gave_up(const video_state *s, fault *f)
{
    return fault_set(f, EXIT_DATA, "%s: ffmpeg failed; its own words are above", s->setup->output);
}

static int video_show(void *state, const shown_frame *shown, fault *f)
{
    video_state *s = state;
    const image *picture = shown->picture;
    const size_t size = (size_t)picture->width * (size_t)picture->height * 4;

    return child_pipe_write(&s->child, picture->rgba, size) ? gave_up(s, f) : 1;
}

static int video_finish(void *state, sink_result *result, fault *f)
{
    video_state *s = state;

    (void)result;
    if (child_pipe_finish(&s->child))
        return gave_up(s, f);
    if (out_file_commit(&s->file))
        return fault_set(f, EXIT_DATA, "%s: %s", s->setup->output, strerror(errno));
    return 1;
}

static void video_close(void *state)
{
    video_state *s = state;

    child_pipe_abandon(&s->child);
    out_file_abandon(&s->file);
    free(s->film_url);
    free(s->sound_url);
}

const play_sink sink_video = {
    .name = "film",
    .summary = "NAME.mp4, .webm, .mkv, .webp, .gif   a film (needs the program ffmpeg; mkv is lossless)",
    .needs_picture = 1,
    .state_size = sizeof(video_state),
    .open = video_open,
    .show = video_show,
    .finish = video_finish,
    .close = video_close,
};
