/* SPDX-License-Identifier: BSD-2-Clause */
/* See glb_content.h. Node 0 is the mesh, behind it the joints that the face has. */
#include <stdlib.h>
#include <string.h>

#include "player/sinks/glb_content.h"
#include "player/sinks/glb_file.h"
#include "player/sinks/glb_mesh.h"

typedef struct content {
    const glb_rig *rig;
    const glb_shape *shape;
    const glb_track *track;
    const glb_about *about;
    glb_file file;
    glb_mesh mesh;
    int number[JOINT_COUNT]; /* of each joint among those the face has; node 1 + number */
    int bind, time, weights;
    int turn[JOINT_COUNT], move[JOINT_COUNT]; /* accessors, -1: the joint does not move */
    json json;
} content;

static const float metre = 1e-3f;

double glb_estimate(const fap_bank *bank, int64_t frame_count)
{
    const fap_mesh *mesh = fap_bank_mesh(bank);
    const double corrections = 49, targets = fap_bank_key_count(bank) + corrections;
    double blocks = corrections * (mesh->stride / FAP_BLOCK);

    for (int k = 0; k < fap_bank_key_count(bank); k++)
        blocks += fap_bank_key_get(bank, k)->block_count;
    return 1e6 + 64.0 * mesh->vertex_count + 12.0 * mesh->triangle_count + 32.0 * FAP_BLOCK * blocks +
           (double)frame_count * (4 * targets + 28 * JOINT_COUNT + 4);
}

/* --- numbers --- */

static void number_joints(content *c)
{
    for (int j = 0, n = 0; j < JOINT_COUNT; j++)
        c->number[j] = c->rig->present[j] ? n++ : 0;
}

static int joint_count(const content *c)
{
    int count = 0;

    for (int j = 0; j < JOINT_COUNT; j++)
        count += c->rig->present[j];
    return count;
}

static void add_bind(content *c)
{
    float matrix[JOINT_COUNT][16] = { { 0 } };
    uint32_t count = 0;

    for (int j = 0; j < JOINT_COUNT; j++) {
        if (!c->rig->present[j])
            continue;
        float *m = matrix[count++];
        m[0] = m[5] = m[10] = m[15] = 1;
        for (int axis = 0; axis < 3; axis++)
            m[12 + axis] = -metre * c->rig->origin[j][axis];
    }
    c->bind = glb_add_floats(&c->file, SECTION_BIND, matrix[0], count, 16);
}

/* Where a joint rests, seen from its parent. */
static void rest_of(const content *c, int j, float out[3])
{
    const float *parent = c->rig->origin[glb_joint_parent((glb_joint)j)];

    for (int axis = 0; axis < 3; axis++)
        out[axis] = metre * (c->rig->origin[j][axis] - (j == JOINT_SHOULDERS ? 0 : parent[axis]));
}

static int all_alike(const float *value, uint32_t count, int width)
{
    for (uint32_t i = 1; i < count; i++)
        if (memcmp(value, value + (size_t)i * (size_t)width, (size_t)width * sizeof *value))
            return 0;
    return 1;
}

static void add_turn(content *c, int j)
{
    const float *turn = c->track->turn[j][0];

    if (turn[3] != 1 || !all_alike(turn, c->track->frame_count, 4))
        c->turn[j] = glb_add_floats(&c->file, SECTION_ANIMATION, turn, c->track->frame_count, 4);
}

/* A channel says where a joint is, not how far from its rest. */
static void add_move(content *c, int j)
{
    static const float nowhere[3] = { 0, 0, 0 };
    float(*move)[3] = c->track->move[j], rest[3];

    if (!memcmp(move[0], nowhere, sizeof nowhere) && all_alike(move[0], c->track->frame_count, 3))
        return;
    rest_of(c, j, rest);
    for (uint32_t i = 0; i < c->track->frame_count; i++)
        for (int axis = 0; axis < 3; axis++)
            move[i][axis] += rest[axis];
    c->move[j] = glb_add_floats(&c->file, SECTION_ANIMATION, move[0], c->track->frame_count, 3);
}

static void add_animation(content *c)
{
    const glb_track *t = c->track;

    c->time = glb_add_floats(&c->file, SECTION_ANIMATION, t->time_s, t->frame_count, 1);
    glb_set_range(&c->file, c->time, t->time_s);
    c->weights =
        glb_add_floats(&c->file, SECTION_ANIMATION, t->weight, t->frame_count * (uint32_t)t->target_count, 1);
    for (int j = 0; j < JOINT_COUNT; j++) {
        c->turn[j] = c->move[j] = -1;
        if (!c->rig->present[j])
            continue;
        add_turn(c, j);
        add_move(c, j);
    }
}

/* --- JSON --- */

static void put_vector(json *j, const char *key, const float v[3])
{
    json_open(j, key, '[');
    for (int axis = 0; axis < 3; axis++)
        json_float(j, NULL, v[axis]);
    json_close(j, ']');
}

