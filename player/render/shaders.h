/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The shaders. Light is added up in linear space, with squares and roots for the screen's curve, because OSMesa's framebuffers do
 * not convert. In software every operation here runs for every 4 x 4 pixels that a triangle touches, ten times as many as
 * the face has: no power, no exponential, no branch, few values between vertex and pixel.
 */
#ifndef PLAYER_RENDER_SHADERS_H
#define PLAYER_RENDER_SHADERS_H

#include "player/render/lamps.h"
#include "player/render/look.h"

/* clang-format off */

static const char depth_vertex_source[] =
    "#version 330 core\n"
    "layout(location = 0) in vec3 position;\n"
    "uniform mat4 view_projection;\n"
    "void main() { gl_Position = view_projection * vec4(position, 1); }\n";

static const char depth_fragment_source[] = "#version 330 core\n"
                                            "void main() {}\n";

/* The edges of the triangles. */
static const char wire_fragment_source[] = "#version 330 core\n"
                                           "out vec4 colour;\n"
                                           "void main() { colour = vec4(0.06, 0.14, 0.20, 1); }\n";

/* A disc of @size pixels with a dark rim, drawn @nearer to the eye by a share of the distance. */
static const char mark_vertex_source[] =
    "#version 330 core\n"
    "layout(location = 0) in vec3 position;\n"
    "layout(location = 1) in vec3 rgb;\n"
    "uniform mat4 view_projection;\n"
    "uniform vec3 eye;\n"
    "uniform float size, nearer;\n"
    "out vec3 tint;\n"
    "void main() {\n"
    "    tint = rgb;\n"
    "    gl_Position = view_projection * vec4(mix(position, eye, nearer), 1);\n"
    "    gl_PointSize = size;\n"
    "}\n";

static const char mark_fragment_source[] =
    "#version 330 core\n"
    "in vec3 tint;\n"
    "uniform float size, alpha;\n"
    "out vec4 colour;\n"
    "void main() {\n"
    "    float r = length(gl_PointCoord - 0.5) * size;\n"
    "    float inside = clamp(0.5 * size - r, 0, 1);\n"
    "    colour = vec4(tint * clamp(0.5 * size - r - 0.5, 0.15, 1), 1) * (alpha * inside);\n"
    "}\n";

/*
 * The end of a picture: the face, drawn larger than the picture on nothing, becomes smaller before the studio. One triangle over
 * all of it; no vertex buffer. @place: of the picture, its corner and its size in pixels. @first_on_top: 0 as OpenGL
 * counts rows, 1 as pictures do.
 */
static const char studio_vertex_source[] =
    "#version 330 core\n"
    "void main() {\n"
    "    gl_Position = vec4(gl_VertexID == 1 ? 3 : -1, gl_VertexID == 2 ? 3 : -1, 0, 1);\n"
    "}\n";

/* What is behind the face, at @at; @cover: of a picture, what of it is seen. */
#define BEHIND_STUDIO \
    /* It is brighter behind the face's key side. */ \
    "vec4 behind(vec2 at) {\n" \
    "    vec2 d = 2 * at - vec2(0.9, 1.15);\n" \
    "    float far = dot(d, d);\n" \
    "    return vec4(mix(vec3(0.34, 0.38, 0.43), vec3(0.73, 0.76, 0.79), 1 / (1 + far * (0.9 + 0.45 * far))), 1);\n" \
    "}\n"
#define BEHIND_COLOUR "uniform vec4 plain;\nvec4 behind(vec2 at) { return plain; }\n"
#define BEHIND_PICTURE \
    "uniform sampler2D picture;\n" \
    "uniform vec4 cover;\n" \
    "vec4 behind(vec2 at) { return vec4(texture(picture, cover.xy + cover.zw * vec2(at.x, 1 - at.y)).rgb, 1); }\n"
#define BEHIND_NOTHING "vec4 behind(vec2 at) { return vec4(0); }\n"

