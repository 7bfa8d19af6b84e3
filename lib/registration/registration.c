/* SPDX-License-Identifier: BSD-2-Clause */
/* Before and after the methods: both faces in one frame, size and axes, and what came out in figures. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/mem.h"
#include "registration/cylinder.h"
#include "registration/laying.h"
#include "registration/measure.h"
#include "surface/normals.h"

struct fap_registration {
    fap_registration_report report;
    fap_surface *surface;
    uint8_t *front;
    rigid_pose pose;
    double scale, size; /* scan to generic; generic to the person */
    fap_allocator alloc;
};

/* Lengths that scanners write: millimetres, centimetres, inches, decimetres, metres. */
static const double units_mm[] = { 1, 10, 25.4, 100, 1000 };
/* Heads differ by less than this from the generic one. */
static const double head_differs = 1.25;
/* A pin this many times as far off as the middle one is contradicted by the others; heads differ by some millimetres anyway. */
static const double far_off = 6, heads_differ_mm = 2.5;

enum { ALIGN_ROUNDS = 8, NORMAL_ROUNDS = 3 };

static const char *const names[FAP_REGISTER_COUNT] = { "auto", "zhu", "yano", "lorenzo" };
static const char *const optimizers[FAP_OPTIMIZER_COUNT] = { "lbfgs", "simplex" };

const char *fap_registration_name(int method)
{
    return method >= 0 && method < FAP_REGISTER_COUNT ? names[method] : NULL;
}

const char *fap_optimizer_name(int optimizer)
{
    return optimizer >= 0 && optimizer < FAP_OPTIMIZER_COUNT ? optimizers[optimizer] : NULL;
}

void fap_registration_config_init(fap_registration_config *cfg)
{
    *cfg = (fap_registration_config){
        .struct_size = sizeof *cfg, .pin_error_mm = 1, .reach_mm = 12, .limit_mm = 15, .control_points = 400
    };
}

/* --- for the methods --- */

void laying_pin_place(const laid_pin *pin, const float (*at)[3], double place[3])
{
    for (int a = 0; a < 3; a++)
        place[a] = pin->share[0] * (double)at[pin->vertex[0]][a] +
                   pin->share[1] * (double)at[pin->vertex[1]][a] +
                   pin->share[2] * (double)at[pin->vertex[2]][a];
}

fap_err laying_progress(const laying *l, double done)
{
    return l->cfg->progress && l->cfg->progress(l->cfg->user, done) ? FAP_E_END : FAP_OK;
}

void laying_note(const laying *l, const char *fmt, ...)
{
    fap_registration_report *r = l->report;
    va_list args;

    if (r->note_count == FAP_SURFACE_MAX_NOTES)
        return;
    va_start(args, fmt);
    vsnprintf(r->note[r->note_count++], FAP_SURFACE_NOTE_SIZE, fmt, args);
    va_end(args);
}

fap_err laying_fail(const laying *l, fap_err err, const char *text)
{
    snprintf(l->where, FAP_ERROR_TEXT_SIZE, "%s", text);
    return err;
}

/* The shape at rest and the one laid so far are made finer alike. */
fap_err laying_subdivide(laying *l, int flat)
{
    const fap_generic *g = l->generic;
    loop_mesh rest, at;
    fap_err (*const divide)(loop_mesh *, const float(*)[3], uint32_t, const uint32_t(*)[3], uint32_t,
                            const uint8_t *, const uint8_t *, const fap_allocator *) =
        flat ? loop_split : loop_subdivide;

    fap_err err = divide(&rest, g->position, g->vertex_count, g->triangle, g->triangle_count, g->part,
                         g->mask, l->alloc);
    if (err == FAP_OK)
        err = divide(&at, (const float(*)[3])l->at, g->vertex_count, g->triangle, g->triangle_count, NULL,
                     NULL, l->alloc);
    if (err != FAP_OK) {
        loop_free(&rest, l->alloc);
        return err;
    }
    loop_free(&l->rest, l->alloc);
    l->rest = rest;
    l->fine_generic = (fap_generic){ rest.vertex_count,
                                     rest.triangle_count,
                                     (const float(*)[3])rest.position,
                                     (const uint32_t(*)[3])rest.triangle,
                                     rest.part,
                                     rest.mask };
    l->generic = &l->fine_generic;
    fap_mem_free(l->alloc, l->at);
    l->at = at.position;
    at.position = NULL;
    loop_free(&at, l->alloc);
    fap_mem_free(l->alloc, l->normal);
    l->normal = fap_mem_calloc(l->alloc, rest.vertex_count, sizeof *l->normal);
    surface_edges_free(&l->edges, l->alloc);
    err = surface_edges_find(&l->edges, l->generic->triangle, l->generic->triangle_count,
                             l->generic->vertex_count, l->alloc);
    return l->normal ? err : FAP_E_NOMEM;
}

