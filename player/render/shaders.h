/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The shaders. Light is added up in linear space and written as sRGB, because OSMesa's framebuffers do not convert. Skin is
 * lit with a wrapped Lambert term whose wrap is wider for red than for blue: a cheap stand-in for light that travels
 * under the skin, which keeps the terminator warm and soft.
 */
#ifndef PLAYER_RENDER_SHADERS_H
#define PLAYER_RENDER_SHADERS_H

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
    "    colour = vec4(tint * clamp(0.5 * size - r - 0.5, 0.15, 1), alpha * inside);\n"
    "}\n";

/* One triangle over the whole picture; no vertex buffer. */
static const char background_vertex_source[] =
    "#version 330 core\n"
    "out vec2 at;\n"
    "void main() {\n"
    "    at = vec2(gl_VertexID == 1 ? 3 : -1, gl_VertexID == 2 ? 3 : -1);\n"
    "    gl_Position = vec4(at, 0, 1);\n"
    "}\n";

/* The studio behind the face; @at runs from -1 to 1 over the picture. */
#define STUDIO                                                                                               \
    "vec3 studio(vec2 at) {\n"                                                                               \
    "    vec2 d = at - vec2(-0.1, 0.15);\n"                                                                  \
    "    return mix(vec3(0.36, 0.40, 0.45), vec3(0.73, 0.76, 0.79), exp(-0.9 * dot(d, d)));\n"               \
    "}\n"

static const char background_fragment_source[] = "#version 330 core\n" STUDIO "in vec2 at;\n"
                                                 "out vec4 colour;\n"
                                                 "void main() { colour = vec4(studio(at), 1); }\n";

static const char face_vertex_source[] =
    "#version 330 core\n"
    "layout(location = 0) in vec3 position;\n"
    "layout(location = 1) in vec3 normal;\n"
    "layout(location = 2) in vec4 paint;\n"   /* sRGB and gloss */
    "layout(location = 3) in vec3 surface;\n" /* openness to the sky, part, head weight; bytes */
    "uniform mat4 view_projection;\n"
    "out vec3 place, facing;\n"
    "out vec4 tint;\n"
    "out float sky_seen, head;\n"
    "out vec3 on_screen;\n"
    "flat out float part;\n"
    "void main() {\n"
    "    place = position;\n"
    "    facing = normal;\n"
    "    tint = vec4(pow(paint.rgb, vec3(2.2)), paint.a);\n"
    "    sky_seen = surface.x / 255.0;\n"
    "    part = surface.y;\n"
    "    head = surface.z / 255.0;\n"
    "    gl_Position = view_projection * vec4(position, 1);\n"
    "    on_screen = gl_Position.xyw;\n"
    "}\n";

static const char face_fragment_source[] =
    "#version 330 core\n" STUDIO "in vec3 place, facing;\n"
    "in vec4 tint;\n"
    "in float sky_seen, head;\n"
    "in vec3 on_screen;\n"
    "flat in float part;\n"
    "uniform vec3 eye;\n"
    "out vec4 colour;\n"
    "\n"
    "const vec3 key_from = normalize(vec3(-0.55, 0.62, 0.78)), key_light = vec3(2.35, 2.22, 2.05);\n"
    "const vec3 fill_from = normalize(vec3(0.85, 0.12, 0.62)), fill_light = vec3(0.46, 0.52, 0.62);\n"
    "const vec3 rim_from = normalize(vec3(0.62, 0.45, -0.72)), rim_light = vec3(1.15, 1.10, 1.05);\n"
    "const vec3 sky = vec3(0.50, 0.54, 0.60), ground = vec3(0.24, 0.20, 0.18);\n"
    "\n"
    "vec3 diffuse(vec3 n, vec3 from, vec3 light, vec3 wrap) {\n"
    "    vec3 d = max((dot(n, from) + wrap) / (1 + wrap), 0);\n"
    "    return light * d * d * (1 + 0.5 * wrap) / (0.75 + 0.25 * d);\n"
    "}\n"
    "float shine(vec3 n, vec3 from, vec3 view, float power) {\n"
    "    return pow(max(dot(n, normalize(from + view)), 0), power) * step(0, dot(n, from));\n"
    "}\n"
    "void main() {\n"
    "    vec3 n = normalize(facing), view = normalize(eye - place);\n"
    "    bool is_eye = part == 1 || part == 2, is_teeth = part == 3 || part == 4;\n"
    "    bool is_skin = part == 0 || part == 5;\n"
    "    if (dot(n, view) < 0 && !gl_FrontFacing) n = -n;\n"
    "    float gloss = tint.a, open_sky = sky_seen;\n"
    "    vec3 wrap = is_skin ? vec3(0.42, 0.20, 0.13) : vec3(0.12);\n"
    "    /* What the sky cannot reach, the lamps reach less too; deep places turn red, not black, on skin. "
    "*/\n"
    "    vec3 shade = mix(vec3(open_sky), pow(vec3(open_sky), vec3(0.62, 0.95, 1.05)), is_skin ? 1.0 : "
    "0.0);\n"
    "    vec3 lamp = mix(vec3(is_teeth ? 0.02 : 0.25), vec3(1), smoothstep(0.0, 0.62, open_sky)) * "
    "mix(shade, vec3(1), 0.35);\n"
    "    vec3 light = mix(ground, sky, 0.5 + 0.5 * n.y) * shade;\n"
    "    light += (diffuse(n, key_from, key_light, wrap) + diffuse(n, fill_from, fill_light, wrap)) * lamp;\n"
    "    light += diffuse(n, rim_from, rim_light, vec3(0.05)) * shade * 0.55;\n"
    "    vec3 c = tint.rgb * light;\n"
    "\n"
    "    float grazing = pow(1 - max(dot(n, view), 0), 4);\n"
    "    vec3 key_seen = key_light * lamp;\n"
    "    if (is_eye) {\n"
    "        c += key_seen * (1.3 * shine(n, key_from, view, 420) + 0.05 * shine(n, key_from, view, 40));\n"
    "        c += fill_light * lamp * 0.35 * shine(n, fill_from, view, 160);\n"
    "    } else {\n"
    "        float broad = shine(n, key_from, view, 14), sharp = shine(n, key_from, view, mix(38, 110, "
    "gloss));\n"
    "        c += key_seen * (0.030 * broad + mix(0.045, 0.38, gloss * gloss) * sharp);\n"
    "        c += fill_light * lamp * 0.05 * shine(n, fill_from, view, 22);\n"
    "        c += sky * shade * grazing * (is_teeth ? 0.1 : 0.16);\n"
    "    }\n"
    "    c = c * 0.74;\n"
    "    c = c * (1 + c * 0.16) / (1 + c * 0.62);\n" /* shoulder: highlights roll off, midtones stay */
    "    /* The mesh ends somewhere down the neck; it fades into the studio before that. */\n"
    "    vec3 seen = pow(max(c, 0), vec3(1 / 2.2));\n"
    "    colour = vec4(mix(studio(on_screen.xy / on_screen.z), seen, smoothstep(0.02, 0.45, head)), 1);\n"
    "}\n";

#endif