/* Over nothing colours stay as they are where the face fades: the alpha says how much of them there is. */
#define STUDIO_FRAGMENT(BEHIND, FINISH) \
    "#version 330 core\n" \
    "uniform sampler2D drawn;\n" \
    "uniform vec4 place;\n" \
    "uniform bool first_on_top;\n" \
    "out vec4 colour;\n" BEHIND \
    "void main() {\n" \
    "    vec2 at = gl_FragCoord.xy - place.xy;\n" /* halves: exact, so that either order gives the same bits */ \
    "    at.y = first_on_top ? place.w - at.y : at.y;\n" \
    "    at /= place.zw;\n" \
    "    vec4 face = texture(drawn, at);\n" \
    "    colour = face + (1 - face.a) * behind(at);\n" FINISH "}\n"

static const char *const studio_fragment_sources[] = {
    [BACKDROP_STUDIO] = STUDIO_FRAGMENT(BEHIND_STUDIO, ""),
    [BACKDROP_COLOUR] = STUDIO_FRAGMENT(BEHIND_COLOUR, ""),
    [BACKDROP_PICTURE] = STUDIO_FRAGMENT(BEHIND_PICTURE, ""),
    [BACKDROP_NOTHING] = STUDIO_FRAGMENT(BEHIND_NOTHING, "    colour.rgb /= max(colour.a, 1.0 / 255);\n"),
};

/* What vertex shaders of the face share. Position and normal are of one pose, the others never change. */
#define FACE_VERTEX \
    "#version 330 core\n" \
    "layout(location = 0) in vec3 position;\n" \
    "layout(location = 1) in vec3 normal;\n" \
    "layout(location = 2) in vec4 paint;\n"   /* sRGB and gloss */ \
    "layout(location = 3) in vec4 surface;\n" /* openness to the sky and to the key lamp, part, head weight */ \
    "uniform mat4 view_projection;\n"

/* Three lamps and a room. A shoulder and the screen's curve are one: midtones stay, lights roll off. */
#define LIGHTS \
    "const vec3 key_from = normalize(vec3(" LAMP_TEXT(KEY_FROM) ")), key_light = vec3(2.55, 2.33, 2.08);\n" \
    "const vec3 fill_from = normalize(vec3(0.80, 0.15, 0.58)), fill_light = vec3(0.66, 0.60, 0.57);\n" \
    "const vec3 rim_from = normalize(vec3(0.62, 0.45, -0.72)), rim_light = vec3(0.95, 0.92, 0.90);\n" \
    "const vec3 sky = vec3(0.50, 0.52, 0.55), ground = vec3(0.27, 0.21, 0.18);\n" \
    "vec3 on_screen(vec3 c) {\n" \
    "    vec3 s = min(sqrt(0.68 * c), 1.35);\n" \
    "    return s * (1 - 0.165 * s * s);\n" \
    "}\n"

/* @define: "#define TEXTURED\n", where a picture takes the place of the skin's paint, or "". */
#define SKIN_VERTEX(DEFINE) FACE_VERTEX DEFINE \
    "noperspective out vec4 facing;\n" /* and gloss */ \
    "noperspective out vec4 tint;\n"   /* and how much of the sky is seen */ \
    "noperspective out vec2 lamps;\n"  /* how much of the key is seen; how much of the head this is */ \
    "#ifdef TEXTURED\n" \
    "layout(location = 5) in vec2 uv;\n" \
    "out vec3 on_skin;\n" /* rows from the top; 1: skin */ \
    "#endif\n" \
    "void main() {\n" \
    "    bool is_teeth = surface.z > 2.5 && surface.z < 4.5, is_skin = surface.z < 0.5 || surface.z > 4.5;\n" \
    "    float open = surface.x / 255;\n" \
    "    /* Where the sky is hidden light comes from skin, and is red. */\n" \
    "    vec3 deep = mix(vec3(1), vec3(1.0, 0.72, 0.66), is_skin ? (1 - open) * open * 2.4 : 0.0);\n" \
    "    float near = is_teeth ? 0.02 : 0.25;\n" \
    "    facing = vec4(normal, paint.a);\n" \
    "    tint = vec4(paint.rgb * paint.rgb, open);\n" \
    "#ifdef TEXTURED\n" \
    "    on_skin = vec3(uv.x, 1 - uv.y, surface.z < 0.5 ? 1 : 0);\n" \
    "    tint.rgb = mix(tint.rgb, vec3(1), on_skin.z);\n" \
    "#endif\n" \
    "    tint.rgb *= deep;\n" \
    "    lamps.x = mix(near, 1.0, smoothstep(0.0, 0.62, open)) * (is_teeth ? 1.0 : surface.y / 255);\n" \
    "    lamps.y = smoothstep(0.02, 0.45, surface.w / 255);\n" \
    "    gl_Position = view_projection * vec4(position, 1);\n" \
    "}\n"

