/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Face landmarks as JSON, as scripts around MediaPipe and its kin in browsers write them; there is no standard. A file is a
 * list of frames, bare or under a key, or one object a line. A frame is a list of points, a list of faces of which the first
 * is taken, or an object that has one of both beside its time. A point is {"x":, "y":, "z":} or [x, y, z]. Blendshapes beside
 * the points are left alone. Source: the shapes of MediaPipe's results in Python and JavaScript.
 */
#include <stdio.h>
#include <string.h>

#include "take/clock.h"
#include "take/json_text.h"
#include "take/picture.h"

/* One pass over the file; without a take it only counts. */
typedef struct pass {
    fap_take *take;
    take_clock clock;
    uint32_t frames, points, faces_left_out, flat;
    double width, height;
} pass;

static int is_one_of(text t, const char *const *words)
{
    while (*words && !text_is(t, *words))
        words++;
    return *words != NULL;
}

static const char *const frame_lists[] = { "frames", "results", "data", "detections", "landmarks_per_frame",
                                           NULL };
static const char *const face_keys[] = { "landmarks",
                                         "faceLandmarks",
                                         "face_landmarks",
                                         "multiFaceLandmarks",
                                         "multi_face_landmarks",
                                         "landmark",
                                         "keypoints",
                                         "scaledMesh",
                                         "points",
                                         "faces",
                                         "face",
                                         NULL };
static const char *const width_keys[] = { "width",       "image_width", "imageWidth",
                                          "video_width", "videoWidth",  NULL };
static const char *const height_keys[] = { "height",       "image_height", "imageHeight",
                                           "video_height", "videoHeight",  NULL };
static const char *const rate_keys[] = { "fps", "frame_rate", "frameRate", "framerate", NULL };
static const char *const time_keys[] = { "timestamp", "time", "t", NULL };
static const char *const ms_keys[] = { "timestamp_ms", "timestampMs", "time_ms", "timeMs", NULL };
static const char *const second_keys[] = { "timestamp_s", "time_s", "seconds", NULL };
static const char *const number_keys[] = { "frame",       "frame_index", "frameIndex", "frame_number",
                                           "frameNumber", "frame_id",    "index",      NULL };
static const char *const us_keys[] = { "timestamp_us", "timestampUs", "time_us", NULL };

/* --- what comes next --- */

static int opens_with(json_text j, char bracket)
{
    return json_text_enter(&j, bracket);
}

static int is_number_next(json_text j)
{
    double v;
    return json_text_number(&j, &v);
}

/* A point is an object with an x, or a short list that begins with a number. */
static int is_point(json_text j)
{
    int first = 1;
    text key;

    if (json_text_enter(&j, '['))
        return is_number_next(j);
    if (!json_text_enter(&j, '{'))
        return 0;
    while (json_text_next(&j, '}', &first) && json_text_key(&j, &key)) {
        if (text_is(key, "x"))
            return 1;
        json_text_skip(&j);
    }
    return 0;
}

static int is_point_list(json_text j)
{
    return json_text_enter(&j, '[') && is_point(j);
}

/* --- a frame --- */

static int read_triple(json_text *j, double v[3])
{
    int known = 0, first = 1;
    double ignored;

    json_text_enter(j, '[');
    for (int axis = 0; json_text_next(j, ']', &first) && !j->bad; axis++)
        if (json_text_number(j, axis < 3 ? &v[axis] : &ignored) && axis < 3)
            known |= 1 << axis;
    return known;
}

static int read_named(json_text *j, double v[3])
{
    int known = 0, first = 1;
    text key;

    json_text_enter(j, '{');
    while (json_text_next(j, '}', &first) && json_text_key(j, &key)) {
        const int axis = key.length == 1 && *key.start >= 'x' && *key.start <= 'z' ? *key.start - 'x' : -1;
        if (axis < 0)
            json_text_skip(j);
        else if (json_text_number(j, &v[axis]))
            known |= 1 << axis;
    }
    return known;
}

/* A frame that breaks off is not counted, so there is no row for it. */
static int has_row(const pass *p)
{
    return p->take && p->frames < p->take->frame_count;
}

static void read_point(json_text *j, pass *p, uint32_t point)
{
    enum { XY = 3 };
    double v[3] = { 0 };
    int known = 0;

    if (opens_with(*j, '['))
        known = read_triple(j, v);
    else if (opens_with(*j, '{'))
        known = read_named(j, v);
    else
        json_text_skip(j);
    if (!has_row(p) || point >= p->take->point_count || (known & XY) != XY)
        return;
    p->flat += known == XY;
    fap_take_set(p->take, p->frames, point, (const float[3]){ (float)v[0], (float)v[1], (float)v[2] });
}

