/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Compares pictures with those of a folder, NNNN.png by frame number, or brings the folder up to date. What differs is left
 * with a page that shows it in the folder behind -o, build/golden/NAME where there is none; of an update, what was replaced.
 */
#include <dirent.h>
#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "common/tool.h"
#include "player/sinks/golden_report.h"
#include "player/sinks/picture_file.h"
#include "player/sinks/sink.h"

enum { LEVEL_KEEP = 9 };

typedef struct golden_state {
    const sink_setup *setup;
    golden_report report;
    sink_result result;
} golden_state;

/* The last part of @golden that is not "/" or ".". */
static void name_left(const char *golden, char left[GOLDEN_PATH_SIZE])
{
    size_t end = strlen(golden);

    while (end && (golden[end - 1] == '/' || golden[end - 1] == '.'))
        end--;
    size_t start = end;
    while (start && golden[start - 1] != '/')
        start--;
    snprintf(left, GOLDEN_PATH_SIZE, "build/golden/%.*s", (int)(end - start), golden + start);
}

/* Golden pictures among those that differ from them would be lost. */
static int is_same_folder(const char *a, const char *b)
{
    struct stat x, y;

    return !stat(a, &x) && !stat(b, &y) && x.st_dev == y.st_dev && x.st_ino == y.st_ino;
}

static int check_folders(const sink_setup *setup, fault *f)
{
    struct stat s;

    if (setup->output &&
        (is_same_folder(setup->golden, setup->output) || !strcmp(setup->golden, setup->output)))
        return fault_set(f, EXIT_USAGE, "%s: what differs needs another folder than the golden pictures",
                         setup->output);
    if (!setup->update && (stat(setup->golden, &s) || !S_ISDIR(s.st_mode)))
        return fault_set(f, EXIT_DATA, "%s: no such folder; --update makes it, from pictures as they are now",
                         setup->golden);
    return 1;
}

static int golden_open(void *state, const sink_setup *setup, fault *f)
{
    golden_state *s = state;
    char left[GOLDEN_PATH_SIZE];

    s->setup = setup;
    if (strlen(setup->golden) >= GOLDEN_PATH_SIZE - 64)
        return fault_set(f, EXIT_USAGE, "the name of the folder is too long");
    if (!check_folders(setup, f))
        return 0;
    name_left(setup->golden, left);
    if (!golden_report_open(&s->report, setup->output ? setup->output : left))
        return fault_set(f, EXIT_USAGE, "the name of the folder is too long");
    s->result.structure = 1;
    return setup->update ? golden_make_folders(setup->golden, f) : 1;
}

/* --- one picture --- */

static golden_verdict judge(const golden_state *s, const image *got, image *golden, const char *path,
                            image_difference *d, image *diff)
{
    const fap_err err = image_read_png(golden, path);

    if (err)
        return err == FAP_E_NOT_FOUND ? GOLDEN_MISSING : GOLDEN_DAMAGED;
    if (golden->width != got->width || golden->height != got->height)
        return GOLDEN_OTHER_SIZE;
    if (image_compare(golden, got, s->setup->tolerance, d, diff))
        return GOLDEN_DAMAGED; /* no memory for the difference */
    return image_same(d) ? GOLDEN_SAME : GOLDEN_DIFFERS;
}

static void count(sink_result *r, const golden_finding *g)
{
    const image_difference *d = &g->difference;
    const int compared = g->verdict == GOLDEN_SAME || g->verdict == GOLDEN_DIFFERS;

    r->same += g->verdict == GOLDEN_SAME;
    r->different += g->verdict != GOLDEN_SAME;
    r->missing += g->verdict == GOLDEN_MISSING;
    r->worst = !compared ? 255 : d->worst > r->worst ? d->worst : r->worst;
    r->structure = !compared ? 0 : d->structure < r->structure ? d->structure : r->structure;
}

