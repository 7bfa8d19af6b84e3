/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * How far picture and sound are apart over a minute, and how long a seek takes until it is seen: what the window does, drawn offscreen,
 * with a sound on SDL's dummy driver, which paces in real time without a sound card.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "bench.h"
#include "common/file.h"
#include "common/streams.h"
#include "player/window/playback.h"

enum { SIDE = 512, RATE_HZ = 25, SECONDS = 60, SOUND_HZ = 16000, SEEKS = 51 };

static const char bank_path[] = "build/default.fbank", stream_path[] = "build/bench_minute.fap",
                  sound_path[] = "build/bench_minute.wav";

/* --- a minute of motion and of sound --- */

static fap_err write_frames(FILE *out)
{
    const fap_writer writer = file_writer(out);
    const fap_ascii_header header = {
        .version = "2.1", .name = "minute", .rate_hz = RATE_HZ, .frame_count = RATE_HZ * SECONDS
    };
    fap_encoder_stats stats;
    stream_writer w;
    fap_frame frame;

    fap_err err = stream_writer_open(&w, &writer, &header, NULL);
    if (err)
        return err;
    for (int t = 0; t < RATE_HZ * SECONDS && !err; t++) {
        bench_wave(&frame, t, 1);
        err = stream_writer_put(&w, &frame);
    }
    const fap_err closed = stream_writer_close(&w, &stats);
    return err ? err : closed;
}

static void put_number(FILE *out, uint32_t value, int bytes)
{
    for (int i = 0; i < bytes; i++)
        fputc((int)(value >> 8 * i & 255), out);
}

/* A WAV file of 16 bits, one channel: a tone that swells. */
static fap_err write_sound(FILE *out)
{
    const uint32_t count = SOUND_HZ * SECONDS;

    fputs("RIFF", out), put_number(out, 36 + 2 * count, 4), fputs("WAVEfmt ", out);
    put_number(out, 16, 4), put_number(out, 1, 2), put_number(out, 1, 2);
    put_number(out, SOUND_HZ, 4), put_number(out, 2 * SOUND_HZ, 4), put_number(out, 2, 2),
        put_number(out, 16, 2);
    fputs("data", out), put_number(out, 2 * count, 4);
    for (uint32_t i = 0; i < count; i++)
        put_number(out, (i & 63) * (i >> 7 & 127), 2);
    return ferror(out) ? FAP_E_IO : FAP_OK;
}

static int write_file(const char *path, fap_err (*write)(FILE *))
{
    out_file f;

    if (out_file_open(&f, path))
        return 0;
    if (write(f.stream) == FAP_OK && out_file_commit(&f) == FAP_OK)
        return 1;
    out_file_abandon(&f);
    return 0;
}

/* --- playing it --- */

typedef struct stage {
    play_options opt;
    play_report report;
    playback play;
    renderer *renderer;
    image picture;
} stage;

static int open_stage(stage *s)
{
    char where[FAP_ERROR_TEXT_SIZE];

    *s = (stage){ .opt = { .stream = stream_path, .bank = bank_path, .audio = sound_path } };
    fap_face_config_init(&s->opt.face);
    setenv("SDL_AUDIODRIVER", "dummy", 1);
    return write_file(stream_path, write_frames) && write_file(sound_path, write_sound) &&
           playback_open(&s->play, &s->opt, &s->report) && s->play.sound[0] &&
           image_create(&s->picture, SIDE, SIDE) == FAP_OK &&
           renderer_create(&s->renderer, NULL, s->play.scene.bank, SIDE, SIDE, where) == FAP_OK;
}

static void close_stage(stage *s)
{
    image_free(&s->picture);
    renderer_destroy(&s->renderer);
    playback_close(&s->play);
    unlink(stream_path);
    unlink(sound_path);
}

/* One picture, as the window makes them; 0 when it cannot. */
static int show(stage *s)
{
    playback *p = &s->play;

    if (!playback_advance(p))
        return 1;
    const render_scene what = { p->scene.position, p->scene.normal, .view = p->session.view };
    if (renderer_draw(s->renderer, &what, &s->picture) != FAP_OK)
        return 0;
    playback_seen(p);
    return 1;
}

double bench_av_offset_ms(void)
{
    stage s;
    double worst = -1;

    if (open_stage(&s) && show(&s)) {
        while (s.play.session.playing && show(&s))
            ;
        worst = s.report.window.av_offset_ms;
        bench_note("mean", s.play.offset_sum_ms / (double)s.play.measured_count, "ms");
        bench_note("pictures", (double)s.report.shown_frames, "in 60 s");
        bench_note("late", (double)s.play.session.late_frames, "frames of 1500");
    }
    close_stage(&s);
    return worst;
}

/* The time behind a seek, until a picture of there is seen. */
static double seek_ms(stage *s, double to_s)
{
    const double start = bench_now_s();

    session_act(&s->play.session, (play_event){ PLAY_SEEK, to_s, 0 });
    return show(s) ? (bench_now_s() - start) * 1e3 : -1;
}

double bench_seek_ms(void)
{
    stage s;
    double took[SEEKS], middle = -1;

    if (open_stage(&s) && show(&s)) {
        for (int i = 0; i < SEEKS; i++)
            took[i] = seek_ms(&s, i * 37 % SECONDS);
        middle = bench_median(took, SEEKS);
        bench_note("slowest", took[SEEKS - 1], "ms");
    }
    close_stage(&s);
    return middle;
}