static void read_points(json_text *j, pass *p)
{
    uint32_t n = 0;
    int first = 1;

    json_text_enter(j, '[');
    for (; json_text_next(j, ']', &first) && !j->bad; n += n <= FAP_TAKE_MAX_POINTS)
        read_point(j, p, n);
    if (!j->bad && n > p->points)
        p->points = n;
}

/* A list of points; or faces, lists or objects that hold one. Bounded: a face in a face in a face is none. */
static void read_face(json_text *j, pass *p, int depth)
{
    enum { DEEPEST = 3 };
    int first = 1, faces = 0;
    text key;

    if (is_point_list(*j)) {
        read_points(j, p);
    } else if (depth < DEEPEST && json_text_enter(j, '[')) {
        for (; json_text_next(j, ']', &first) && !j->bad; faces++)
            if (faces)
                json_text_skip(j);
            else
                read_face(j, p, depth + 1);
        p->faces_left_out += faces > 1;
    } else if (depth < DEEPEST && json_text_enter(j, '{')) {
        while (json_text_next(j, '}', &first) && json_text_key(j, &key))
            if (is_one_of(key, face_keys))
                read_face(j, p, depth + 1);
            else
                json_text_skip(j);
    } else {
        json_text_skip(j);
    }
}

static void put_time(pass *p, double t)
{
    if (has_row(p))
        p->clock.time[p->frames] = t;
}

static void read_time(json_text *j, pass *p, double unit_s)
{
    double t;

    if (!json_text_number(j, &t))
        return;
    p->clock.unit_s = unit_s;
    p->clock.timed = 1;
    put_time(p, t);
}

/* A frame's number stands in for its time as long as there is none. */
static void read_number(json_text *j, pass *p)
{
    double number;

    if (json_text_number(j, &number) && !p->clock.timed)
        put_time(p, number);
}

/* A number that the file or its frames may give; 0: the key is another. */
static int read_fact(json_text *j, pass *p, text key)
{
    if (is_one_of(key, width_keys))
        json_text_number(j, &p->width);
    else if (is_one_of(key, height_keys))
        json_text_number(j, &p->height);
    else if (is_one_of(key, rate_keys))
        json_text_number(j, &p->clock.rate_hz);
    else
        return 0;
    return 1;
}

static int read_frame_time(json_text *j, pass *p, text key)
{
    if (is_one_of(key, ms_keys))
        read_time(j, p, 1e-3);
    else if (is_one_of(key, us_keys))
        read_time(j, p, 1e-6);
    else if (is_one_of(key, second_keys))
        read_time(j, p, 1);
    else if (is_one_of(key, time_keys))
        read_time(j, p, 0);
    else if (is_one_of(key, number_keys))
        read_number(j, p);
    else
        return 0;
    return 1;
}

static void read_frame_object(json_text *j, pass *p)
{
    int first = 1;
    text key;

    json_text_enter(j, '{');
    while (json_text_next(j, '}', &first) && json_text_key(j, &key)) {
        if (is_one_of(key, face_keys))
            read_face(j, p, 0);
        else if (!read_fact(j, p, key) && !read_frame_time(j, p, key))
            json_text_skip(j);
    }
}

static void read_frame(json_text *j, pass *p)
{
    if (opens_with(*j, '{'))
        read_frame_object(j, p);
    else
        read_face(j, p, 0);
    if (!j->bad && p->frames < FAP_TAKE_MAX_SAMPLES)
        p->frames++;
}

static void read_frames(json_text *j, pass *p)
{
    int first = 1;

    if (!json_text_enter(j, '[')) {
        json_text_skip(j);
        return;
    }
    while (json_text_next(j, ']', &first) && !j->bad)
        read_frame(j, p);
}

/* --- the file --- */

/* Whether an object holds frames, rather than being one: a list under a frames' key, or lists of points in a list longer
 * than a picture has faces. */
static int holds_frames(json_text j, text *where)
{
    enum { CROWD = 8 };
    int first = 1;

    json_text_enter(&j, '{');
    while (json_text_next(&j, '}', &first) && json_text_key(&j, where)) {
        const int list = opens_with(j, '[');
        if (list && is_one_of(*where, frame_lists))
            return 1;
        if (!list || is_point_list(j) || !is_one_of(*where, face_keys)) {
            json_text_skip(&j);
            continue;
        }
        int count = 0, inner = 1;
        json_text_enter(&j, '[');
        for (; json_text_next(&j, ']', &inner) && !j.bad; count++)
            json_text_skip(&j);
        if (count > CROWD)
            return 1;
    }
    return 0;
}

