/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Principal components of key models, found through the small matrix of their inner products. Components are
 * kept as weights of keys, so that a shape made of them is blended like any other. Source: Yano et al., section
 * 5.2, eq. 2.
 */
#ifndef LIB_BANK_PCA_H
#define LIB_BANK_PCA_H

#include <fap/bank.h>

typedef struct fap_pca {
    int model_count, component_count; /* components: those with any variance */
    int neutral;                      /* 1: the neutral face is model 0, keys follow */
    int *key;                         /* [model_count], bank index; -1 the neutral face */
    double *variance; /* [component_count], square millimetres over the whole surface, falling */
    double *
        mix; /* [component_count][model_count]: weight of each model in a component of one standard deviation */
    double
        *rest; /* [component_count]: coordinates of the neutral face, in standard deviations; 0 without it */
} fap_pca;

enum { FAP_PCA_MODELS = 128 };

/* The models a face is made of by components: its population, or all keys of a bank that has none. Fills @p key,
 * returns their number. The work grows with the cube of it. */
int fap_pca_population(const fap_bank *bank, int key[FAP_PCA_MODELS]);
/* @param key  bank indices of @p count models. Non-zero: no memory. Close in either case. */
int fap_pca_open(fap_pca *pca, const fap_bank *bank, const int *key, int count, int with_neutral,
                 const fap_allocator *alloc);
/* The components a bank has stored. Non-zero: no memory. Close in either case. */
int fap_pca_load(fap_pca *pca, const fap_basis *basis, const fap_allocator *alloc);
void fap_pca_close(fap_pca *pca, const fap_allocator *alloc);
/* Share of the variance in the first @p components, 0 to 1. */
double fap_pca_contribution(const fap_pca *pca, int components);

#endif