static void put_children(content *c, glb_joint parent)
{
    json_open(&c->json, "children", '[');
    for (int j = JOINT_NECK_1; j < JOINT_COUNT; j++)
        if (c->rig->present[j] && glb_joint_parent((glb_joint)j) == parent)
            json_integer(&c->json, NULL, 1 + c->number[j]);
    json_close(&c->json, ']');
}

static int has_children(const content *c, glb_joint parent)
{
    for (int j = JOINT_NECK_1; j < JOINT_COUNT; j++)
        if (c->rig->present[j] && glb_joint_parent((glb_joint)j) == parent)
            return 1;
    return 0;
}

static void put_joint(content *c, int j)
{
    float rest[3];

    rest_of(c, j, rest);
    json_open(&c->json, NULL, '{');
    json_string(&c->json, "name", glb_joint_name((glb_joint)j));
    put_vector(&c->json, "translation", rest);
    if (has_children(c, (glb_joint)j))
        put_children(c, (glb_joint)j);
    json_close(&c->json, '}');
}

static void put_nodes(content *c)
{
    json *j = &c->json;

    json_open(j, "nodes", '[');
    json_open(j, NULL, '{');
    json_string(j, "name", "face");
    json_integer(j, "mesh", 0);
    json_integer(j, "skin", 0);
    json_close(j, '}');
    for (int i = 0; i < JOINT_COUNT; i++)
        if (c->rig->present[i])
            put_joint(c, i);
    json_close(j, ']');
    json_integer(j, "scene", 0);
    json_open(j, "scenes", '[');
    json_open(j, NULL, '{');
    json_open(j, "nodes", '[');
    json_integer(j, NULL, 0);
    json_integer(j, NULL, 1);
    json_close(j, ']');
    json_close(j, '}');
    json_close(j, ']');
    json_open(j, "skins", '[');
    json_open(j, NULL, '{');
    json_integer(j, "inverseBindMatrices", c->bind);
    json_open(j, "joints", '[');
    for (int i = 0; i < joint_count(c); i++)
        json_integer(j, NULL, 1 + i);
    json_close(j, ']');
    json_close(j, '}');
    json_close(j, ']');
}

/* ARKit's names for units, which other programs look for; the kind in front of what might be called the same. */
static void put_target_name(content *c, int target)
{
    static const char *const kind[] = { "viseme_", "expression_", "", "" };
    const fap_key *key = target < c->shape->key_count ? fap_bank_key_get(c->shape->bank, target) : NULL;
    char name[128];

    if (target == c->shape->key_count + c->shape->correction_count)
        snprintf(name, sizeof name, "correction_all");
    else if (!key)
        snprintf(name, sizeof name, "correction_%d", target - c->shape->key_count + 1);
    else
        snprintf(name, sizeof name, "%s%s", key->kind <= FAP_KEY_UNIT ? kind[key->kind] : "", key->name);
    json_string(&c->json, NULL, name);
}

static void put_target(json *j, const glb_primitive *p, int target)
{
    json_open(j, NULL, '{');
    json_integer(j, "POSITION", p->target_position[target]);
    json_integer(j, "NORMAL", p->target_normal[target]);
    json_close(j, '}');
}

static void put_primitive(content *c, const glb_primitive *p, int material)
{
    json *j = &c->json;

    json_open(j, NULL, '{');
    json_open(j, "attributes", '{');
    json_integer(j, "POSITION", p->position);
    json_integer(j, "NORMAL", p->normal);
    if (p->colour >= 0)
        json_integer(j, "COLOR_0", p->colour);
    if (p->uv >= 0)
        json_integer(j, "TEXCOORD_0", p->uv);
    json_integer(j, "JOINTS_0", p->joints);
    json_integer(j, "WEIGHTS_0", p->shares);
    json_integer(j, "_VERTEX", p->number);
    json_close(j, '}');
    json_integer(j, "indices", p->triangles);
    json_integer(j, "material", material);
    json_open(j, "targets", '[');
    for (int t = 0; t < c->mesh.target_count; t++)
        put_target(j, p, t);
    json_close(j, ']');
    json_close(j, '}');
}

static void put_mesh(content *c)
{
    json *j = &c->json;

    json_open(j, "meshes", '[');
    json_open(j, NULL, '{');
    json_string(j, "name", fap_bank_name(c->shape->bank));
    json_open(j, "primitives", '[');
    for (int i = 0, material = 0; i < GROUP_COUNT; i++)
        if (c->mesh.group[i].triangle_count)
            put_primitive(c, &c->mesh.group[i], material++);
    json_close(j, ']');
    json_open(j, "extras", '{');
    json_open(j, "targetNames", '[');
    for (int t = 0; t < c->mesh.target_count; t++)
        put_target_name(c, t);
    json_close(j, ']');
    json_close(j, '}');
    json_close(j, '}');
    json_close(j, ']');
}