static const char face_vertex_source[] = SKIN_VERTEX("");
static const char textured_vertex_source[] = SKIN_VERTEX("#define TEXTURED\n");

/* The key's wrap is widest for red: light that travels under the skin keeps the edges of its shade warm. */
#define SKIN_FRAGMENT(DEFINE) \
    "#version 330 core\n" DEFINE LIGHTS \
    "noperspective in vec4 facing, tint;\n" \
    "noperspective in vec2 lamps;\n" \
    "uniform vec3 view, half_key;\n" \
    "#ifdef TEXTURED\n" \
    "in vec3 on_skin;\n" \
    "uniform sampler2D skin;\n" \
    "#endif\n" \
    "out vec4 colour;\n" \
    "void main() {\n" \
    "    vec3 n = facing.xyz * (1.5 - 0.5 * dot(facing.xyz, facing.xyz));\n" /* nearly of length 1 already */ \
    "    float open = tint.a, seen = lamps.x, gloss = facing.w;\n" \
    "    vec3 key = max(dot(n, key_from) * vec3(0.76, 0.84, 0.88) + vec3(0.24, 0.16, 0.12), 0);\n" \
    "    vec3 through = seen * (vec3(1.25, 1.0, 0.94) + seen * vec3(-0.25, 0.0, 0.06));\n" \
    "    float fill = max(0.86 * dot(n, fill_from) + 0.14, 0), rim = max(dot(n, rim_from), 0);\n" \
    "    vec3 light = open * (mix(ground, sky, 0.5 + 0.5 * n.y) + rim * rim_light + fill * fill_light);\n" \
    "    light += key * (0.4 + 0.6 * key) * through * key_light;\n" \
    "\n" \
    "    float h = max(dot(n, half_key), 0), graze = max(1 - dot(n, view), 0);\n" \
    "    h *= h; h *= h; h *= h;\n" \
    "    float broad = h * h, sharp = broad * broad * broad;\n" /* to the 16th and the 48th */ \
    "    float wet = sharp * sharp;\n" \
    "    graze *= graze;\n" \
    "    float shine = 0.045 * broad + 0.05 * sharp + gloss * gloss * 0.42 * wet;\n" \
    "    vec3 paint = tint.rgb;\n" \
    "#ifdef TEXTURED\n" \
    "    vec3 picture = texture(skin, on_skin.xy).rgb;\n" \
    "    paint *= mix(vec3(1), picture * picture, on_skin.z);\n" \
    "#endif\n" \
    "    vec3 c = paint * light + key_light * (seen * shine * (1 + 3 * graze)) + sky * (open * graze * graze * 0.2);\n" \
    "    colour = vec4(on_screen(c), 1) * lamps.y;\n" /* the neck fades */ \
    "}\n"

static const char face_fragment_source[] = SKIN_FRAGMENT("");
static const char textured_fragment_source[] = SKIN_FRAGMENT("#define TEXTURED\n");

/* An eyeball. @on_iris: -1..1 across the eye, from the middle of the pupil; @limbus: the iris' radius there. */
static const char eye_vertex_source[] = FACE_VERTEX "layout(location = 4) in vec2 on_eye;\n"
                                                    "out vec4 facing;\n" /* and openness */
                                                    "out vec3 place, tint;\n"
                                                    "out vec2 across;\n"
                                                    "void main() {\n"
                                                    "    facing = vec4(normal, surface.x / 255);\n"
                                                    "    place = position;\n"
                                                    "    tint = paint.rgb * paint.rgb;\n"
                                                    "    across = on_eye;\n"
                                                    "    gl_Position = view_projection * vec4(position, 1);\n"
                                                    "}\n";

