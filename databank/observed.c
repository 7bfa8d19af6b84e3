/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * See observed.h. Two sets of keys, the units that solvers work with and the population of the genetic algorithm, each
 * seen along the axes that FAPs command and along all axes of all points.
 */
#include <stdio.h>

#include <fap/face.h>
#include <fap/studio/bank_observe.h>

#include "databank/observed.h"

enum { MOST_PAIRS = 8 };

typedef struct view {
    const char *name, *words;
    unsigned kinds;
    int faps_only;
} view;

static const view views[] = {
    { "units_faps", "units along FAP axes", 1u << FAP_KEY_UNIT, 1 },
    { "units_points", "units along all axes of all points", 1u << FAP_KEY_UNIT, 0 },
    { "models_faps", "visemes, expressions, extras along FAP axes",
      1u << FAP_KEY_VISEME | 1u << FAP_KEY_EXPRESSION | 1u << FAP_KEY_EXTRA, 1 },
    { "models_points", "visemes, expressions, extras along all axes of all points",
      1u << FAP_KEY_VISEME | 1u << FAP_KEY_EXPRESSION | 1u << FAP_KEY_EXTRA, 0 },
};
enum { VIEWS = sizeof views / sizeof *views };

/* Axes that some FAP commands. */
static void fap_axes(const fap_bank *bank, uint8_t seen[FAP_POINT_COUNT][3])
{
    float target_mm[FAP_POINT_COUNT][3];
    fap_frame all = { 0 };

    for (int fap = 1; fap <= FAP_COUNT; fap++)
        all.state[fap] = FAP_CODED;
    fap_face_targets(fap_bank_fapu(bank), &all, target_mm, seen);
}

/* NULL: no memory, or nothing to look at. */
static fap_observation *look(const fap_bank *bank, const view *v)
{
    uint8_t seen[FAP_POINT_COUNT][3];
    fap_observation *o;

    fap_axes(bank, seen);
    if (fap_bank_observe(&o, bank, v->kinds, v->faps_only ? (const uint8_t(*)[3])seen : NULL) != FAP_OK)
        return NULL;
    if (!o->key_count)
        fap_bank_observe_free(&o);
    return o;
}

static const char *key_name(const fap_bank *bank, int key)
{
    return fap_bank_key_get(bank, key)->name;
}

static void print_one(const fap_bank *bank, const view *v, const fap_observation *o)
{
    printf("observed     %d %s: %d axes see %d ways of moving, condition %.0f\n", o->key_count, v->words,
           o->row_count, o->rank, o->condition);
    for (int i = 0; i < o->unseen_count; i++)
        printf("%s%s%s", i ? ", " : "  not seen: ", key_name(bank, o->unseen[i]),
               i + 1 == o->unseen_count ? "\n" : "");
    for (int i = 0; i < o->alike_count && i < MOST_PAIRS; i++)
        printf("  alike: %s and %s (cosine %.3f)\n", key_name(bank, o->alike[i].key[0]),
               key_name(bank, o->alike[i].key[1]), (double)o->alike[i].cosine);
    if (o->alike_count > MOST_PAIRS)
        printf("  and %d pairs more; --json lists all\n", o->alike_count - MOST_PAIRS);
}

void observed_print(const fap_bank *bank)
{
    for (int i = 0; i < VIEWS; i++) {
        fap_observation *o = look(bank, &views[i]);
        if (o)
            print_one(bank, &views[i], o);
        fap_bank_observe_free(&o);
    }
}

static void put_alike(json *j, const fap_bank *bank, const fap_alike *a)
{
    json_open(j, NULL, '{');
    json_string(j, "a", key_name(bank, a->key[0]));
    json_string(j, "b", key_name(bank, a->key[1]));
    json_number(j, "cosine", (double)a->cosine);
    json_close(j, '}');
}

static void put_one(json *j, const fap_bank *bank, const view *v, const fap_observation *o)
{
    json_open(j, v->name, '{');
    json_integer(j, "keys", o->key_count);
    json_integer(j, "axes", o->row_count);
    json_integer(j, "rank", o->rank);
    json_number(j, "condition", o->condition);
    json_open(j, "unseen", '[');
    for (int i = 0; i < o->unseen_count; i++)
        json_string(j, NULL, key_name(bank, o->unseen[i]));
    json_close(j, ']');
    json_open(j, "alike", '[');
    for (int i = 0; i < o->alike_count; i++)
        put_alike(j, bank, &o->alike[i]);
    json_close(j, ']');
    json_close(j, '}');
}

void observed_put(json *j, const fap_bank *bank)
{
    json_open(j, "observed", '{');
    for (int i = 0; i < VIEWS; i++) {
        fap_observation *o = look(bank, &views[i]);
        if (o)
            put_one(j, bank, &views[i], o);
        fap_bank_observe_free(&o);
    }
    json_close(j, '}');
}