static int same_text(text a, text b)
{
    return a.length == b.length && !memcmp(a.start, b.start, a.length);
}

static void read_frames_object(json_text *j, pass *p, text frames)
{
    int first = 1;
    text key;

    json_text_enter(j, '{');
    while (json_text_next(j, '}', &first) && json_text_key(j, &key)) {
        if (same_text(key, frames) && !p->frames)
            read_frames(j, p);
        else if (!read_fact(j, p, key))
            json_text_skip(j);
    }
}

/* A list, an object of frames, or frames one behind the other (JSON lines). */
static json_text read_file(json_text j, pass *p)
{
    text frames;

    if (opens_with(j, '[')) {
        if (is_point_list(j))
            read_frame(&j, p);
        else
            read_frames(&j, p);
        while (opens_with(j, '[') && !j.bad) /* JSON lines of lists */
            read_frame(&j, p);
        return j;
    }
    if (holds_frames(j, &frames))
        read_frames_object(&j, p, frames);
    else
        while (opens_with(j, '{') && !j.bad)
            read_frame(&j, p);
    return j;
}

static int landmarks_claim(const uint8_t *data, size_t size)
{
    static const char *const words[] = { "andmark\"",  "andmarks\"",   "\"x\"",
                                         "eypoints\"", "scaledMesh\"", "[[[" };
    enum { REACH = 1 << 16 };
    const json_text j = json_text_open(data, size);
    const size_t reach = (size_t)(j.end - j.at) < REACH ? (size_t)(j.end - j.at) : REACH;

    if (!opens_with(j, '[') && !opens_with(j, '{'))
        return 0;
    for (size_t w = 0; w < sizeof words / sizeof *words; w++) {
        const size_t length = strlen(words[w]);
        for (size_t i = 0; i + length <= reach; i++)
            if (!memcmp(j.at + i, words[w], length))
                return 40;
    }
    return 0;
}

/* --- reading --- */

static void name_by_number(fap_take *take)
{
    for (uint32_t p = 0; p < take->point_count; p++) {
        char name[16];
        take_set_name(take, p, name, (size_t)snprintf(name, sizeof name, "%u", (unsigned)p));
    }
}

static void note_oddities(fap_take *take, const pass *p, int bad)
{
    if (bad)
        take_note(take, "the JSON breaks off or is damaged behind frame %u", (unsigned)p->frames);
    if (p->faces_left_out)
        take_note(take, "%u frames have more than one face; the first one is taken",
                  (unsigned)p->faces_left_out);
    if (p->flat)
        take_note(take, "%u points have no z; they are taken as flat", (unsigned)p->flat);
}

static fap_err fill_take(json_text j, pass *p, fap_take **take)
{
    j = read_file(j, p);
    name_by_number(*take);
    const fap_err err = take_clock_settle(&p->clock, take);
    if (err != FAP_OK)
        return err;
    note_oddities(*take, p, j.bad);
    (*take)->mm_per_unit = -1;
    if (picture_is_fractions(*take))
        picture_settle(*take, p->width > 0 ? p->height / p->width : 0);
    return FAP_OK;
}

static fap_err landmarks_read(take_source *src, fap_take **take)
{
    const json_text j = json_text_open(src->data, src->size);
    pass count = { 0 };

    read_file(j, &count);
    if (!count.points)
        return take_fail(
            src, FAP_E_NOT_FOUND,
            "JSON without landmarks: looked for frames with lists of {\"x\", \"y\", \"z\"} under "
            "landmarks, faceLandmarks, face_landmarks, keypoints ...; %u frames seen",
            (unsigned)count.frames);
    fap_err err = fap_take_create(take, count.points, count.frames, &src->alloc);
    if (err != FAP_OK)
        return take_fail(src, err, "JSON: no room for %u frames of %u points", (unsigned)count.frames,
                         (unsigned)count.points);
    pass fill = { .take = *take };
    err = take_clock_open(src, &fill.clock, count.frames) ? fill_take(j, &fill, take) : FAP_E_NOMEM;
    take_clock_close(src, &fill.clock);
    return err == FAP_OK ? err : take_fail(src, err, "JSON: no room for the frames that the times leave out");
}

const take_driver take_driver_landmarks = { "landmarks JSON", landmarks_claim, landmarks_read };