static const char eye_fragment_source[] =
    "#version 330 core\n" LIGHTS "in vec4 facing;\n"
    "in vec3 place, tint;\n"
    "in vec2 across;\n"
    "uniform vec3 view, gaze, lid, iris, white;\n"
    "uniform float limbus;\n" /* 0: the vertices' own colours */
    "uniform float size;\n"   /* radius, millimetres */
    "out vec4 colour;\n"
    "const vec3 window = normalize(vec3(-0.40, 0.46, 0.80));\n"
    "const vec3 window_x = normalize(cross(vec3(0, 1, 0), window)), window_y = cross(window, window_x);\n"
    "\n"
    "vec3 painted(float from_pupil) {\n"
    "    vec2 way = across / max(length(across), 1e-4);\n"
    "    float fibre = sin(41 * way.x + 9 * way.y) * sin(37 * way.y - 13 * way.x) + sin(23 * way.x - 29 * "
    "way.y);\n"
    "    float ring = smoothstep(0.42, 0.50, from_pupil) - smoothstep(0.50, 0.85, from_pupil);\n"
    "    vec3 c = iris * (0.85 + 0.16 * fibre + 0.45 * ring + 0.75 * dot(across / limbus, vec2(0.45, "
    "-0.55)));\n"
    "    c *= 1 - 0.85 * smoothstep(0.80, 1.0, from_pupil);\n"
    "    c *= smoothstep(0.35, 0.42, from_pupil);\n"
    "    float back = smoothstep(0.35, 0.85, length(across));\n"
    "    return mix(c, mix(white, white * vec3(0.80, 0.52, 0.46), back), smoothstep(0.94, 1.06, "
    "from_pupil));\n"
    "}\n"
    "void main() {\n"
    "    vec3 n = normalize(facing.xyz);\n"
    "    float from_pupil = length(across) / max(limbus, 0.01);\n"
    "    vec3 base = limbus > 0 ? painted(from_pupil) : tint;\n"
    "    /* The cornea bulges: what it mirrors lies closer to the pupil than a sphere would show it. */\n"
    "    float bulge = limbus > 0 ? 0.9 * (1 - smoothstep(0.8, 1.25, from_pupil)) : 0.0;\n"
    "    vec3 m = normalize(n + bulge * (n - gaze * dot(n, gaze)));\n"
    "    /* Lid and lashes shade the upper part. The lid is an arc over the eye. */\n"
    "    vec3 below = (lid - place) / size;\n"
    "    float under = below.y - 0.55 * below.x * below.x;\n"
    "    float shade = mix(0.30, 1.0, smoothstep(-0.06, 0.26, under)) * mix(0.55, 1.0, facing.w);\n"
    "    float key = max(0.8 * dot(n, key_from) + 0.2, 0), fill = max(0.8 * dot(n, fill_from) + 0.2, 0);\n"
    "    vec3 light = mix(ground, sky, 0.5 + 0.5 * n.y) + key * key_light * 0.62 + fill * fill_light;\n"
    "    vec3 c = base * light * shade;\n"
    "    vec3 r = 2 * dot(m, view) * m - view;\n"
    "    vec2 at = abs(vec2(dot(r, window_x), dot(r, window_y)));\n"
    "    vec2 inside = 1 - smoothstep(vec2(0.15, 0.19), vec2(0.20, 0.24), at);\n"
    "    c += key_light * (inside.x * inside.y * step(0, dot(r, window)) * 0.85 * smoothstep(-0.05, 0.10, "
    "under));\n"
    "    float f = max(dot(r, fill_from), 0);\n"
    "    f *= f; f *= f; f *= f; f *= f; f *= f;\n"
    "    float graze = 1 - max(dot(m, view), 0);\n"
    "    c += fill_light * f * 0.30 + sky * (0.03 + 0.5 * graze * graze * graze) * shade * max(r.y + 0.3, "
    "0);\n"
    "    colour = vec4(on_screen(c), 1);\n"
    "}\n";

/* clang-format on */

#endif
