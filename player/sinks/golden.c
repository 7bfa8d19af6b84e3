/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Compares pictures with those of a folder, NNNN.png by frame number, or makes them anew. A picture that
 * differs leaves NNNN.got.png and NNNN.diff.png in the folder behind -o, build/golden/NAME where there is
 * none.
 */
#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "common/tool.h"
#include "player/sinks/picture_file.h"
#include "player/sinks/sink.h"

enum { LEVEL_KEEP = 9, PATH_SIZE = 4096 };

typedef struct golden_state {
    const sink_setup *setup;
    char left[PATH_SIZE]; /* folder of what differs */
    sink_result result;
} golden_state;

static int name_picture(char *path, const char *folder, int64_t number, const char *kind, fault *f)
{
    if (snprintf(path, PATH_SIZE, "%s/%04" PRId64 "%s.png", folder, number, kind) < PATH_SIZE)
        return 1;
    return fault_set(f, EXIT_DATA, "%s: the name is too long", folder);
}

/* The last part of @path that is not "/" or ".". */
static void name_left(golden_state *s)
{
    const char *golden = s->setup->golden;
    size_t end = strlen(golden);

    while (end && (golden[end - 1] == '/' || golden[end - 1] == '.'))
        end--;
    size_t start = end;
    while (start && golden[start - 1] != '/')
        start--;
    snprintf(s->left, sizeof s->left, "build/golden/%.*s", (int)(end - start), golden + start);
}

static int make_folders(const char *path, fault *f)
{
    char part[PATH_SIZE];
    const size_t length = strlen(path);

    for (size_t i = 1; i <= length; i++) {
        if (path[i] != '/' && path[i] != '\0')
            continue;
        snprintf(part, sizeof part, "%.*s", (int)i, path);
        if (mkdir(part, 0777) && errno != EEXIST)
            return fault_set(f, EXIT_DATA, "%s: %s", part, strerror(errno));
    }
    return 1;
}

static int golden_open(void *state, const sink_setup *setup, fault *f)
{
    golden_state *s = state;

    s->setup = setup;
    if (strlen(setup->golden) >= PATH_SIZE - 64 || (setup->output && strlen(setup->output) >= PATH_SIZE - 64))
        return fault_set(f, EXIT_USAGE, "the name of the folder is too long");
    if (setup->output)
        snprintf(s->left, sizeof s->left, "%s", setup->output);
    else
        name_left(s);
    return setup->update ? make_folders(setup->golden, f) : 1;
}

static int update(golden_state *s, const shown_frame *shown, fault *f)
{
    char path[PATH_SIZE];

    if (!name_picture(path, s->setup->golden, shown->number, "", f) ||
        !picture_write(shown->picture, path, LEVEL_KEEP, f))
        return 0;
    s->result.updated++;
    return 1;
}

static int leave(const golden_state *s, const shown_frame *shown, const image *diff, fault *f)
{
    char got[PATH_SIZE], differs[PATH_SIZE];

    return make_folders(s->left, f) && name_picture(got, s->left, shown->number, ".got", f) &&
           name_picture(differs, s->left, shown->number, ".diff", f) &&
           picture_write(shown->picture, got, LEVEL_KEEP, f) &&
           (!diff->rgba || picture_write(diff, differs, LEVEL_KEEP, f));
}

/* A golden picture that is missing, damaged or of another size differs as much as can be. */
static int compare(const golden_state *s, const shown_frame *shown, const char *path, image *diff, int *worst)
{
    image golden = { 0 };
    image_difference d;

    *worst = 255;
    fap_err err = image_read_png(&golden, path);
    if (!err)
        err = image_compare(&golden, shown->picture, s->setup->tolerance, &d, diff);
    image_free(&golden);
    if (err)
        return 0;
    *worst = d.worst;
    return image_same(&d);
}

static int golden_show(void *state, const shown_frame *shown, fault *f)
{
    golden_state *s = state;
    char path[PATH_SIZE];
    image diff = { 0 };
    int worst;

    if (s->setup->update)
        return update(s, shown, f);
    if (!name_picture(path, s->setup->golden, shown->number, "", f))
        return 0;
    const int same = compare(s, shown, path, &diff, &worst);
    const int ok = same || leave(s, shown, &diff, f);
    image_free(&diff);
    s->result.same += same;
    s->result.different += !same;
    if (worst > s->result.worst)
        s->result.worst = worst;
    return ok;
}

static int golden_finish(void *state, sink_result *result, fault *f)
{
    golden_state *s = state;

    *result = s->result;
    if (!s->result.different)
        return 1;
    return fault_set(f, EXIT_DATA,
                     "%s: %" PRId64 " of %" PRId64
                     " pictures differ or are missing (by up to %d of 255); see %s; "
                     "--update accepts them",
                     s->setup->golden, s->result.different, s->setup->count, s->result.worst, s->left);
}

static void golden_close(void *state)
{
    (void)state;
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
