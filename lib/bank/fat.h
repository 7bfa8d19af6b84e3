/* SPDX-License-Identifier: BSD-2-Clause */
/* The inside of face animation tables, shared by posing, baking and the file. */
#ifndef LIB_BANK_FAT_H
#define LIB_BANK_FAT_H

#include <fap/alloc.h>
#include <fap/fat.h>

enum {
    FAT_BORDERS_MAX = 9, /* of one FAP: eight intervals */
    FAT_TABLES_MAX = 256,
    FAT_TURNS_MAX = 16,
    FAT_VERTICES_MAX = 1 << 20,
    FAT_TRIANGLES_MAX = 1 << 22,
    FAT_FOLLOW_MAX = 256,
};

/* FaceDefMesh: what one FAP, or one viseme or expression, does. */
typedef struct fat_table {
    uint8_t fap;
    uint8_t select;                  /* highLevelSelect: which viseme or expression, else 0 */
    uint8_t border_count;            /* at least 2 */
    int32_t border[FAT_BORDERS_MAX]; /* intervalBorders: ascending, 0 among them */
    float scale_mm;                  /* of one step of a displacement */
    uint32_t vertex_count;
    uint32_t *vertex;    /* coordIndex */
    int16_t (*slope)[3]; /* displacements: [border_count - 1][vertex_count], steps for one unit of the FAP */
} fat_table;

/* FaceDefTransform: vertices that turn about an axis. */
typedef struct fat_turn {
    uint8_t fap, axis;       /* 0 x, 1 y, 2 z */
    float pivot[3], radians; /* for one unit of the FAP */
    uint32_t vertex_count;
    uint32_t *vertex;
    uint8_t *share; /* 255: all of the angle */
} fat_turn;

/* An absent FAP moves along with one that is there; of several leaders the first in the list. */
typedef struct fat_follow {
    uint8_t fap, leader;
    int16_t share_1024;
} fat_follow;

struct fap_fat {
    fap_allocator alloc;
    uint32_t vertex_count, triangle_count;
    float (*neutral)[3];
    uint32_t *triangle; /* [triangle_count][3] */
    uint32_t table_count, turn_count, follow_count;
    fat_table table[FAT_TABLES_MAX];
    fat_turn turn[FAT_TURNS_MAX]; /* in the order in which they are done */
    fat_follow follow[FAT_FOLLOW_MAX];
};

fap_fat *fat_new(const fap_allocator *alloc);
/* Arrays of vertex_count; 0: no memory. */
int fat_table_open(const fap_fat *fat, fat_table *t);
int fat_turn_open(const fap_fat *fat, fat_turn *t);
/* Of what FAPs 3 to 68 say, the part that is no turning, added to @p position [vertex count][3]. */
void fat_add_low_level(const fap_fat *fat, const fap_frame *frame, float (*position)[3]);
/* 1: a FAP of the lips is given, so visemes give way. */
int fat_gives_mouth(const fap_frame *f);
/* 1: one of mouth, lids, brows or cheeks is given, so expressions give way. */
int fat_gives_expression(const fap_frame *f);

#endif
