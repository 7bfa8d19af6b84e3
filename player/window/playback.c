/* SPDX-License-Identifier: BSD-2-Clause */
/* See playback.h. */
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include "common/tool.h"
#include "player/sinks/picture_file.h"
#include "player/window/playback.h"

static const int64_t message_lasts_us = 4000000;
static const double most_ahead_us = 200000;
/* The first pictures compile shaders and fill caches: they are shown, and tell nothing about how long one takes. */
enum { WARM_UP = 10 };

/* --- words --- */

void playback_say(playback *p, const char *fmt, ...)
{
    va_list args;

    va_start(args, fmt);
    vsnprintf(p->message, sizeof p->message, fmt, args);
    va_end(args);
    p->message_until_us = monotonic_us() + message_lasts_us;
}

const char *playback_message(const playback *p)
{
    return p->message[0] && monotonic_us() < p->message_until_us ? p->message : NULL;
}

/* In a window that goes on, a fault is a message. */
static void say_fault(playback *p)
{
    playback_say(p, "%.240s", p->report->fault.text);
    p->report->fault = (fault){ 0 };
}

static const char *file_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

/* --- sound --- */

static void exchange_clock(playback *p, play_clock clock)
{
    play_clock_close(&p->clock);
    p->clock = clock;
    snprintf(p->report->window.clock, sizeof p->report->window.clock, "%s", clock.kind->name);
}

static int silence(playback *p)
{
    play_clock clock;

    p->sound[0] = '\0';
    if (play_clock_silent(&clock, monotonic_us))
        return fault_set(&p->report->fault, EXIT_DATA, "out of memory");
    exchange_clock(p, clock);
    return 1;
}

/* A machine without a sound device plays all the same, and says so. */
static int no_device(playback *p, const char *where)
{
    play_report_note(p->report, "%s; plays without sound", where);
    playback_say(p, "%s; plays without sound", where);
    return 1;
}

/* In place of the clock there is. */
static int load_sound(playback *p, const char *path)
{
    char where[FAP_ERROR_TEXT_SIZE] = "";
    play_clock clock;
    sound s;
    fap_err err = sound_load(&s, path, where);

    if (err)
        return fault_set(&p->report->fault, err == FAP_E_UNSUPPORTED ? EXIT_MISSING : EXIT_DATA, "%s: %s",
                         path, where[0] ? where : fap_strerror(err));
    p->report->sound_s = (double)s.frame_count / s.rate_hz;
    err = play_clock_sound(&clock, &s, p->opt->audio_offset_ms, where);
    if (err == FAP_E_UNSUPPORTED)
        return no_device(p, where);
    if (err)
        return fault_set(&p->report->fault, EXIT_DATA, "%s: %s", path, fap_strerror(err));
    exchange_clock(p, clock);
    snprintf(p->sound, sizeof p->sound, "%s", path);
    return 1;
}

/* --- from and to nothing --- */

static double rate_of(const playback *p)
{
    return p->opt->rate_hz > 0 ? p->opt->rate_hz : p->scene.line.rate_hz;
}

static void note_stream(playback *p, const char *path)
{
    snprintf(p->stream, sizeof p->stream, "%s", path);
    p->report->rate_hz = rate_of(p);
    p->stale = 1;
}

static void start_session(playback *p)
{
    session *s = &p->session;

    session_open(s, &p->clock, p->scene.line.end_us, rate_of(p));
    session_act(s, (play_event){ PLAY_CAMERA, p->opt->camera, 0 });
    session_act(s, (play_event){ PLAY_BLEND, p->opt->face.blend, 0 });
    s->loop = p->opt->loop;
    s->fullscreen = p->opt->fullscreen;
    p->starts = !p->opt->paused && !p->lines.trigger.driver;
    if (p->lines.trigger.driver)
        playback_say(p, "waits for the trigger at %.60s:%.60s", p->opt->lines.trigger.chip,
                     p->opt->lines.trigger.line);
}

