/* SPDX-License-Identifier: BSD-2-Clause */
/* See occlusion.h. */
#ifdef HAVE_GL
#include <stdlib.h>
#include <string.h>

#include <cglm/cglm.h>

#include "player/render/gl_objects.h"
#include "player/render/lamps.h"
#include "player/render/occlusion.h"

enum { SIZE = 320, SKY_DIRECTIONS = 32, KEY_DIRECTIONS = 8, OPEN_SMOOTHINGS = 3, KEY_SMOOTHINGS = 4 };

/*
 * The face as it is measured: jaw and lips a little open, else the inside of the mouth and the rims of the
 * lips would count as night and stay black when they part.
 */
static void open_mouth(const fap_bank *bank, float *position)
{
    const fap_mesh *mesh = fap_bank_mesh(bank);
    const int k = fap_bank_key_find(bank, FAP_KEY_UNIT, "jawOpen");
    const fap_key *key = fap_bank_key_get(bank, k);
    const float weight = 0.55f;

    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        for (int a = 0; a < 3; a++)
            position[3 * i + (size_t)a] = mesh->position[(size_t)a * mesh->stride + i];
    for (uint32_t b = 0; key && b < key->block_count; b++)
        for (int a = 0; a < 3; a++)
            for (int lane = 0; lane < FAP_BLOCK; lane++) {
                const size_t v = (size_t)key->block[b] * FAP_BLOCK + (size_t)lane;
                const int16_t q = key->delta[((size_t)b * 3 + (size_t)a) * FAP_BLOCK + (size_t)lane];
                if (v < mesh->vertex_count)
                    position[3 * v + (size_t)a] += weight * key->scale_mm * q;
            }
}

/* Directions spread evenly over the sphere by the golden angle. */
static void sky_direction(int i, vec3 out)
{
    const float y = 1 - 2 * (i + 0.5f) / SKY_DIRECTIONS, r = sqrtf(1 - y * y), turn = 2.39996323f * i;
    out[0] = r * cosf(turn);
    out[1] = y;
    out[2] = r * sinf(turn);
}

/* Directions spread evenly over the key lamp. */
static void key_direction(int i, vec3 out)
{
    const float wide = 0.30f, r = wide * sqrtf((i + 0.5f) / KEY_DIRECTIONS), turn = 2.39996323f * i;
    vec3 middle = { KEY_FROM }, side, up;

    glm_vec3_normalize(middle);
    glm_vec3_crossn((vec3){ 0, 1, 0 }, middle, side);
    glm_vec3_cross(middle, side, up);
    glm_vec3_copy(middle, out);
    glm_vec3_muladds(side, r * cosf(turn), out);
    glm_vec3_muladds(up, r * sinf(turn), out);
    glm_vec3_normalize(out);
}

typedef struct cloud {
    float *position, *normal; /* x y z a vertex */
    uint32_t count;
    vec3 centre;
    float radius;
} cloud;

static void measure_bounds(cloud *c)
{
    vec3 low, high;

    glm_vec3_copy(c->position, low);
    glm_vec3_copy(c->position, high);
    for (uint32_t i = 0; i < c->count; i++) {
        glm_vec3_minv(low, c->position + 3 * i, low);
        glm_vec3_maxv(high, c->position + 3 * i, high);
    }
    glm_vec3_center(low, high, c->centre);
    c->radius = fmaxf(1, 0.5f * glm_vec3_distance(low, high));
}

static void measure_normals(cloud *c, const fap_mesh *mesh)
{
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *v = mesh->triangle + 3 * (size_t)t;
        vec3 a, b, n;
        glm_vec3_sub(c->position + 3 * v[1], c->position + 3 * v[0], a);
        glm_vec3_sub(c->position + 3 * v[2], c->position + 3 * v[0], b);
        glm_vec3_cross(a, b, n);
        for (int i = 0; i < 3; i++)
            glm_vec3_add(c->normal + 3 * v[i], n, c->normal + 3 * v[i]);
    }
    for (uint32_t i = 0; i < c->count; i++)
        glm_vec3_normalize(c->normal + 3 * i);
}

