/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The triangulation is ours: feature points of the left half from the hair line to the chin, lips and lids parted, nose
 * and cheeks between. Ear, hair line and jaw bone are its rim, which no FAP moves. Source for the idea of a control
 * surface over MPEG-4's points: Sanchez Lorenzo et al. 2003, sections 4 and 5.2.
 */
#include <string.h>

#include "bank/bones.h"

typedef struct triple {
    const char *corner[3];
} triple;

static const triple left[] = {
    /* forehead */
    { { "11.1", "11.3", "4.3" } },
    { { "11.1", "4.3", "4.1" } },
    { { "11.3", "4.5", "4.3" } },
    { { "11.3", "10.9", "4.5" } },
    /* brow to eye */
    { { "4.1", "4.3", "3.13" } },
    { { "4.3", "4.5", "3.13" } },
    { { "4.1", "3.13", "3.11" } },
    { { "4.5", "3.7", "3.13" } },
    { { "4.5", "10.9", "3.7" } },
    /* lids */
    { { "3.13", "3.7", "upper outer" } },
    { { "3.13", "upper outer", "3.1" } },
    { { "3.13", "3.1", "upper inner" } },
    { { "3.13", "upper inner", "3.11" } },
    { { "lower outer", "3.7", "3.9" } },
    { { "3.3", "lower outer", "3.9" } },
    { { "lower inner", "3.3", "3.9" } },
    { { "3.11", "lower inner", "3.9" } },
    /* nose */
    { { "4.1", "9.7", "3.11" } },
    { { "9.7", "9.13", "3.11" } },
    { { "9.7", "9.12", "9.13" } },
    { { "9.12", "9.3", "9.13" } },
    { { "9.13", "9.3", "9.1" } },
    { { "9.1", "9.3", "9.5" } },
    { { "9.5", "9.3", "9.15" } },
    /* cheek */
    { { "3.11", "9.13", "9.1" } },
    { { "3.11", "9.1", "5.3" } },
    { { "3.11", "5.3", "3.9" } },
    { { "3.9", "5.3", "3.7" } },
    { { "3.7", "5.3", "10.9" } },
    { { "5.3", "10.7", "10.9" } },
    { { "5.3", "5.1", "10.7" } },
    { { "5.1", "2.13", "10.7" } },
    { { "5.3", "9.1", "8.3" } },
    { { "5.3", "8.3", "5.1" } },
    /* nose to upper lip */
    { { "9.1", "8.5", "8.3" } },
    { { "9.1", "9.5", "8.5" } },
    { { "9.5", "8.10", "8.5" } },
    { { "9.5", "9.15", "8.10" } },
    { { "9.15", "8.1", "8.10" } },
    /* upper lip */
    { { "8.1", "2.2", "8.10" } },
    { { "8.10", "2.2", "2.6" } },
    { { "8.10", "2.6", "8.5" } },
    { { "8.5", "2.6", "8.3" } },
    { { "8.3", "2.6", "2.4" } },
    /* lower lip */
    { { "8.2", "8.7", "2.3" } },
    { { "2.3", "8.7", "2.8" } },
    { { "8.7", "8.3", "2.8" } },
    { { "8.3", "2.4", "2.8" } },
    /* chin and jaw */
    { { "8.2", "2.10", "8.7" } },
    { { "8.7", "2.10", "2.11" } },
    { { "8.7", "2.11", "8.3" } },
    { { "2.10", "2.1", "2.11" } },
    { { "5.1", "8.3", "2.11" } },
    { { "5.1", "2.11", "2.13" } },
    { { "2.1", "2.13", "2.11" } },
};

/* Across the middle; not mirrored. */
static const triple across[] = {
    { { "11.1", "4.1", "4.2" } },
    { { "4.1", "9.7", "4.2" } },
    { { "4.2", "9.7", "9.6" } },
    { { "9.6", "9.7", "9.12" } },
};