/* --- the pins say where the head is --- */

static fap_err take_pins(laying *l, const fap_pin *pin)
{
    l->pin = fap_mem_calloc(l->alloc, l->pin_count, sizeof *l->pin);
    if (!l->pin)
        return FAP_E_NOMEM;
    for (uint32_t i = 0; i < l->pin_count; i++) {
        laid_pin *p = &l->pin[i];
        p->weight = fmax(0, fmin(1, (double)pin[i].trust));
        for (int k = 0; k < 3; k++) {
            p->vertex[k] = pin[i].vertex[k];
            p->share[k] = (double)pin[i].share[k];
            p->at[k] = (double)pin[i].at[k];
            if (p->vertex[k] >= l->generic->vertex_count || !isfinite(p->share[k]) || !isfinite(p->at[k]))
                return laying_fail(l, FAP_E_ARG,
                                   "a landmark names no vertex of the generic face, or no place");
        }
    }
    return FAP_OK;
}

typedef struct paired {
    double (*face)[3], (*scan)[3], *weight, *off;
    uint32_t count;
} paired;

static fap_err pair_up(const laying *l, paired *p)
{
    const uint32_t n = l->pin_count;

    *p = (paired){ .face = fap_mem_calloc(l->alloc, n, sizeof *p->face),
                   .scan = fap_mem_calloc(l->alloc, n, sizeof *p->scan),
                   .weight = fap_mem_calloc(l->alloc, n, sizeof *p->weight),
                   .off = fap_mem_calloc(l->alloc, 2 * (size_t)n, sizeof *p->off),
                   .count = n };
    for (uint32_t i = 0; p->face && p->scan && p->weight && i < n; i++) {
        laying_pin_place(&l->pin[i], l->generic->position, p->face[i]);
        memcpy(p->scan[i], l->pin[i].at, sizeof p->scan[i]);
        p->weight[i] = l->pin[i].weight;
    }
    return p->face && p->scan && p->weight && p->off ? FAP_OK : FAP_E_NOMEM;
}

static void unpair(const laying *l, paired *p)
{
    fap_mem_free(l->alloc, p->face);
    fap_mem_free(l->alloc, p->scan);
    fap_mem_free(l->alloc, p->weight);
    fap_mem_free(l->alloc, p->off);
}

/* Root of the mean square distance from the centre. */
static double spread(const double (*p)[3], const double *weight, uint32_t n)
{
    double centre[3] = { 0, 0, 0 }, sum = 0, total = 0;

    for (uint32_t i = 0; i < n; i++) {
        total += weight[i];
        for (int a = 0; a < 3; a++)
            centre[a] += weight[i] * p[i][a];
    }
    for (uint32_t i = 0; i < n; i++)
        for (int a = 0; a < 3; a++)
            sum += weight[i] * pow(p[i][a] - centre[a] / total, 2);
    return total > 0 ? sqrt(sum / total) : 0;
}

/* Scale and pose by the present weights; 0: the pins are no triangle. */
static int align_once(laying *l, const paired *p)
{
    for (uint32_t i = 0; i < p->count; i++)
        memcpy(p->scan[i], l->pin[i].at, sizeof p->scan[i]);
    const double a = spread((const double(*)[3])p->face, p->weight, p->count);
    const double b = spread((const double(*)[3])p->scan, p->weight, p->count);

    if (!(b > 0) || !(a > 0))
        return 0;
    l->scale = a / b;
    for (uint32_t i = 0; i < p->count; i++)
        for (int k = 0; k < 3; k++)
            p->scan[i][k] *= l->scale;
    return rigid_fit((const double(*)[3])p->scan, (const double(*)[3])p->face, p->weight, p->count, &l->pose);
}

