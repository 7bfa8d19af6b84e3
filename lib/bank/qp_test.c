/* SPDX-License-Identifier: BSD-2-Clause */
/* The bounded least-squares solver: conditions of optimality, and steadiness. */
#include "tests/test.h"

#include <math.h>

#include "bank/qp.h"
#include "base/mem.h"

enum { ROWS = 20, N = 30 };

typedef struct problem {
    fap_allocator alloc;
    fap_qp qp;
    double a[ROWS][N], t[ROWS];
} problem;

static double noise(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return (double)(*seed >> 8) / (1 << 23) - 1;
}

static void make(problem *p, uint32_t seed)
{
    p->alloc = fap_mem_allocator(NULL);
    assert_int_equal(fap_qp_open(&p->qp, N + 3, &p->alloc), 0);
    for (int r = 0; r < ROWS; r++) {
        p->t[r] = 3 * noise(&seed);
        for (int i = 0; i < N; i++)
            p->a[r][i] = noise(&seed);
    }
}

static void solve(problem *p, double ridge)
{
    fap_qp *qp = &p->qp;

    fap_qp_clear(qp, N);
    for (int i = 0; i < N; i++) {
        qp->hi[i] = 1.25;
        for (int r = 0; r < ROWS; r++)
            qp->linear[i] += p->a[r][i] * p->t[r];
        for (int j = 0; j < N; j++) {
            double *g = &qp->gram[i * qp->capacity + j];
            for (int r = 0; r < ROWS; r++)
                *g += p->a[r][i] * p->a[r][j];
            *g += i == j ? ridge : 0;
        }
    }
    fap_qp_solve(qp);
}

/* Inside the box the gradient is zero; at a bound it points out of the box. */
static void check_optimal(const fap_qp *qp)
{
    for (int i = 0; i < qp->n; i++) {
        double slope = -qp->linear[i];
        for (int j = 0; j < qp->n; j++)
            slope += qp->gram[i * qp->capacity + j] * qp->x[j];
        assert_true(qp->x[i] >= qp->lo[i] && qp->x[i] <= qp->hi[i]);
        if (qp->x[i] > qp->lo[i])
            assert_true(slope < 1e-7);
        if (qp->x[i] < qp->hi[i])
            assert_true(slope > -1e-7);
    }
}

TEST(qp, meets_the_conditions_of_optimality)
{
    for (uint32_t seed = 1; seed <= 100; seed++) {
        problem p;
        make(&p, seed);
        solve(&p, 1e-3);
        check_optimal(&p.qp);
        fap_qp_close(&p.qp, &p.alloc);
    }
}

TEST(qp, moves_little_when_the_target_moves_little)
{
    problem p;
    double before[N];

    make(&p, 7);
    for (int k = 0; k < 200; k++) {
        solve(&p, 0.05);
        for (int i = 0; i < N; i++) {
            if (k)
                assert_true(fabs(p.qp.x[i] - before[i]) < 0.02);
            before[i] = p.qp.x[i];
        }
        p.t[k % ROWS] += 0.002;
    }
    fap_qp_close(&p.qp, &p.alloc);
}

TEST(qp, finds_weights_that_made_the_target)
{
    problem p;
    uint32_t seed = 5;
    double w[12];

    make(&p, 3);
    for (int i = 0; i < 12; i++)
        w[i] = 0.6 + 0.5 * noise(&seed);
    for (int r = 0; r < ROWS; r++) {
        p.t[r] = 0;
        for (int i = 0; i < N; i++)
            p.a[r][i] *= i < 12;
        for (int i = 0; i < 12; i++)
            p.t[r] += p.a[r][i] * w[i];
    }
    solve(&p, 1e-9);
    for (int i = 0; i < N; i++)
        assert_float_equal(p.qp.x[i], i < 12 ? w[i] : 0, 1e-6);
    fap_qp_close(&p.qp, &p.alloc);
}

TEST(qp, a_variable_without_room_stays_put)
{
    problem p;

    make(&p, 4);
    solve(&p, 1e-3);
    p.qp.lo[2] = p.qp.hi[2] = 0.5;
    fap_qp_solve(&p.qp);
    assert_true(p.qp.x[2] == 0.5);
    check_optimal(&p.qp);
    fap_qp_close(&p.qp, &p.alloc);
}