/* Sanchez Lorenzo et al. 2003, section 5.2, lets unseen markers go with the group they belong to; the shares are ours. */
static const struct {
    const char *point, *leader;
    float share;
} followers[] = {
    /* jaw: an open one takes the lower lip along */
    { "2.1", "2.10", 1 },
    { "2.10", "2.1", 1 },
    { "2.11", "2.1", 0.9f },
    { "2.3", "8.2", 1 },
    { "2.3", "2.1", 0.9f },
    { "8.2", "2.3", 1 },
    { "2.2", "8.1", 1 },
    { "8.1", "2.2", 1 },
    /* lips: the inner contour goes with the outer one and the other way round */
    { "2.4", "8.3", 1 },
    { "2.4", "2.3", 0.4f },
    { "8.3", "2.4", 1 },
    { "2.8", "8.7", 1 },
    { "2.8", "2.3", 0.8f },
    { "8.7", "2.8", 1 },
    { "2.6", "8.5", 1 },
    { "2.6", "2.2", 0.8f },
    { "8.5", "2.6", 1 },
    { "8.10", "8.1", 0.9f },
    /* what lies round them */
    { "5.1", "8.3", 0.5f },
    { "5.3", "5.1", 0.4f },
    { "3.13", "3.1", 0.7f },
    { "3.9", "3.3", 0.3f },
    { "9.5", "9.1", 0.5f },
    { "9.15", "9.3", 0.5f },
};

static const struct {
    const char *name, *middle, *end;
} hypothetical[FAP_BONE_HYPOTHETICAL / 2] = {
    { "upper outer", "3.1", "3.7" },
    { "upper inner", "3.1", "3.11" },
    { "lower outer", "3.3", "3.7" },
    { "lower inner", "3.3", "3.11" },
};

/* Of the left half first, in the order of the table. */
static int corner_by_name(const char *name)
{
    for (int i = 0; i < FAP_BONE_HYPOTHETICAL / 2; i++)
        if (!strcmp(hypothetical[i].name, name))
            return FAP_POINT_COUNT + i;
    return fap_point_by_name(name);
}

static int mirror(int corner)
{
    return corner < FAP_POINT_COUNT ? fap_point_get(corner)->mirror : corner + FAP_BONE_HYPOTHETICAL / 2;
}

void fap_bones_hypothetical(fap_bone_between out[FAP_BONE_HYPOTHETICAL])
{
    for (int i = 0; i < FAP_BONE_HYPOTHETICAL / 2; i++) {
        const int middle = fap_point_by_name(hypothetical[i].middle),
                  end = fap_point_by_name(hypothetical[i].end);
        out[i] = (fap_bone_between){ (uint8_t)middle, (uint8_t)end };
        out[i + FAP_BONE_HYPOTHETICAL / 2] =
            (fap_bone_between){ (uint8_t)mirror(middle), (uint8_t)mirror(end) };
    }
}

int fap_bone_opposite(int i)
{
    return i ^ 2; /* two upper ones, two lower ones, then the right half */
}

static int add_triple(uint8_t corner[FAP_BONES_MAX][3], int n, const triple *t, int mirrored)
{
    for (int i = 0; i < 3; i++) {
        const int p = corner_by_name(t->corner[i]);
        corner[n][i] = (uint8_t)(mirrored ? mirror(p) : p);
    }
    return n + 1;
}

int fap_bones_list(uint8_t corner[FAP_BONES_MAX][3])
{
    int n = 0;

    for (size_t i = 0; i < sizeof left / sizeof *left; i++) {
        n = add_triple(corner, n, &left[i], 0);
        n = add_triple(corner, n, &left[i], 1);
    }
    for (size_t i = 0; i < sizeof across / sizeof *across; i++)
        n = add_triple(corner, n, &across[i], 0);
    return n;
}

int fap_bones_followers(fap_bone_follower out[FAP_BONES_MAX])
{
    int n = 0;

    for (size_t i = 0; i < sizeof followers / sizeof *followers; i++) {
        const int p = fap_point_by_name(followers[i].point), leader = fap_point_by_name(followers[i].leader);
        out[n++] = (fap_bone_follower){ (uint8_t)p, (uint8_t)leader, followers[i].share };
        if (mirror(p) != p)
            out[n++] = (fap_bone_follower){ (uint8_t)mirror(p), (uint8_t)mirror(leader), followers[i].share };
    }
    return n;
}
