/* SPDX-License-Identifier: BSD-2-Clause */
/* See picture.h. */
#include <math.h>
#include <stdlib.h>

#include "take/picture.h"

/* Landmarks of MediaPipe's face mesh that hardly move with the skin. */
enum {
    FOREHEAD = 10,
    BELOW_NOSE = 2,
    EYE_RIGHT = 33,
    EYE_LEFT = 263,
    POINTS = 468,
    POINTS_WITH_PUPILS = 478
};

/* Forehead to below the nose, in distances of the outer corners of the eyes: 1.10 and 1.18 are the medians of two people
 * in front of two cameras. */
static const double face_height = 1.14;

/* Height by width. Neighbours differ by a quarter and more, faces by a tenth. */
static const struct shape {
    double ratio;
    const char *name;
} shapes[] = { { 9. / 16, "16:9" }, { 3. / 4, "4:3" }, { 1, "1:1" }, { 4. / 3, "3:4" }, { 16. / 9, "9:16" } };

enum { SHAPES = sizeof shapes / sizeof *shapes };

int picture_is_fractions(const fap_take *take)
{
    static const float outside = 4; /* a face may reach over the picture's edge, but not far */

    if (take->point_count != POINTS && take->point_count != POINTS_WITH_PUPILS)
        return 0;
    for (uint32_t f = 0; f < take->frame_count; f++)
        for (uint32_t p = 0; p < take->point_count; p++) {
            const float *v = fap_take_sample(take, f, p);
            if (v && (fabsf(v[0]) > outside || fabsf(v[1]) > outside))
                return 0;
        }
    return 1;
}

/* Between two landmarks when the picture has this shape; -1: one is missing. */
static double distance(const fap_take *take, uint32_t frame, uint32_t a, uint32_t b, double height_per_width)
{
    const float *p = fap_take_sample(take, frame, a), *q = fap_take_sample(take, frame, b);

    if (!p || !q)
        return -1;
    return sqrt(pow((double)(p[0] - q[0]), 2) + pow((double)(p[1] - q[1]) * height_per_width, 2) +
                pow((double)(p[2] - q[2]), 2));
}

/* How far a frame's face is from a face's proportions, as a ratio of 1 and more; 0: it cannot be measured. */
static double strangeness(const fap_take *take, uint32_t frame, double height_per_width)
{
    const double height = distance(take, frame, FOREHEAD, BELOW_NOSE, height_per_width);
    const double width = distance(take, frame, EYE_RIGHT, EYE_LEFT, height_per_width);

    return height > 0 && width > 0 ? exp(fabs(log(height / width / face_height))) : 0;
}

/* The shape that most frames find best; NULL where no frame says anything. */
static const struct shape *likely_shape(const fap_take *take)
{
    uint32_t votes[SHAPES] = { 0 };
    int winner = 0;

    for (uint32_t f = 0; f < take->frame_count; f++) {
        int best = 0;
        for (int s = 1; s < SHAPES; s++)
            if (strangeness(take, f, shapes[s].ratio) < strangeness(take, f, shapes[best].ratio))
                best = s;
        votes[best] += strangeness(take, f, shapes[best].ratio) > 0;
    }
    for (int s = 1; s < SHAPES; s++)
        if (votes[s] > votes[winner])
            winner = s;
    return votes[winner] ? &shapes[winner] : NULL;
}

static void scale_heights(fap_take *take, double factor)
{
    const size_t samples = (size_t)take->frame_count * take->point_count;

    for (size_t i = 0; i < samples; i++)
        take->xyz[i][1] = (float)(take->xyz[i][1] * factor);
}

void picture_settle(fap_take *take, double height_per_width)
{
    static const double flattest = 0.05, tallest = 20;
    const int known = height_per_width > flattest && height_per_width < tallest;
    const struct shape *shape = known ? NULL : likely_shape(take);

    if (shape)
        take_note(take, "the picture's size is not in the file; as %s the face has a face's proportions",
                  shape->name);
    scale_heights(take, known ? height_per_width : shape ? shape->ratio : 1);
    take->mm_per_unit = -1;
}
