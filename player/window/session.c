/* SPDX-License-Identifier: BSD-2-Clause */
/* See session.h. */
#include <math.h>
#include <stddef.h>

#include "player/timeline.h"
#include "player/window/session.h"

static const double usual_speeds[] = { 0.1, 0.25, 0.5, 0.75, 1, 1.5, 2, 3, 4 };
enum { SPEED_COUNT = sizeof usual_speeds / sizeof *usual_speeds };

static const int64_t same_us = 2; /* times of frames are rounded: timeline.c */

/* --- where --- */

static int64_t frame_of(const session *s, int64_t at_us)
{
    const int64_t number = (int64_t)floor((double)(at_us + same_us) * s->rate_hz * 1e-6);
    return number < s->frame_count ? number : s->frame_count - 1;
}

int64_t session_frame(const session *s)
{
    return frame_of(s, s->at_us);
}

static int64_t within(const session *s, double at_us)
{
    return at_us > 0 ? at_us < (double)s->length_us ? llround(at_us) : s->length_us : 0;
}

static void go_to(session *s, int64_t at_us)
{
    s->at_us = at_us;
    play_clock_seek(s->clock, at_us);
}

static void set_playing(session *s, int playing)
{
    if (playing == s->playing)
        return;
    if (playing && s->at_us >= s->length_us)
        go_to(s, 0);
    s->playing = playing;
    if (playing)
        play_clock_start(s->clock);
    else
        play_clock_pause(s->clock);
}

static void step(session *s, double frames)
{
    const double last = (double)(s->frame_count - 1);
    const double number = fmax(0, fmin(last, (double)session_frame(s) + frames));

    set_playing(s, 0);
    go_to(s, timeline_time_us((int64_t)number, s->rate_hz));
}

/* --- how fast --- */

static void set_speed(session *s, double speed)
{
    s->speed = fmax(PLAY_SLOWEST, fmin(PLAY_FASTEST, speed));
    play_clock_set_speed(s->clock, s->speed);
}

/* From a speed between two usual ones a step goes to the nearer end. */
static void step_speed(session *s, int steps)
{
    int i = 0;

    while (i < SPEED_COUNT - 1 && usual_speeds[i] < s->speed - 1e-9)
        i++;
    const int between = usual_speeds[i] > s->speed + 1e-9;
    i += steps - (between && steps > 0);
    set_speed(s, usual_speeds[i < 0 ? 0 : i < SPEED_COUNT ? i : SPEED_COUNT - 1]);
}

/* --- from where it is looked at --- */

static void set_camera(session *s, double value)
{
    if (!(value >= 0 && value < CAMERA_COUNT))
        return;
    s->camera = (int)value;
    s->view = render_view_of((render_camera)s->camera);
}

static void orbit(session *s, double right, double up)
{
    s->view.yaw_degrees = remainderf(s->view.yaw_degrees + (float)right, 360);
    s->view.pitch_degrees = fmaxf(-89, fminf(89, s->view.pitch_degrees + (float)up));
    s->camera = -1;
}

static void pan(session *s, double right, double up)
{
    s->view.right = fmaxf(-2, fminf(2, s->view.right + (float)right));
    s->view.up = fmaxf(-2, fminf(2, s->view.up + (float)up));
    s->camera = -1;
}

static void zoom(session *s, double steps)
{
    s->view.distance = fmaxf(0.15f, fminf(4, s->view.distance * powf(0.9f, (float)steps)));
    s->camera = -1;
}

/* --- how the face is made --- */

static void set_blend(session *s, double value)
{
    if (value >= 0 && fap_blend_name((int)value))
        s->blend = (fap_blend)value;
}

/* Through all that the library has. */
static void next_blend(session *s)
{
    const int next = (int)s->blend + 1;

    s->blend = fap_blend_name(next) ? (fap_blend)next : (fap_blend)0;
}

static void set_expression(session *s, double value)
{
    const int number = value >= 0 && value <= 6 ? (int)value : 0;
    s->expression = number == s->expression ? 0 : number;
}

