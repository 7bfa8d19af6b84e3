/* SPDX-License-Identifier: BSD-2-Clause */
/** @file
 * Laying a generic face onto a scan, so that every vertex means the same place on every person: consistent parameterisation as
 * Zhu 2006 has it (chapter 4), and a joined method. Part of libfap-studio. docs/shape.md tells them apart.
 */
#ifndef FAP_STUDIO_REGISTRATION_H
#define FAP_STUDIO_REGISTRATION_H

#include <fap/bank.h>
#include <fap/studio/surface.h>

#ifdef __cplusplus
extern "C" {
#endif

/** The face whose structure a scan is to have. Millimetres, head axes; arrays are borrowed. */
typedef struct fap_generic {
    uint32_t vertex_count, triangle_count;
    const float (*position)[3];
    const uint32_t (*triangle)[3];
    const uint8_t *part; /**< [vertex_count], a ::fap_part each; NULL: all skin */
    const uint8_t *mask; /**< [vertex_count] of ::fap_mask bits; NULL: no slits */
} fap_generic;

/** One place, known on both: where on the generic face, where in the scan. */
typedef struct fap_pin {
    uint32_t vertex[3]; /**< of the generic face */
    float share[3];     /**< of each vertex; together 1 */
    float at[3];        /**< in the scan, its unit and axes */
    float trust;        /**< 1: as sure as a careful click; 0: not at all */
} fap_pin;

typedef enum fap_registration_method {
    FAP_REGISTER_AUTO,    /**< the joined method; the default */
    FAP_REGISTER_ZHU,     /**< RBF, subdivision, cylindrical or normal projection: as the thesis has it */
    FAP_REGISTER_YANO,    /**< a template in the plane of a range image, which is sampled */
    FAP_REGISTER_LORENZO, /**< planar bones moved until distance, strain and bending cost least */
    FAP_REGISTER_COUNT
} fap_registration_method;
/** "auto", "zhu", "yano", "lorenzo"; NULL for another number. Static. */
FAP_API const char *fap_registration_name(int method);

/** How the lorenzo method goes down. */
typedef enum fap_optimizer {
    FAP_OPTIMIZER_LBFGS,   /**< all control points at once, by gradients; the default */
    FAP_OPTIMIZER_SIMPLEX, /**< one control point after the other, by values alone: the downhill simplex */
    FAP_OPTIMIZER_COUNT
} fap_optimizer;
/** "lbfgs", "simplex"; NULL for another number. Static. */
FAP_API const char *fap_optimizer_name(int optimizer);

enum { FAP_CONTROL_POINTS_MIN = 12, FAP_CONTROL_POINTS_MAX = 4000 };

/** Start from fap_registration_config_init(). */
typedef struct fap_registration_config {
    size_t struct_size;
    fap_registration_method method;
    double
        mm_per_unit; /**< of the scan; 0: the metric unit that fits the generic face best, see the report */
    int in_place; /**< 1: the scan and its pins are in millimetres and the head's axes already; mm_per_unit is of no use */
    double pin_error_mm; /**< how far off a landmark with trust 1 may be, standard deviation; 1 */
    double reach_mm;     /**< skin farther than this from the laid face belongs to something else; 12 */
    int subdivisions; /**< zhu: steps of Loop's scheme, yano: one-to-four; 0 to 3; 0. fap_registration_surface() has the finer face */
    int along_normals;       /**< zhu, lorenzo: rays go along normals, not away from the head's axis; 0 */
    double limit_mm;         /**< zhu, lorenzo: a ray that meets nothing before is given up; 15 */
    fap_optimizer optimizer; /**< lorenzo; ::FAP_OPTIMIZER_LBFGS */
    int control_points; /**< lorenzo: of the net of bones, ::FAP_CONTROL_POINTS_MIN to ::FAP_CONTROL_POINTS_MAX; 400 */
    int (*progress)(void *user,
                    double done); /**< 0 to 1; non-zero ends the work with FAP_E_END. NULL: none */
    void *user;
    fap_allocator alloc;
} fap_registration_config;
FAP_API void fap_registration_config_init(fap_registration_config *cfg);

typedef struct fap_registration_report {
    double mm_per_unit;                    /**< that the scan's lengths were multiplied with */
    uint8_t unit_known;                    /**< 0: no metric unit fits; the face has the generic one's size */
    double scale;                          /**< size of this head over the generic face's */
    double turned_deg;                     /**< the scan's axes against the head's */
    uint32_t pins, pins_out;               /**< given; of these contradicted by the rest and left out */
    double pin_rms_mm;                     /**< of those used, after the fit */
    double surface_rms_mm, surface_max_mm; /**< skin to scan, where the scan is */
    uint32_t skin, seen;                   /**< vertices of the skin; of these above scanned surface */
    uint32_t folded;                       /**< triangles of the skin turned over against those around them */
    uint32_t note_count;
    char note[FAP_SURFACE_MAX_NOTES][FAP_SURFACE_NOTE_SIZE];
} fap_registration_report;

typedef struct fap_registration fap_registration;

/**
 * Lay @p generic onto @p scan. Neither is kept.
 * @param pin  at least 3, not on one line
 * @param cfg  NULL: defaults
 * @return FAP_OK; FAP_E_ARG too few pins, or one that names no vertex; FAP_E_DATA the pins fit no face, or the scan has no
 *         surface near them; FAP_E_UNSUPPORTED a build without Embree; FAP_E_END progress said so; FAP_E_LIMIT; FAP_E_NOMEM.
 *         @p *out is NULL on error and @p where (may be NULL, FAP_ERROR_TEXT_SIZE bytes) says what to do.
 */
FAP_API FAP_NODISCARD fap_err fap_register(fap_registration **out, const fap_generic *generic,
                                           const fap_surface *scan, const fap_pin *pin, uint32_t pin_count,
                                           const fap_registration_config *cfg, char *where);
/** Sets @p *r to NULL; accepts NULL. */
FAP_API void fap_registration_close(fap_registration **r);
/** Where each vertex of the generic face is on the scanned person: millimetres, head axes. [generic->vertex_count] */
FAP_API const float (*fap_registration_positions(const fap_registration *r))[3];
/** The face with its triangles; where it was subdivided, more than the generic one's, whose vertices are the first. */
FAP_API const fap_surface *fap_registration_surface(const fap_registration *r);
/**
 * [vertices of fap_registration_surface()] 1: skin of the face; 0: ears, top and back of the head, and what is inside (Zhu 2006
 * section 4.6). The same for every person that the generic face is laid onto.
 */
FAP_API const uint8_t *fap_registration_front(const fap_registration *r);
FAP_API const fap_registration_report *fap_registration_report_get(const fap_registration *r);
/** A place of the scan in the head's axes and millimetres. */
FAP_API void fap_registration_to_head(const fap_registration *r, const float scan[3], float head_mm[3]);

#ifdef __cplusplus
}
#endif
#endif