/* New pictures of an update are no findings: there is nothing to compare them with. */
static int leave(golden_state *s, const golden_finding *g, const image *golden, const image *got,
                 const image *diff, fault *f)
{
    if (g->verdict == GOLDEN_SAME || (s->setup->update && g->verdict == GOLDEN_MISSING))
        return 1;
    return golden_report_add(&s->report, g, golden->rgba ? golden : NULL, got,
                             g->verdict == GOLDEN_DIFFERS ? diff : NULL, f);
}

/* What is the same stays as it is: nobody wants new bytes for it in a repository. */
static int update(golden_state *s, const golden_finding *g, const image *got, const char *path, fault *f)
{
    if (!s->setup->update || g->verdict == GOLDEN_SAME)
        return 1;
    s->result.updated++;
    return picture_write(got, path, LEVEL_KEEP, f);
}

static int golden_show(void *state, const shown_frame *shown, fault *f)
{
    golden_state *s = state;
    golden_finding g = { .number = shown->number, .time_s = shown->time_s };
    image golden = { 0 }, diff = { 0 };
    char path[GOLDEN_PATH_SIZE];

    if (!golden_picture_name(path, s->setup->golden, shown->number, "", f))
        return 0;
    g.verdict = judge(s, shown->picture, &golden, path, &g.difference, &diff);
    count(&s->result, &g);
    const int ok = leave(s, &g, &golden, shown->picture, &diff, f) && update(s, &g, shown->picture, path, f);
    image_free(&golden);
    image_free(&diff);
    return ok;
}

/* --- the end --- */

/* The number of NNNN.png; -1: another name. */
static int64_t number_of(const char *name)
{
    char *end;
    const size_t digits = strspn(name, "0123456789");

    if (digits < 4 || digits > 18 || strcmp(name + digits, ".png") != 0)
        return -1;
    return strtoll(name, &end, 10);
}

/* Pictures of frames that were not shown: of a longer stream, mostly. */
static void count_stale(golden_state *s)
{
    DIR *folder = opendir(s->setup->golden);
    const struct dirent *entry;

    while (folder && (entry = readdir(folder))) {
        const int64_t n = number_of(entry->d_name);
        s->result.stale += n >= 0 && (n < s->setup->from || n >= s->setup->from + s->setup->count);
    }
    if (folder)
        closedir(folder);
}

static int golden_finish(void *state, sink_result *result, fault *f)
{
    static const char *const advice[2] = {
        "Where the new ones are right, run the same command with <code>--update</code>.",
        "They have been replaced: golden is what was, got is what is there now.",
    };
    golden_state *s = state;
    char missing[64] = "";

    count_stale(s);
    snprintf(s->result.left, sizeof s->result.left, "%s/%s", s->report.folder, golden_page_name);
    if (!s->report.count)
        s->result.left[0] = '\0';
    *result = s->result;
    if (!golden_report_finish(&s->report, s->setup->golden, advice[s->setup->update != 0], s->setup->count,
                              f))
        return 0;
    if (!s->result.different || s->setup->update)
        return 1;
    if (s->result.missing)
        snprintf(missing, sizeof missing, ", %" PRId64 " of them missing", s->result.missing);
    return fault_set(
        f, EXIT_DATA,
        "%s: %" PRId64 " of %" PRId64
        " pictures differ (by up to %d of 255, structure down to %.4g%s); look at %s; --update accepts them",
        s->setup->golden, s->result.different, s->setup->count, s->result.worst, s->result.structure, missing,
        result->left);
}

static void golden_close(void *state)
{
    golden_report_close(&((golden_state *)state)->report);
}

const play_sink sink_golden = {
    .name = "golden",
    .summary = "--golden DIR        compares every picture with DIR/NNNN.png",
    .needs_picture = 1,
    .state_size = sizeof(golden_state),
    .open = golden_open,
    .show = golden_show,
    .finish = golden_finish,
    .close = golden_close,
};