static double middle_of(double *value, uint32_t n)
{
    for (uint32_t i = 1; i < n; i++)
        for (uint32_t k = i; k && value[k - 1] > value[k]; k--) {
            const double kept = value[k];
            value[k] = value[k - 1];
            value[k - 1] = kept;
        }
    return n ? value[n / 2] : 0;
}

/* Those that are far off count less and less; with few pins none can be told from the others. */
static void weigh(const laying *l, paired *p)
{
    double *sorted = p->off + p->count;

    for (uint32_t i = 0; i < p->count; i++) {
        double there[3], sum = 0;
        rigid_apply(&l->pose, p->scan[i], there);
        for (int a = 0; a < 3; a++)
            sum += pow(there[a] - p->face[i][a], 2);
        p->off[i] = sqrt(sum);
    }
    memcpy(sorted, p->off, p->count * sizeof *sorted);
    const double middle = fmax(middle_of(sorted, p->count), fmax(heads_differ_mm, l->cfg->pin_error_mm));
    for (uint32_t i = 0; i < p->count; i++) {
        const double far = p->off[i] / (far_off * middle);
        p->weight[i] = l->pin[i].weight * (p->count < 6 ? 1 : far < 1 ? pow(1 - far * far, 2) : 0);
    }
}

/* Where the caller has done it, the pins only say what they say. */
static fap_err keep_place(laying *l)
{
    l->pose = (rigid_pose){ .r = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } };
    l->scale = 1;
    return FAP_OK;
}

static fap_err align(laying *l)
{
    paired p;
    fap_err err = pair_up(l, &p);

    for (int round = 0; err == FAP_OK && round < ALIGN_ROUNDS; round++) {
        if (!align_once(l, &p))
            err = laying_fail(l, FAP_E_DATA, "the landmarks are all on one line, or in one place");
        else
            weigh(l, &p);
    }
    for (uint32_t i = 0; err == FAP_OK && i < l->pin_count; i++) {
        double there[3];
        rigid_apply(&l->pose, p.scan[i], there);
        memcpy(l->pin[i].at, there, sizeof there);
        l->report->pins_out += p.weight[i] <= 0 && l->pin[i].weight > 0;
        if (p.weight[i] <= 0)
            l->pin[i].weight = 0;
    }
    unpair(l, &p);
    return err;
}

/* --- both in one frame --- */

/* A scanner's noise makes fine triangles face anywhere: what lies around says better which way the surface looks. */
static int smooth_normals(laying *l)
{
    float(*sum)[3] = fap_mem_calloc(l->alloc, l->scan_vertices, sizeof *sum);

    for (int round = 0; sum && round < NORMAL_ROUNDS; round++) {
        memset(sum, 0, l->scan_vertices * sizeof *sum);
        for (uint32_t t = 0; t < l->scan_triangles; t++)
            for (int c = 0; c < 3; c++)
                for (int k = 0; k < 9; k++)
                    sum[l->scan_triangle[t][c]][k % 3] += l->scan_normal[l->scan_triangle[t][k / 3]][k % 3];
        for (uint32_t i = 0; i < l->scan_vertices; i++) {
            const float length = sqrtf(sum[i][0] * sum[i][0] + sum[i][1] * sum[i][1] + sum[i][2] * sum[i][2]);
            for (int a = 0; length > 0 && a < 3; a++)
                l->scan_normal[i][a] = sum[i][a] / length;
        }
    }
    fap_mem_free(l->alloc, sum);
    return sum != NULL;
}

static fap_err bring_scan(laying *l, const fap_surface *scan)
{
    l->surface = scan;
    l->scan_vertices = scan->vertex_count;
    l->scan_triangles = scan->triangle_count;
    l->scan_triangle = (const uint32_t(*)[3])scan->triangle;
    l->scan = fap_mem_calloc(l->alloc, l->scan_vertices, sizeof *l->scan);
    l->scan_normal = fap_mem_calloc(l->alloc, l->scan_vertices, sizeof *l->scan_normal);
    l->scan_border = fap_mem_calloc(l->alloc, l->scan_vertices, 1);
    if (!l->scan || !l->scan_normal || !l->scan_border)
        return FAP_E_NOMEM;
    for (uint32_t i = 0; i < l->scan_vertices; i++) {
        double from[3], there[3];
        for (int a = 0; a < 3; a++)
            from[a] = (double)scan->position[i][a] * l->scale;
        rigid_apply(&l->pose, from, there);
        for (int a = 0; a < 3; a++)
            l->scan[i][a] = (float)there[a];
    }
    surface_normals((const float(*)[3])l->scan, l->scan_vertices, l->scan_triangle, l->scan_triangles,
                    l->scan_normal);
    if (!smooth_normals(l))
        return FAP_E_NOMEM;
    return surface_index_open(&l->index, (const float(*)[3])l->scan, l->scan_vertices, l->scan_triangle,
                              l->scan_triangles);
}

