/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * How fast a face is posed, drawn without a window and read back; what that costs beside a program that only clears, draws
 * and reads an unmoving mesh. A ratio is measured in one run, frame by
 * frame in turn, and of medians: other work on the machine slows both.
 */
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <fap/derive.h>
#include <fap/face.h>

#include "bench.h"
#include "ict.h"
#include "player/render/renderer.h"
#include "takes.h"

enum { FRAMES = 120, WARM_UP = 5 };

typedef struct stage {
    ict ict;
    fap_bank *bank; /* NULL: the stage's face is ict's */
    fap_face *face;
    renderer *renderer;
    float *position, *normal;
    image picture;
} stage;

static void close_stage(stage *s)
{
    image_free(&s->picture);
    renderer_destroy(&s->renderer);
    free(s->normal);
    free(s->position);
    fap_face_close(&s->face);
    fap_bank_close(&s->bank);
    ict_close(&s->ict);
}

static int set_up(stage *s, const fap_bank *bank, const char *gl, int width, int height)
{
    char where[FAP_ERROR_TEXT_SIZE];

    if (!bank || fap_face_open(&s->face, bank, NULL) != FAP_OK)
        return 0;
    const size_t size = 3 * sizeof(float) * fap_face_stride(s->face);
    s->position = aligned_alloc(32, size);
    s->normal = aligned_alloc(32, size);
    return s->position && s->normal && image_create(&s->picture, width, height) == FAP_OK &&
           renderer_create(&s->renderer, gl, bank, width, height, where) == FAP_OK;
}

static int open_default(stage *s, const char *gl, int width, int height)
{
    *s = (stage){ .bank = bench_bank() };
    return set_up(s, s->bank, gl, width, height);
}

static int open_52k(stage *s, int width, int height)
{
    *s = (stage){ 0 };
    return ict_open(&s->ict) && set_up(s, s->ict.bank, NULL, width, height);
}

/* A talking head's load: jaw, lips, brows, lids and head in motion. The head's turn moves every vertex. */
static void pose(stage *s, int i)
{
    static const int faps[] = { 3, 19, 20, 31, 32, 33, 34, 48, 49, 51, 52, 53, 54, 55, 56, 57, 58, 59, 60 };
    fap_frame frame = { 0 };

    for (size_t k = 0; k < sizeof faps / sizeof *faps; k++) {
        frame.state[faps[k]] = FAP_CODED;
        frame.value[faps[k]] = (i * (7 + (int)k)) % 240 - 60;
    }
    fap_derive(&frame);
    fap_face_pose(s->face, &frame, s->position, s->normal);
}

static render_scene scene_of(const stage *s)
{
    return (render_scene){ s->position, s->normal, .view = render_view_of(CAMERA_FRONT) };
}

/* As fapplay does it: the next frame is posed while one is drawn. */
static int play(stage *s, int from, int count)
{
    const render_scene scene = scene_of(s);

    pose(s, from);
    for (int i = from; i < from + count; i++) {
        if (renderer_begin(s->renderer, &scene) != FAP_OK)
            return 0;
        pose(s, i + 1);
        if (renderer_finish(s->renderer, &s->picture) != FAP_OK)
            return 0;
    }
    return 1;
}