static void put_texture(json *j)
{
    json_open(j, "baseColorTexture", '{');
    json_integer(j, "index", 0);
    json_close(j, '}');
}

static void put_images(content *c)
{
    json *j = &c->json;

    json_open(j, "images", '[');
    json_open(j, NULL, '{');
    json_integer(j, "bufferView", glb_view(&c->file, SECTION_IMAGE));
    json_string(j, "mimeType", "image/png");
    json_close(j, '}');
    json_close(j, ']');
    json_open(j, "textures", '[');
    json_open(j, NULL, '{');
    json_integer(j, "source", 0);
    json_close(j, '}');
    json_close(j, ']');
}

static void put_materials(content *c)
{
    static const char *const name[GROUP_COUNT] = { "skin", "eyes", "mouth", "lashes" };
    json *j = &c->json;

    json_open(j, "materials", '[');
    for (int i = 0; i < GROUP_COUNT; i++) {
        if (!c->mesh.group[i].triangle_count)
            continue;
        json_open(j, NULL, '{');
        json_string(j, "name", name[i]);
        json_open(j, "pbrMetallicRoughness", '{');
        if (i == GROUP_SKIN && c->about->texture)
            put_texture(j);
        json_number(j, "metallicFactor", 0);
        json_number(j, "roughnessFactor", (double)(0.75f - 0.6f * c->mesh.group[i].gloss));
        json_close(j, '}');
        if (i == GROUP_LASHES)
            json_bool(j, "doubleSided", 1);
        json_close(j, '}');
    }
    json_close(j, ']');
}

static void put_sampler(content *c, int output)
{
    json_open(&c->json, NULL, '{');
    json_integer(&c->json, "input", c->time);
    json_integer(&c->json, "output", output);
    json_close(&c->json, '}');
}

static void put_channel(content *c, int sampler, int node, const char *path)
{
    json *j = &c->json;

    json_open(j, NULL, '{');
    json_integer(j, "sampler", sampler);
    json_open(j, "target", '{');
    json_integer(j, "node", node);
    json_string(j, "path", path);
    json_close(j, '}');
    json_close(j, '}');
}

static void put_animation(content *c)
{
    json *j = &c->json;
    int sampler = 0;

    json_open(j, "animations", '[');
    json_open(j, NULL, '{');
    json_string(j, "name", "performance");
    json_open(j, "samplers", '[');
    put_sampler(c, c->weights);
    for (int i = 0; i < JOINT_COUNT; i++) {
        if (c->turn[i] >= 0)
            put_sampler(c, c->turn[i]);
        if (c->move[i] >= 0)
            put_sampler(c, c->move[i]);
    }
    json_close(j, ']');
    json_open(j, "channels", '[');
    put_channel(c, sampler++, 0, "weights");
    for (int i = 0; i < JOINT_COUNT; i++) {
        if (c->turn[i] >= 0)
            put_channel(c, sampler++, 1 + c->number[i], "rotation");
        if (c->move[i] >= 0)
            put_channel(c, sampler++, 1 + c->number[i], "translation");
    }
    json_close(j, ']');
    json_close(j, '}');
    json_close(j, ']');
}

static void put_asset(content *c)
{
    json *j = &c->json;

    json_open(j, "asset", '{');
    json_string(j, "version", "2.0");
    json_string(j, "generator", c->about->generator);
    json_open(j, "extras", '{');
    json_number(j, "worst_error_mm", c->about->worst_mm);
    json_number(j, "rms_error_mm", c->about->rms_mm);
    json_close(j, '}');
    json_close(j, '}');
}

static void put_all(content *c)
{
    json_open(&c->json, NULL, '{');
    put_asset(c);
    put_nodes(c);
    put_mesh(c);
    put_materials(c);
    if (c->about->texture)
        put_images(c);
    put_animation(c);
    glb_put_json(&c->file, &c->json);
    json_close(&c->json, '}');
}

int glb_write_face(const glb_rig *rig, const glb_shape *shape, const glb_track *track, const glb_about *about,
                   FILE *out)
{
    content c = { .rig = rig, .shape = shape, .track = track, .about = about };
    char *text = NULL;
    size_t size = 0;

    number_joints(&c);
    int ok = glb_mesh_open(&c.mesh, &c.file, rig, shape, c.number, about->texture != NULL);
    add_bind(&c);
    add_animation(&c);
    if (about->texture)
        glb_add_bytes(&c.file, SECTION_IMAGE, about->texture, about->texture_size);
    c.json.out = ok && !c.file.failed ? open_memstream(&text, &size) : NULL;
    if (c.json.out) {
        put_all(&c);
        ok = !fclose(c.json.out) && glb_write(&c.file, text, size, out);
    } else {
        ok = 0;
    }
    free(text);
    glb_mesh_close(&c.mesh);
    glb_file_close(&c.file);
    return ok;
}
