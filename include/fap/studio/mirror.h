/* SPDX-License-Identifier: BSD-2-Clause */
/** @file
 * Places in space from one camera and plane mirrors: where a mirror is, from points seen directly and in it; where a point is,
 * from its picture and its reflections. Source: I-C. Lin, J-S. Yeh, M. Ouhyoung 2001, section 4.1, eq. 4 to 15, which everything
 * here is named after. Camera coordinates: the lens is the origin, x to the right of the picture, y down, z into the scene.
 */
#ifndef FAP_STUDIO_MIRROR_H
#define FAP_STUDIO_MIRROR_H

#include <stddef.h>

#include <fap/api.h>
#include <fap/error.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A pinhole and its lens: pixel = f * bent(x / z) + c; bent() after D. C. Brown 1966, as OpenCV has it. */
typedef struct fap_camera {
    int width_px, height_px;
    double fx_px, fy_px, cx_px, cy_px;
    double k[5]; /**< k1, k2, p1, p2, k3 */
} fap_camera;

/** A camera nobody has measured: straight lines, square pixels, centred, @p view_deg across the picture's width. */
FAP_API void fap_camera_guess(fap_camera *cam, int width_px, int height_px, double view_deg);
/**
 * A camera from JSON: an object with fx, fy, cx, cy, width, height in pixels and k, up to five numbers; or what OpenCV's
 * calibration writes as "camera_matrix" and "distortion_coefficients". Names that are not known are passed over.
 * @param where  FAP_ERROR_TEXT_SIZE bytes: what is missing
 * @return FAP_OK; FAP_E_SYNTAX no JSON; FAP_E_DATA a number is missing or makes no sense
 */
FAP_API FAP_NODISCARD fap_err fap_camera_read(fap_camera *cam, const void *data, size_t size, char *where);
/** The same camera for pictures of another size. */
FAP_API void fap_camera_resize(fap_camera *cam, int width_px, int height_px);
/** x / z and y / z of what appears at a pixel. */
FAP_API void fap_camera_ray(const fap_camera *cam, const double pixel[2], double ray[2]);
/** @return 0: it is not before the camera. */
FAP_API int fap_camera_project(const fap_camera *cam, const double place[3], double pixel[2]);

/** The plane normal . x = distance; the normal is of length 1, its z negative: it looks back at the camera. */
typedef struct fap_mirror_plane {
    double normal[3];
    double distance; /**< negative, as the camera is on the side that the normal points to */
} fap_mirror_plane;

/** One point in two views. */
typedef struct fap_mirror_pair {
    double direct[2], mirrored[2]; /**< rays, see fap_camera_ray() */
} fap_mirror_pair;

/** What was found of a mirror. */
typedef struct fap_mirror_fit {
    int pairs, fitting; /**< given; and those that agree */
    double residual;    /**< RMS of those, as a ray's error: times f it is pixels */
    double
        sure; /**< the second smallest eigenvalue's root over the smallest's: the larger the better known */
} fap_mirror_fit;

/**
 * The direction of a mirror's normal from pairs: the eigenvector of M^T M with the smallest eigenvalue (eq. 9 to 11), with
 * each row weighted by how well it can be known, and wrong pairs left out. Its distance is set to -1: sizes are unknown until
 * something of known size is measured, see fap_mirror_scale().
 * @param count     at least 2; the more they are spread over the picture, the better
 * @param tolerance what a right pair may be off, as a ray's error: 2 pixels / f
 * @param where     FAP_ERROR_TEXT_SIZE bytes, may be NULL
 * @return FAP_OK; FAP_E_DATA the pairs do not determine a mirror
 */
FAP_API FAP_NODISCARD fap_err fap_mirror_find(fap_mirror_plane *mirror, const fap_mirror_pair *pair,
                                              int count, double tolerance, fap_mirror_fit *fit, char *where);
/** Behind the mirror what is before it, and back: x - 2 (n . x - d) n. */
FAP_API void fap_mirror_reflect(const fap_mirror_plane *mirror, const double place[3], double image[3]);
/**
 * Depths along both rays by least squares, and the mean of the direct point and the re-mirrored virtual one (eq. 12 to 15).
 * @return 0: the rays do not meet before the camera and the mirror
 */
FAP_API int fap_mirror_place(const fap_mirror_plane *mirror, const fap_mirror_pair *pair, double place[3]);

#define FAP_MIRROR_MAX 2

/** One point of one frame in all views. */
typedef struct fap_mirror_views {
    double ray[1 + FAP_MIRROR_MAX][2]; /**< direct, then in each mirror */
    unsigned char seen[1 + FAP_MIRROR_MAX];
} fap_mirror_views;

/**
 * The place whose pictures are nearest to all that were seen, in rays; one, two or more views of it.
 * @param residual  may be NULL: RMS of the rays' errors
 * @return 0: fewer than two views, or they do not meet
 */
FAP_API int fap_mirror_locate(const fap_mirror_plane *mirror, int mirrors, const fap_mirror_views *v,
                              double place[3], double *residual);
/**
 * The distance of the second mirror against the first, from points that are seen directly and in both.
 * @return how many points that was; 0: the distance stays
 */
FAP_API int fap_mirror_join(fap_mirror_plane mirror[FAP_MIRROR_MAX], const fap_mirror_views *v, int count);
/** All sizes times @p factor: known length over found length. */
FAP_API void fap_mirror_scale(fap_mirror_plane *mirror, int mirrors, double factor);
/**
 * All mirrors together, so that the pictures of all points fit best: directions, and the distance of the second against the
 * first, which stays what it is. Wrong pairs weigh little. Of many points some 2000 are looked at.
 * @param tolerance  as above
 * @return RMS of the rays' errors
 */
FAP_API double fap_mirror_refine(fap_mirror_plane *mirror, int mirrors, const fap_mirror_views *v, int count,
                                 double tolerance);

#ifdef __cplusplus
}
#endif
#endif
