/* SPDX-License-Identifier: BSD-2-Clause */
/* What people wait for: the tools as processes, beside this program. */
#include <fcntl.h>
#include <spawn.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "bench.h"

extern char **environ;

enum { PATH_SIZE = 512, STARTS = 7, FILMS = 3 };

/* The path of @name beside this program. */
static int beside(const char *name, char path[PATH_SIZE])
{
    const ssize_t length = readlink("/proc/self/exe", path, PATH_SIZE - 1);

    if (length <= 0)
        return 0;
    path[length] = '\0';
    char *slash = strrchr(path, '/');
    if (!slash || (size_t)(slash + 1 - path) + strlen(name) >= PATH_SIZE)
        return 0;
    strcpy(slash + 1, name);
    return 1;
}

/* Seconds from the start of the process to its end; negative: it failed. */
static double time_run(char *const argv[])
{
    const double start = bench_now_s();
    pid_t pid;
    int status;

    if (posix_spawnp(&pid, argv[0], NULL, NULL, argv, environ) || waitpid(pid, &status, 0) != pid || status)
        return -1;
    return bench_now_s() - start;
}

/* The median of @runs; negative: one failed. */
static double time_runs(char *const argv[], int runs)
{
    double seconds[STARTS];

    for (int i = 0; i < runs; i++)
        if ((seconds[i] = time_run(argv)) < 0)
            return -1;
    return bench_median(seconds, runs);
}

double bench_startup_ms(void)
{
    char player[PATH_SIZE], picture[PATH_SIZE];
    char *argv[] = { player,     "tests/golden/smile/stream.fap",
                     "--frames", "0:1",
                     "--size",   "512x512",
                     "--quiet",  "-o",
                     picture,    NULL };

    if (!beside("fapplay", player) || !beside("startup.png", picture))
        return -1;
    const double seconds = time_runs(argv, STARTS);
    unlink(picture);
    return seconds < 0 ? -1 : 1e3 * seconds;
}

/* --- films --- */

static char take[] = "tests/assets/demo_take.c3d", markers[] = "tests/assets/demo_markers.csv",
            sound[] = "tests/assets/demo_take.wav";
static const double take_s = 7;

typedef struct film_paths {
    char fapenc[PATH_SIZE], fapplay[PATH_SIZE];
    char stream[PATH_SIZE], film[PATH_SIZE], video[PATH_SIZE];
} film_paths;

static int find_film_paths(film_paths *p)
{
    return beside("fapenc", p->fapenc) && beside("fapplay", p->fapplay) && beside("film.fap", p->stream) &&
           beside("film.mp4", p->film) && beside("film.y4m", p->video);
}

static double time_film(film_paths *p)
{
    char *encode[] = { p->fapenc, take, "--markers", markers, "--quiet", "-o", p->stream, NULL };
    char *play[] = { p->fapplay, p->stream, "--audio", sound,   "--size",
                     "512x512",  "--quiet", "-o",      p->film, NULL };

    return time_run(encode) < 0 ? -1 : time_runs(play, FILMS);
}

/* The encoder by itself, on the same pictures in a file: no player that makes films with it can be faster. */
static double time_encoder_alone(film_paths *p)
{
    char *play[] = { p->fapplay, p->stream, "--size", "512x512", "--quiet", "-o", p->video, NULL };
    char *encode[] = { "ffmpeg", "-v",   "error",   "-y",      "-i",       p->video, "-i",
                       sound,    "-c:v", "libx264", "-preset", "veryfast", "-crf",   "18",
                       "-c:a",   "aac",  "-b:a",    "160k",    p->film,    NULL };

    return time_run(play) < 0 ? -1 : time_runs(encode, FILMS);
}

static void remove_films(const film_paths *p)
{
    unlink(p->stream);
    unlink(p->film);
    unlink(p->video);
}

double bench_video_x_realtime(void)
{
    film_paths p;

    if (!find_film_paths(&p))
        return -1;
    const double seconds = time_film(&p), alone = seconds < 0 ? -1 : time_encoder_alone(&p);
    remove_films(&p);
    if (alone > 0)
        bench_note("ffmpeg_alone_on_the_same_pictures", take_s / alone, "x");
    return seconds < 0 ? -1 : take_s / seconds;
}