static void leave(session *s, int help_first)
{
    if (s->help && help_first)
        s->help = 0;
    else
        s->quit = 1;
}

/* --- actions --- */

void session_open(session *s, const play_clock *clock, int64_t length_us, double rate_hz)
{
    *s = (session){ .speed = 1, .panels = 1, .blend = FAP_BLEND_GA };
    set_camera(s, CAMERA_FRONT);
    session_change(s, clock, length_us, rate_hz);
}

void session_change(session *s, const play_clock *clock, int64_t length_us, double rate_hz)
{
    s->clock = clock;
    s->length_us = length_us;
    s->rate_hz = rate_hz;
    s->frame_count = timeline_count_frames(length_us, rate_hz);
    play_clock_set_speed(clock, s->speed);
    go_to(s, 0);
    if (s->playing)
        play_clock_start(clock);
    else
        play_clock_pause(clock);
}

static void start_over(session *s)
{
    go_to(s, 0);
    set_playing(s, 1);
}

void session_act(session *s, play_event e)
{
    switch (e.action) {
    case PLAY_PAUSE: set_playing(s, !s->playing); break;
    case PLAY_START: set_playing(s, 1); break;
    case PLAY_STOP: set_playing(s, 0); break;
    case PLAY_STEP: step(s, e.value); break;
    case PLAY_SEEK: go_to(s, within(s, e.value * 1e6)); break;
    case PLAY_SKIP: go_to(s, within(s, (double)s->at_us + e.value * 1e6)); break;
    case PLAY_NEXT: start_over(s); break;
    case PLAY_SPEED: set_speed(s, e.value); break;
    case PLAY_SPEED_STEP: step_speed(s, (int)e.value); break;
    case PLAY_LOOP: s->loop = !s->loop; break;
    case PLAY_CAMERA: set_camera(s, e.value); break;
    case PLAY_ORBIT: orbit(s, e.value, e.other); break;
    case PLAY_PAN: pan(s, e.value, e.other); break;
    case PLAY_ZOOM: zoom(s, e.value); break;
    case PLAY_RESET_VIEW: set_camera(s, CAMERA_FRONT); break;
    case PLAY_WIREFRAME: s->wireframe = !s->wireframe; break;
    case PLAY_POINTS: s->points = !s->points; break;
    case PLAY_BARS: s->bars = !s->bars; break;
    case PLAY_PANELS: s->panels = !s->panels; break;
    case PLAY_HELP: s->help = !s->help; break;
    case PLAY_BLEND: set_blend(s, e.value); break;
    case PLAY_NEXT_BLEND: next_blend(s); break;
    case PLAY_EXPRESSION: set_expression(s, e.value); break;
    case PLAY_FULLSCREEN: s->fullscreen = !s->fullscreen; break;
    case PLAY_SCREENSHOT: s->screenshots++; break;
    case PLAY_QUIT: leave(s, e.value > 0); break;
    case PLAY_NOTHING:
    case PLAY_ACTION_COUNT: break;
    }
}

/* --- time --- */

/* What is over by less than a round comes in again at the beginning. */
static void wrap(session *s, int64_t at_us)
{
    s->loops++;
    s->ends++;
    go_to(s, at_us % s->length_us);
}

static void end(session *s)
{
    s->ends++;
    set_playing(s, 0);
    go_to(s, s->length_us);
}

/* Faster than it was made a stream loses frames, and nobody misses them. */
static void count_late(session *s, int64_t from, int64_t to)
{
    if (s->speed <= 1 && to > from + 1)
        s->late_frames += to - from - 1;
}

void session_tick(session *s, int64_t ahead_us)
{
    if (!s->playing)
        return;
    const int64_t heard_us = play_clock_position_us(s->clock);
    if (heard_us >= s->length_us) {
        if (s->loop)
            wrap(s, heard_us);
        else
            end(s);
        return;
    }
    const int64_t before = session_frame(s);
    const int64_t seen_us = within(s, (double)heard_us + (double)ahead_us * s->speed);
    s->at_us = seen_us < s->length_us ? seen_us : s->length_us - 1;
    count_late(s, before, session_frame(s));
}