int playback_open(playback *p, const play_options *o, play_report *r)
{
    *p = (playback){ .opt = o, .report = r, .face = o->face };
    if (!gpio_lines_open(&p->lines, &gpio_system, &o->lines, r) ||
        !scene_load_stream(&p->scene, o->stream, o->fit, r) ||
        !scene_load_bank(&p->scene, o->bank, &p->face, 1, r) || !silence(p) ||
        (o->audio && !load_sound(p, o->audio)))
        return 0;
    note_stream(p, o->stream);
    start_session(p);
    return 1;
}

static void complete_report(playback *p)
{
    window_report *w = &p->report->window;

    w->session = p->session;
    w->session.clock = NULL;
    if (p->measured_count)
        w->av_offset_mean_ms = p->offset_sum_ms / (double)p->measured_count;
}

void playback_close(playback *p)
{
    complete_report(p);
    gpio_lines_close(&p->lines);
    play_clock_close(&p->clock);
    scene_free(&p->scene);
}

/* --- from picture to picture --- */

/* A method that this face does not have leaves the one before. */
static void exchange_face(playback *p)
{
    fap_face_config face = p->face;

    face.blend = p->session.blend;
    if (scene_open_face(&p->scene, &face, p->report)) {
        p->face = face;
        p->stale = 1;
        return;
    }
    p->session.blend = p->face.blend;
    say_fault(p);
}

/* --- lines --- */

int playback_listens(const playback *p)
{
    return p->lines.trigger.driver || p->opt->lines.button_count > 0;
}

int playback_obey(playback *p)
{
    enum { MOST_AT_ONCE = 64 }; /* a line that never rests leaves time for pictures */
    play_event event;
    int count = 0;

    while (p->armed && count < MOST_AT_ONCE && gpio_poll_action(&p->lines, &event)) {
        session_act(&p->session, event);
        count++;
    }
    return count;
}

/*
 * Others are told what has been seen: called once a picture is, or when there is none to wait for. The last frame is one that
 * plays, so it comes before the stop; and what began and ended between two pictures did both.
 */
static void tell_lines(playback *p)
{
    const session *s = &p->session;
    const int ended = s->ends != p->told_ends;

    if ((s->playing || ended) && !p->lines.playing)
        gpio_on_start(&p->lines);
    if (p->fresh && p->lines.playing)
        gpio_on_frame(&p->lines);
    if (!s->playing && p->lines.playing)
        gpio_on_stop(&p->lines);
    if (ended)
        gpio_on_end(&p->lines);
    p->told_ends = s->ends;
    p->fresh = 0;
}

int playback_advance(playback *p)
{
    session *s = &p->session;

    p->ticked_us = monotonic_us();
    session_tick(s, (int64_t)p->ahead_us);
    if (s->blend != p->face.blend)
        exchange_face(p);
    if (!p->stale && s->at_us == p->posed_us && s->expression == p->posed_expression) {
        tell_lines(p);
        return 0;
    }
    scene_pose(&p->scene, s->at_us, s->expression, p->report);
    p->posed_us = s->at_us;
    p->posed_expression = s->expression;
    p->stale = 0;
    p->fresh = 1;
    p->report->shown_frames++;
    return 1;
}

static void measure_offset(playback *p)
{
    window_report *w = &p->report->window;
    const double offset_ms = fabs((double)(play_clock_position_us(&p->clock) - p->posed_us)) * 1e-3;

    w->av_offset_ms = fmax(w->av_offset_ms, offset_ms);
    p->offset_sum_ms += offset_ms;
    p->measured_count++;
}

/* How long the next picture will take, from how long the last ones did. */
static void learn_delay(playback *p, double took_us)
{
    const double share = p->seen_count < WARM_UP ? 1 : 0.1;

    p->ahead_us += share * (fmin(most_ahead_us, took_us) - p->ahead_us);
    p->seen_count++;
}

void playback_seen(playback *p)
{
    const session *s = &p->session;

    if (p->starts)
        session_act(&p->session, (play_event){ PLAY_START, 0, 0 });
    else if (s->playing) {
        if (p->seen_count >= WARM_UP && s->speed == 1 && s->at_us + 1 < s->length_us)
            measure_offset(p);
        learn_delay(p, (double)(monotonic_us() - p->ticked_us));
    }
    p->starts = 0;
    tell_lines(p);
    if (!p->armed)
        gpio_lines_arm(&p->lines);
    p->armed = 1;
}