static void view_from(const cloud *c, vec3 from, mat4 out)
{
    const float r = c->radius;
    mat4 view, projection;
    vec3 eye, centre, up = { 0, fabsf(from[1]) < 0.95f, fabsf(from[1]) >= 0.95f };

    glm_vec3_copy((float *)c->centre, centre);
    glm_vec3_scale(from, 2 * r, eye);
    glm_vec3_add(eye, centre, eye);
    glm_lookat(eye, centre, up, view);
    glm_ortho(-r, r, -r, r, r, 3 * r, projection);
    glm_mat4_mul(projection, view, out);
}

/* What is added up: of all that a vertex faces, how much it sees. */
typedef struct sight {
    float *sum, *seen;
    float floor; /* brightness of the floor against the sky's: 1 where direction does not matter */
    float least; /* the least cosine that counts as facing */
    float trust; /* weight of being seen before anything was */
    int grazing; /* whether what faces little is known well enough to count in full */
} sight;

/* A vertex counts as seen when it lies at most a hair behind what the picture shows there. */
static void add_seen(const cloud *c, vec3 from, mat4 view, const float *depth, const sight *s)
{
    const float hair = 0.9f / (2 * c->radius); /* 0.9 mm in depth units, 0..1 over two radii */
    const float bright = 0.5f * (1 + s->floor) + 0.5f * (1 - s->floor) * from[1];

    for (uint32_t i = 0; i < c->count; i++) {
        const float facing = glm_vec3_dot(c->normal + 3 * i, from);
        if (facing <= s->least)
            continue;
        const float weight = facing * bright * (s->grazing ? 1 : facing);
        vec3 p;
        glm_mat4_mulv3(view, c->position + 3 * i, 1, p);
        const int x = (int)((p[0] * 0.5f + 0.5f) * SIZE), y = (int)((p[1] * 0.5f + 0.5f) * SIZE);
        s->sum[i] += weight;
        if (x < 0 || y < 0 || x >= SIZE || y >= SIZE || p[2] * 0.5f + 0.5f <= depth[y * SIZE + x] + hair)
            s->seen[i] += weight;
    }
}

static gl_target depth_target(const gl_functions *gl)
{
    gl_target t = { 0 };

    gl->GenFramebuffers(1, &t.frame);
    gl->BindFramebuffer(GL_FRAMEBUFFER, t.frame);
    gl->GenRenderbuffers(1, &t.depth);
    gl->BindRenderbuffer(GL_RENDERBUFFER, t.depth);
    gl->RenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT32F, SIZE, SIZE);
    gl->FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, t.depth);
    return t;
}

/* The array and target that the views are drawn with. */
typedef struct watch {
    const gl_functions *gl;
    const cloud *cloud;
    gl_target target;
    GLuint array, vertices;
    GLint uniform;
    uint32_t triangles;
    float *depth;
} watch;

static void watch_open(watch *w, GLuint index_buffer, GLuint program)
{
    const gl_functions *gl = w->gl;

    gl->GenVertexArrays(1, &w->array);
    gl->BindVertexArray(w->array);
    w->vertices = gl_buffer_make(gl, GL_ARRAY_BUFFER, w->cloud->position, w->cloud->count * 3 * sizeof(float),
                                 GL_STATIC_DRAW);
    gl->VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, NULL);
    gl->EnableVertexAttribArray(0);
    gl->BindBuffer(GL_ELEMENT_ARRAY_BUFFER, index_buffer);
    w->target = depth_target(gl);
    gl->Viewport(0, 0, SIZE, SIZE);
    gl->Enable(GL_DEPTH_TEST);
    gl->Enable(GL_CULL_FACE);
    gl->UseProgram(program);
    w->uniform = gl->GetUniformLocation(program, "view_projection");
}

static void watch_close(watch *w)
{
    gl_target_delete(w->gl, &w->target);
    w->gl->DeleteBuffers(1, &w->vertices);
    w->gl->DeleteVertexArrays(1, &w->array);
}

