/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * ICT-FaceKit as a databank and as the truth about faces that are not in it: the generic neutral head, scaled so that
 * chin to hair line is 190 mm, and its unit shapes. Read from ../shared/data/faces/ict, never copied.
 */
#ifndef TESTS_BENCH_ICT_H
#define TESTS_BENCH_ICT_H

#include <fap/bank.h>

enum {
    ICT_FACE_VERTICES = 9409 /* of the narrow face, the model's first */,
    ICT_UNITS_MAX = 64,
    ICT_MODELS = 20,
    ICT_PARTS = 6
};

/* A face that the bank does not hold: shapes and how much of each. */
typedef struct ict_model {
    int count, unit[ICT_PARTS];
    float weight[ICT_PARTS];
} ict_model;

typedef struct ict {
    fap_bank *bank; /* vertices in its own order */
    uint32_t vertex_count, stride;
    int unit_count;
    char name[ICT_UNITS_MAX][32];
    uint8_t in_bank[ICT_UNITS_MAX];
    float (*delta[ICT_UNITS_MAX])[3]; /* [vertex_count], bank order, millimetres */
    uint8_t *face;                    /* [vertex_count]: skin of the face that some shape moves */
    double mm_per_unit;
} ict;

/* 0: not there. Close in either case. */
int ict_open(ict *face);
void ict_close(ict *face);
/* The number the model's own file gives a vertex of the bank. */
uint32_t ict_original(const ict *face, uint32_t vertex);
/* One of ICT_MODELS held-out faces: the same each time. */
void ict_model_get(const ict *face, int number, ict_model *model);
/* Motion of every vertex, bank order. */
void ict_truth(const ict *face, const ict_model *model, float (*motion)[3]);

#endif