static fap_err find_borders(laying *l)
{
    surface_edges e;
    const fap_err err =
        surface_edges_find(&e, l->scan_triangle, l->scan_triangles, l->scan_vertices, l->alloc);

    for (uint32_t i = 0; err == FAP_OK && i < e.count; i++)
        if (e.edge[i].triangles == 1)
            l->scan_border[e.edge[i].low] = l->scan_border[e.edge[i].high] = 1;
    if (err == FAP_OK)
        surface_edges_free(&e, l->alloc);
    return err;
}

static fap_err bring_generic(laying *l)
{
    const fap_generic *g = l->generic;

    l->at = fap_mem_calloc(l->alloc, g->vertex_count, sizeof *l->at);
    l->normal = fap_mem_calloc(l->alloc, g->vertex_count, sizeof *l->normal);
    if (!l->at || !l->normal)
        return FAP_E_NOMEM;
    memcpy(l->at, g->position, g->vertex_count * sizeof *l->at);
    return surface_edges_find(&l->edges, g->triangle, g->triangle_count, g->vertex_count, l->alloc);
}

static fap_err check_generic(const laying *l)
{
    const fap_generic *g = l->generic;

    if (!g->vertex_count || !g->triangle_count)
        return laying_fail(l, FAP_E_ARG, "the generic face has no triangle");
    for (uint32_t t = 0; t < g->triangle_count; t++)
        for (int c = 0; c < 3; c++)
            if (g->triangle[t][c] >= g->vertex_count)
                return laying_fail(l, FAP_E_ARG, "the generic face has a triangle without a vertex");
    return FAP_OK;
}

static fap_err prepare(laying *l, const fap_surface *scan, const fap_pin *pin)
{
    if (l->pin_count < 3)
        return laying_fail(l, FAP_E_ARG, "at least three landmarks are needed to tell where the face is");
    fap_err err = check_generic(l);
    if (err == FAP_OK)
        err = take_pins(l, pin);
    if (err == FAP_OK)
        err = l->cfg->in_place ? keep_place(l) : align(l);
    if (err == FAP_OK)
        err = bring_scan(l, scan);
    if (err == FAP_E_UNSUPPORTED)
        return laying_fail(l, err, "built without Embree (libembree-dev), which finds where a scan is near");
    if (err == FAP_OK)
        err = find_borders(l);
    return err == FAP_OK ? bring_generic(l) : err;
}

static void tidy(laying *l)
{
    surface_index_close(&l->index);
    surface_edges_free(&l->edges, l->alloc);
    fap_mem_free(l->alloc, l->scan);
    fap_mem_free(l->alloc, l->scan_normal);
    fap_mem_free(l->alloc, l->scan_border);
    fap_mem_free(l->alloc, l->pin);
    fap_mem_free(l->alloc, l->at);
    fap_mem_free(l->alloc, l->normal);
    loop_free(&l->rest, l->alloc);
}

/* --- the person's size --- */

/* Which unit makes this head most like the generic one in size; 0: none is near enough. */
static double guess_unit(double scale)
{
    double best = 0, off = log(head_differs);

    for (size_t i = 0; i < sizeof units_mm / sizeof *units_mm; i++)
        if (fabs(log(units_mm[i] / scale)) < off) {
            off = fabs(log(units_mm[i] / scale));
            best = units_mm[i];
        }
    return best;
}