typedef struct look {
    vec3 from;
    mat4 view;
} look;

/* Queued, not waited for. */
static void begin_look(const watch *w, look *l)
{
    view_from(w->cloud, l->from, l->view);
    w->gl->UniformMatrix4fv(w->uniform, 1, GL_FALSE, l->view[0]);
    w->gl->Clear(GL_DEPTH_BUFFER_BIT);
    w->gl->DrawElements(GL_TRIANGLES, (GLsizei)(3 * w->triangles), GL_UNSIGNED_INT, NULL);
    w->gl->Flush();
}

/* One look is drawn while the one before is counted. */
static void look_from(const watch *w, void (*direction)(int i, vec3 out), int count, const sight *s)
{
    look now, before;

    for (int i = 0; i < count; i++) {
        direction(i, now.from);
        begin_look(w, &now);
        if (i)
            add_seen(w->cloud, before.from, before.view, w->depth, s);
        w->gl->ReadPixels(0, 0, SIZE, SIZE, GL_DEPTH_COMPONENT, GL_FLOAT, w->depth);
        before = now;
    }
    add_seen(w->cloud, before.from, before.view, w->depth, s);
}

/* Vertices at a grazing angle are seen or not by a hair; the mean with their neighbours hides that. */
static void smooth(const fap_mesh *mesh, float *open, float *sum, float *count)
{
    memset(sum, 0, mesh->vertex_count * sizeof *sum);
    memset(count, 0, mesh->vertex_count * sizeof *count);
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *v = mesh->triangle + 3 * (size_t)t;
        const float mean = (open[v[0]] + open[v[1]] + open[v[2]]) / 3;
        for (int i = 0; i < 3; i++) {
            sum[v[i]] += mean;
            count[v[i]]++;
        }
    }
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        if (count[i] > 0)
            open[i] = sum[i] / count[i];
}

/* Shares out of sums. */
static void finish(const fap_mesh *mesh, const sight *s, int smoothings, float *scratch)
{
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        s->seen[i] = (s->seen[i] + s->trust) / (s->sum[i] + s->trust);
    for (int i = 0; i < smoothings; i++)
        smooth(mesh, s->seen, s->sum, scratch);
}

fap_err occlusion_measure(const gl_functions *gl, const fap_bank *bank, GLuint index_buffer, GLuint program,
                          float *open, float *key)
{
    const fap_mesh *mesh = fap_bank_mesh(bank);
    const size_t n = mesh->vertex_count;
    cloud c = { .count = mesh->vertex_count };
    float *depth = malloc(SIZE * SIZE * sizeof *depth), *sum = calloc(n, 2 * sizeof *sum);

    c.position = calloc(n, 3 * sizeof(float));
    c.normal = calloc(n, 3 * sizeof(float));
    memset(open, 0, n * sizeof *open);
    memset(key, 0, n * sizeof *key);
    const int have = depth && sum && c.position && c.normal;
    if (have) {
        open_mouth(bank, c.position);
        measure_bounds(&c);
        measure_normals(&c, mesh);
        const sight sky = {
            .sum = sum, .seen = open, .floor = 0.30f, .least = 0.02f, .trust = 1e-6f, .grazing = 1
        };
        const sight lamp = {
            .sum = sum + n, .seen = key, .floor = 1, .least = 0.05f, .trust = 0.1f * KEY_DIRECTIONS
        };
        watch w = { .gl = gl, .cloud = &c, .triangles = mesh->triangle_count, .depth = depth };
        watch_open(&w, index_buffer, program);
        look_from(&w, sky_direction, SKY_DIRECTIONS, &sky);
        look_from(&w, key_direction, KEY_DIRECTIONS, &lamp);
        watch_close(&w);
        finish(mesh, &sky, OPEN_SMOOTHINGS, c.normal);
        finish(mesh, &lamp, KEY_SMOOTHINGS, c.normal);
    }
    free(c.normal);
    free(c.position);
    free(sum);
    free(depth);
    return have ? FAP_OK : FAP_E_NOMEM;
}
#endif