/* Of all threads: what a frame costs however busy the machine is. */
static double processor_s(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static double fps(stage *s)
{
    if (!play(s, 0, WARM_UP))
        return -1;
    const double start = bench_now_s(), busy = processor_s();
    if (!play(s, WARM_UP, FRAMES))
        return -1;
    const double seconds = bench_now_s() - start;
    bench_note("processor_time_of_a_frame", 1e3 * (processor_s() - busy) / FRAMES, "ms");
    return FRAMES / seconds;
}

double bench_offscreen_fps_52k(void)
{
    stage s;
    const double figure = open_52k(&s, 640, 480) ? fps(&s) : -1;

    close_stage(&s);
    return figure;
}

double bench_offscreen_fps_default(void)
{
    stage s;
    const double figure = open_default(&s, NULL, 512, 512) ? fps(&s) : -1;

    close_stage(&s);
    return figure;
}

#ifdef HAVE_OSMESA
#include "player/render/camera.h"
#include "player/render/context.h"
#include "player/render/face_array.h"
#include "player/render/gl_objects.h"
#include "player/render/lamps.h"
#include "player/render/shaders.h"

/* --- the same mesh, bare --- */

/* OpenGL and nothing else: one program for all of it, the picture's own size or twice as wide and high. */
typedef struct bare {
    gl_context context;
    gl_functions gl;
    face_array face;
    GLuint program, studio, empty;
    gl_target drawn, read;
    int width, height, scale;
} bare;

static const char plain_vertex_source[] = FACE_VERTEX
    "out vec3 facing, tint;\n"
    "void main() { facing = normal; tint = paint.rgb; gl_Position = view_projection * vec4(position, 1); }\n";

static const char plain_fragment_source[] = "#version 330 core\n"
                                            "in vec3 facing, tint;\n"
                                            "out vec4 colour;\n"
                                            "void main() { colour = vec4(tint * (0.2 + 0.8 * "
                                            "max(dot(normalize(facing), vec3(0.3, 0.5, 0.8)), 0)), 1); }\n";

static void set_uniforms(bare *b, const fap_bank *bank)
{
    const render_view view = render_view_of(CAMERA_FRONT);
    const head_frame head = head_frame_of(bank);
    const float place[4] = { 0, 0, (float)b->width, (float)b->height };
    const float ahead[3] = { 0, 0, 1 }, half[3] = { -0.26f, 0.30f, 0.92f };
    render_lens lens;

    camera_place(&lens, &head, &view, (float)b->width / (float)b->height);
    b->gl.UseProgram(b->program);
    b->gl.UniformMatrix4fv(b->gl.GetUniformLocation(b->program, "view_projection"), 1, GL_FALSE,
                           lens.view_projection[0]);
    b->gl.Uniform3fv(b->gl.GetUniformLocation(b->program, "view"), 1, ahead);
    b->gl.Uniform3fv(b->gl.GetUniformLocation(b->program, "half_key"), 1, half);
    b->gl.UseProgram(b->studio);
    b->gl.Uniform4fv(b->gl.GetUniformLocation(b->studio, "place"), 1, place);
    b->gl.Uniform1i(b->gl.GetUniformLocation(b->studio, "first_on_top"), 1);
}

/* @plain: one lamp and no smoothing, the least that shows a face; else with the renderer's shaders and smoothing. */
static int open_bare(bare *b, const stage *s, const fap_bank *bank, int plain)
{
    char where[FAP_ERROR_TEXT_SIZE];

    *b = (bare){ .width = s->picture.width, .height = s->picture.height, .scale = plain ? 1 : 2 };
    if (gl_context_open(&b->context, "osmesa", where) || gl_load(&b->gl, b->context.driver->get_function))
        return 0;
    const GLuint depth = gl_program_make(&b->gl, depth_vertex_source, depth_fragment_source, where);
    b->program = gl_program_make(&b->gl, plain ? plain_vertex_source : face_vertex_source,
                                 plain ? plain_fragment_source : face_fragment_source, where);
    b->studio =
        gl_program_make(&b->gl, studio_vertex_source, studio_fragment_sources[BACKDROP_STUDIO], where);
    b->gl.GenVertexArrays(1, &b->empty);
    if (!depth || !b->program || !b->studio || face_array_make(&b->face, &b->gl, bank, depth) ||
        face_array_send(&b->face, &b->gl, fap_bank_mesh(bank), s->position, s->normal))
        return 0;
    set_uniforms(b, bank);
    b->gl.Enable(GL_CULL_FACE);
    return gl_target_make(&b->gl, &b->drawn, b->scale * b->width, b->scale * b->height, 1) &&
           gl_target_make(&b->gl, &b->read, b->width, b->height, 0);
}

static void draw_bare(const bare *b, image *picture)
{
    const gl_functions *gl = &b->gl;

    b->context.driver->make_current(b->context.state);
    gl->BindFramebuffer(GL_FRAMEBUFFER, b->drawn.frame);
    gl->Viewport(0, 0, b->scale * b->width, b->scale * b->height);
    gl->Enable(GL_DEPTH_TEST);
    gl->Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    gl->UseProgram(b->program);
    for (int range = 0; range < RANGE_COUNT; range++)
        face_array_draw(&b->face, gl, (face_range)range);
    if (b->scale > 1) {
        gl->BindFramebuffer(GL_FRAMEBUFFER, b->read.frame);
        gl->Viewport(0, 0, b->width, b->height);
        gl->Disable(GL_DEPTH_TEST);
        gl->UseProgram(b->studio);
        gl->BindTexture(GL_TEXTURE_2D, b->drawn.colour);
        gl->BindVertexArray(b->empty);
        gl->DrawArrays(GL_TRIANGLES, 0, 3);
        gl->BindTexture(GL_TEXTURE_2D, 0);
    }
    gl->ReadPixels(0, 0, b->width, b->height, GL_RGBA, GL_UNSIGNED_BYTE, picture->rgba);
}

static double time_bare(const bare *b, image *picture)
{
    const double start = bench_now_s();
    draw_bare(b, picture);
    return bench_now_s() - start;
}

static double time_frame(stage *s, int i)
{
    const render_scene scene = scene_of(s);
    const double start = bench_now_s();

    pose(s, i);
    return renderer_draw(s->renderer, &scene, &s->picture) == FAP_OK ? bench_now_s() - start : -1;
}

/* How many times as long a frame takes as the bare drawing. */
static double ratio_to(stage *s, const bare *b)
{
    static double frame[FRAMES], still[FRAMES];

    for (int i = 0; i < WARM_UP; i++) {
        time_bare(b, &s->picture);
        time_frame(s, i);
    }
    for (int i = 0; i < FRAMES; i++) {
        still[i] = time_bare(b, &s->picture);
        frame[i] = time_frame(s, WARM_UP + i);
        if (frame[i] < 0)
            return -1;
    }
    return bench_median(frame, FRAMES) / bench_median(still, FRAMES);
}

static double ratio(int plain)
{
    stage s;
    bare b = { 0 };
    double figure = -1;

    if (open_default(&s, "osmesa", 512, 512)) {
        pose(&s, 0);
        if (open_bare(&b, &s, s.bank, plain))
            figure = ratio_to(&s, &b);
    }
    gl_context_close(&b.context);
    close_stage(&s);
    return figure;
}
#else
static double ratio(int plain)
{
    (void)plain;
    return -1;
}
#endif

double bench_render_overhead_ratio(void)
{
    const double plain = ratio(1);

    if (plain > 0)
        bench_note("render_cost_against_one_lamp_unsmoothed", plain, "x");
    return ratio(0);
}