static void settle_size(const laying *l, fap_registration *r)
{
    const double unit = l->cfg->in_place          ? 1
                        : l->cfg->mm_per_unit > 0 ? l->cfg->mm_per_unit
                                                  : guess_unit(l->scale);

    r->report.unit_known = unit > 0;
    r->size = unit > 0 ? unit / l->scale : 1;
    r->report.mm_per_unit = unit > 0 ? unit : l->scale;
    r->report.scale = r->size;
    r->report.surface_rms_mm *= r->size;
    r->report.surface_max_mm *= r->size;
    r->report.pin_rms_mm *= r->size;
    r->pose = l->pose;
    r->scale = l->scale;
    const double trace = l->pose.r[0][0] + l->pose.r[1][1] + l->pose.r[2][2];
    r->report.turned_deg = acos(fmax(-1, fmin(1, (trace - 1) / 2))) * 57.29577951308232;
    for (uint32_t i = 0; i < l->generic->vertex_count; i++)
        for (int a = 0; a < 3; a++)
            r->surface->position[i][a] = (float)((double)l->at[i][a] * r->size);
}

void fap_registration_to_head(const fap_registration *r, const float scan[3], float head_mm[3])
{
    double from[3], there[3];

    for (int a = 0; a < 3; a++)
        from[a] = (double)scan[a] * r->scale;
    rigid_apply(&r->pose, from, there);
    for (int a = 0; a < 3; a++)
        head_mm[a] = (float)(there[a] * r->size);
}

/* --- the whole --- */

static fap_err make_surface(const laying *l, fap_registration *r)
{
    const fap_generic *g = l->generic;
    const fap_err err = fap_surface_create(&r->surface, g->vertex_count, g->triangle_count, l->alloc);

    if (err != FAP_OK)
        return err;
    memcpy(r->surface->triangle, g->triangle, g->triangle_count * sizeof *g->triangle);
    r->front = fap_mem_calloc(l->alloc, g->vertex_count, 1);
    const cylinder axis = cylinder_around(g->position, g->vertex_count);
    for (uint32_t i = 0; r->front && i < g->vertex_count; i++)
        r->front[i] = (uint8_t)(laying_is_skin(l, i) && cylinder_is_face(&axis, g->position[i]));
    return r->front ? FAP_OK : FAP_E_NOMEM;
}

static fap_err run(laying *l)
{
    switch (l->cfg->method) {
    case FAP_REGISTER_AUTO: return laying_auto(l);
    case FAP_REGISTER_ZHU: return laying_zhu(l);
    case FAP_REGISTER_YANO: return laying_yano(l);
    case FAP_REGISTER_LORENZO: return laying_lorenzo(l);
    default: return laying_fail(l, FAP_E_ARG, "no such method");
    }
}

fap_err fap_register(fap_registration **out, const fap_generic *generic, const fap_surface *scan,
                     const fap_pin *pin, uint32_t pin_count, const fap_registration_config *cfg, char *where)
{
    fap_registration_config defaults;
    char own[FAP_ERROR_TEXT_SIZE];

    *out = NULL;
    fap_registration_config_init(&defaults);
    if (!cfg)
        cfg = &defaults;
    const fap_allocator alloc = fap_mem_allocator(&cfg->alloc);
    fap_registration *r = fap_mem_calloc(&alloc, 1, sizeof *r);
    if (!r)
        return FAP_E_NOMEM;
    r->alloc = alloc;
    r->report.pins = pin_count;
    laying l = { .generic = generic,
                 .cfg = cfg,
                 .alloc = &alloc,
                 .report = &r->report,
                 .where = where ? where : own,
                 .pin_count = pin_count };
    *l.where = '\0';
    fap_err err = prepare(&l, scan, pin);
    if (err == FAP_OK)
        err = run(&l);
    if (err == FAP_OK)
        err = make_surface(&l, r);
    if (err == FAP_OK) {
        laying_measure(&l);
        settle_size(&l, r);
        *out = r;
    } else
        fap_registration_close(&r);
    tidy(&l);
    return err;
}

void fap_registration_close(fap_registration **r)
{
    if (!*r)
        return;
    const fap_allocator alloc = (*r)->alloc;
    fap_surface_close(&(*r)->surface);
    fap_mem_free(&alloc, (*r)->front);
    fap_mem_free(&alloc, *r);
    *r = NULL;
}

const float (*fap_registration_positions(const fap_registration *r))[3]
{
    return (const float(*)[3])r->surface->position;
}

const fap_registration_report *fap_registration_report_get(const fap_registration *r)
{
    return &r->report;
}

const uint8_t *fap_registration_front(const fap_registration *r)
{
    return r->front;
}

const fap_surface *fap_registration_surface(const fap_registration *r)
{
    return r->surface;
}