/* --- what is dropped on it --- */

typedef enum drop_kind { DROP_BANK, DROP_STREAM, DROP_SOUND, DROP_KIND_COUNT } drop_kind;

static int ends_with(const char *path, const char *ending)
{
    const char *dot = strrchr(path, '.');
    return dot && !strcasecmp(dot, ending);
}

/* What is neither face nor stream is given to libsndfile, which knows more kinds than there are endings. */
static drop_kind kind_of(const char *path)
{
    if (ends_with(path, ".fbank"))
        return DROP_BANK;
    return ends_with(path, ".fap") || ends_with(path, ".fba") ? DROP_STREAM : DROP_SOUND;
}

static int drop_bank(playback *p, const char *path)
{
    if (!scene_load_bank(&p->scene, path, &p->face, 1, p->report))
        return 0;
    p->bank_number++;
    p->stale = 1;
    return 1;
}

/* The sound was the other stream's. */
static int drop_stream(playback *p, const char *path)
{
    if (!scene_load_stream(&p->scene, path, NULL, p->report) || !silence(p))
        return 0;
    note_stream(p, path);
    session_change(&p->session, &p->clock, p->scene.line.end_us, rate_of(p));
    return 1;
}

static int drop_sound(playback *p, const char *path)
{
    if (!load_sound(p, path))
        return 0;
    session_change(&p->session, &p->clock, p->scene.line.end_us, rate_of(p));
    return 1;
}

static void drop_one(playback *p, const char *path, drop_kind kind)
{
    static int (*const take[DROP_KIND_COUNT])(playback *, const char *) = {
        [DROP_BANK] = drop_bank,
        [DROP_STREAM] = drop_stream,
        [DROP_SOUND] = drop_sound,
    };

    playback_say(p, "%.200s", file_name(path));
    if (!take[kind](p, path))
        say_fault(p);
}

/* A stream before the sound that came with it, in whichever order the files were picked up. */
void playback_drop(playback *p, int count, const char *const *paths)
{
    for (int kind = 0; kind < DROP_KIND_COUNT; kind++)
        for (int i = 0; i < count; i++)
            if (kind_of(paths[i]) == (drop_kind)kind)
                drop_one(p, paths[i], (drop_kind)kind);
}

/* --- pictures to keep --- */

enum { MOST_PICTURES_OF_A_FRAME = 1000 };

static void picture_name(const playback *p, int copy, char *path, size_t room)
{
    const char *name = strcmp(p->stream, "-") ? file_name(p->stream) : "stream";
    const char *dot = strrchr(name, '.');
    const int length = dot && dot > name ? (int)(dot - name) : (int)strlen(name);
    char suffix[16] = "";

    if (copy > 1)
        snprintf(suffix, sizeof suffix, "-%d", copy);
    snprintf(path, room, "%.*s-%05" PRId64 "%s.png", length, name, session_frame(&p->session), suffix);
}

/* A name that nobody has, taken at once so that nobody else gets it. */
static int take_name(const playback *p, char *path, size_t room)
{
    for (int copy = 1; copy <= MOST_PICTURES_OF_A_FRAME; copy++) {
        picture_name(p, copy, path, room);
        const int file = open(path, O_WRONLY | O_CREAT | O_EXCL, 0666);
        if (file >= 0)
            return close(file) == 0;
        if (errno != EEXIST)
            return 0;
    }
    return 0;
}

void playback_save(playback *p, const image *picture)
{
    enum { LEVEL_KEEP = 6 };
    char *path = p->report->window.screenshot;

    if (!take_name(p, path, sizeof p->report->window.screenshot)) {
        playback_say(p, "%.200s: %s", path, strerror(errno));
        path[0] = '\0';
    } else if (!picture_write(picture, path, LEVEL_KEEP, &p->report->fault)) {
        unlink(path);
        path[0] = '\0';
        say_fault(p);
    } else {
        p->report->window.screenshot_count++;
        playback_say(p, "saved %.200s", path);
    }
}
