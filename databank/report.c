/* SPDX-License-Identifier: BSD-2-Clause */
/* See report.h. */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "common/json.h"
#include "common/tool.h"
#include "databank/observed.h"
#include "databank/report.h"

static const char *const kinds[] = { "viseme", "expression", "extra", "unit" };
static const char *const parts[] = { "skin",        "eye_left", "eye_right", "teeth_upper",
                                     "teeth_lower", "tongue",   "lashes" };

static const char *const masks[FAP_MASK_BITS] = { "lip_upper",      "lip_lower",       "lid_upper_left",
                                                  "lid_lower_left", "lid_upper_right", "lid_lower_right" };

typedef struct numbers {
    int key_count[4], point_count;
    uint32_t part_count[FAP_PART_COUNT], mask_count[FAP_MASK_BITS];
    size_t block_count; /* of all keys */
} numbers;

static numbers count(const fap_bank *bank)
{
    const fap_mesh *m = fap_bank_mesh(bank);
    numbers n = { 0 };

    for (int k = 0; k < fap_bank_key_count(bank); k++) {
        n.key_count[fap_bank_key_get(bank, k)->kind]++;
        n.block_count += fap_bank_key_get(bank, k)->block_count;
    }
    for (int p = 0; p < FAP_POINT_COUNT; p++)
        n.point_count += fap_bank_point_get(bank, p)->present;
    for (uint32_t v = 0; v < m->vertex_count; v++)
        n.part_count[m->part[v]]++;
    for (uint32_t i = 0; fap_bank_masks(bank) && i < m->vertex_count * FAP_MASK_BITS; i++)
        n.mask_count[i % FAP_MASK_BITS] += fap_bank_masks(bank)[i / FAP_MASK_BITS] >> i % FAP_MASK_BITS & 1;
    return n;
}

/* The farthest any vertex goes. */
static double reach_mm(const fap_key *key)
{
    int most = 0;

    for (size_t i = 0; i < (size_t)key->block_count * 3 * FAP_BLOCK; i++) {
        const int d = key->delta[i] < 0 ? -key->delta[i] : key->delta[i];
        most = d > most ? d : most;
    }
    return most * (double)key->scale_mm;
}

static void print_basis(const fap_basis *basis)
{
    const fap_component *c = &basis->component[basis->component_count - 1];

    printf("%d of %d models, %.2f %% of the variance", basis->component_count, basis->model_count,
           100 * (double)c->ratio);
}

/* What the file has beyond the face itself. */
static void print_maps(const fap_bank *bank, const numbers *n)
{
    const fap_region_lines *lines = fap_bank_regions(bank);

    printf("masks        ");
    for (int i = 0; fap_bank_masks(bank) && i < FAP_MASK_BITS; i++)
        printf("%s%s %u", i ? ", " : "", masks[i], n->mask_count[i]);
    puts(fap_bank_masks(bank) ? "" : "none");
    if (lines)
        printf("region map   borders at x %.1f, y %.1f; %.1f wide, %.1f high mm\n", (double)lines->middle[0],
               (double)lines->middle[1], (double)lines->extent[0], (double)lines->extent[1]);
    else
        puts("region map   none");
    printf("components   ");
    if (fap_bank_basis(bank))
        print_basis(fap_bank_basis(bank));
    puts(fap_bank_basis(bank) ? "" : "none");
}

static void print_components(const fap_bank *bank)
{
    const fap_basis *basis = fap_bank_basis(bank);

    for (int i = 0; basis && i < basis->component_count; i++)
        printf("  component %3d  sigma %8.2f mm  together %6.2f %%\n", i + 1,
               (double)basis->component[i].sigma_mm, 100 * (double)basis->component[i].ratio);
}

static void print_text(const report *rep, const numbers *n)
{
    const fap_mesh *m = fap_bank_mesh(rep->bank);
    const fap_fapu *u = fap_bank_fapu(rep->bank);

    printf("face         %s\n", fap_bank_name(rep->bank));
    printf("file         %zu bytes\n", rep->size);
    printf("vertices     %u", m->vertex_count);
    for (int p = 0; p < FAP_PART_COUNT; p++)
        if (n->part_count[p])
            printf(", %s %u", parts[p], n->part_count[p]);
    printf("\ntriangles    %u\n", m->triangle_count);
    printf("points       %d of %d\n", n->point_count, FAP_POINT_COUNT);
    printf("FAPU         IRISD0 %.2f  ES0 %.2f  ENS0 %.2f  MNS0 %.2f  MW0 %.2f mm\n", u->irisd_mm, u->es_mm,
           u->ens_mm, u->mns_mm, u->mw_mm);
    printf("key models   %d visemes, %d expressions, %d extras; %d units; %zu moving blocks\n",
           n->key_count[0], n->key_count[1], n->key_count[2], n->key_count[3], n->block_count);
    for (int k = 0; k < fap_bank_key_count(rep->bank); k++) {
        const fap_key *key = fap_bank_key_get(rep->bank, k);
        printf("  %-10s %-20s %6u blocks, up to %5.1f mm\n", kinds[key->kind], key->name, key->block_count,
               reach_mm(key));
    }
    print_maps(rep->bank, n);
    print_components(rep->bank);
    observed_print(rep->bank);
}

static void put_fapu(json *j, const fap_fapu *u)
{
    json_open(j, "fapu_mm", '{');
    json_number(j, "irisd", u->irisd_mm);
    json_number(j, "es", u->es_mm);
    json_number(j, "ens", u->ens_mm);
    json_number(j, "mns", u->mns_mm);
    json_number(j, "mw", u->mw_mm);
    json_close(j, '}');
}

static void put_keys(json *j, const fap_bank *bank)
{
    json_open(j, "keys", '[');
    for (int k = 0; k < fap_bank_key_count(bank); k++) {
        const fap_key *key = fap_bank_key_get(bank, k);
        json_open(j, NULL, '{');
        json_string(j, "kind", kinds[key->kind]);
        json_integer(j, "number", key->number);
        json_string(j, "name", key->name);
        json_integer(j, "blocks", key->block_count);
        json_number(j, "reach_mm", reach_mm(key));
        json_close(j, '}');
    }
    json_close(j, ']');
}

static void put_components(json *j, const fap_bank *bank)
{
    const fap_basis *basis = fap_bank_basis(bank);

    json_open(j, "components", '[');
    for (int i = 0; basis && i < basis->component_count; i++) {
        json_open(j, NULL, '{');
        json_number(j, "sigma_mm", basis->component[i].sigma_mm);
        json_number(j, "eigenvalue_mm2", pow((double)basis->component[i].sigma_mm, 2));
        json_number(j, "cumulative", basis->component[i].ratio);
        json_close(j, '}');
    }
    json_close(j, ']');
}

static void put_maps(json *j, const fap_bank *bank, const numbers *n)
{
    if (fap_bank_masks(bank)) {
        json_open(j, "masks", '{');
        for (int i = 0; i < FAP_MASK_BITS; i++)
            json_integer(j, masks[i], n->mask_count[i]);
        json_close(j, '}');
    }
    if (fap_bank_regions(bank)) {
        const fap_region_lines *lines = fap_bank_regions(bank);
        json_open(j, "regions", '{');
        json_number(j, "middle_x_mm", lines->middle[0]);
        json_number(j, "middle_y_mm", lines->middle[1]);
        json_number(j, "width_mm", lines->extent[0]);
        json_number(j, "height_mm", lines->extent[1]);
        json_close(j, '}');
    }
    put_components(j, bank);
}

static void note_scans(const recipe_outcome *o)
{
    if (o->scan_count)
        tool_note(
            "  scan              off it, mm  landmarks   seen  folded  head's rounds  goes, mm  masked");
    for (int i = 0; i < o->scan_count; i++) {
        const fap_expression_report *r = &o->scan[i].report;
        tool_note("  %-16s  %10.3f  %9.2f  %4.0f%%  %6u  %13u  %8.1f  %6u", o->scan[i].name,
                  r->fit.surface_rms_mm, r->fit.pin_rms_mm,
                  100.0 * r->fit.seen / (r->fit.skin ? r->fit.skin : 1), (unsigned)r->fit.folded,
                  (unsigned)r->icp_rounds, r->moves_mm, (unsigned)r->masked);
    }
}

static void put_scans(json *j, const recipe_outcome *o)
{
    if (!o->scan_count)
        return;
    json_open(j, "scans", '[');
    for (int i = 0; i < o->scan_count; i++) {
        const fap_expression_report *r = &o->scan[i].report;
        json_open(j, NULL, '{');
        json_string(j, "name", o->scan[i].name);
        json_number(j, "surface_rms_mm", r->fit.surface_rms_mm);
        json_integer(j, "skin_vertices", r->fit.skin);
        json_integer(j, "seen_vertices", r->fit.seen);
        json_integer(j, "folded_edges", r->fit.folded);
        json_integer(j, "icp_rounds", r->icp_rounds);
        json_number(j, "icp_before_mm", r->icp_before_mm);
        json_number(j, "icp_after_mm", r->icp_after_mm);
        json_integer(j, "masked_vertices", r->masked);
        json_number(j, "moves_mm", r->moves_mm);
        json_close(j, '}');
    }
    json_close(j, ']');
}

static void print_json(const report *rep, const options *opt, const numbers *n)
{
    json j = { .out = stdout };

    json_open(&j, NULL, '{');
    json_string(&j, "name", fap_bank_name(rep->bank));
    if (opt->output)
        json_string(&j, "output", opt->output);
    json_integer(&j, "bytes", (int64_t)rep->size);
    json_integer(&j, "vertices", fap_bank_mesh(rep->bank)->vertex_count);
    json_integer(&j, "triangles", fap_bank_mesh(rep->bank)->triangle_count);
    json_open(&j, "parts", '{');
    for (int p = 0; p < FAP_PART_COUNT; p++)
        json_integer(&j, parts[p], n->part_count[p]);
    json_close(&j, '}');
    json_integer(&j, "points", n->point_count);
    put_fapu(&j, fap_bank_fapu(rep->bank));
    put_keys(&j, rep->bank);
    put_maps(&j, rep->bank, n);
    observed_put(&j, rep->bank);
    put_scans(&j, &rep->recipe);
    json_close(&j, '}');
}

static void note_basis(const report *rep, const options *opt)
{
    const fap_basis *basis = fap_bank_basis(rep->bank);

    tool_note("%s: %s, %d components of %d models, %.2f %% of the variance, %zu bytes", opt->output,
              fap_bank_name(rep->bank), basis->component_count, basis->model_count,
              100 * (double)basis->component[basis->component_count - 1].ratio, rep->size);
    tool_note("  component  eigenvalue, mm2  contribution  cumulative");
    for (int i = 0; i < basis->component_count; i++) {
        const double sigma = (double)basis->component[i].sigma_mm,
                     before = i ? (double)basis->component[i - 1].ratio : 0;
        tool_note("  %9d  %15.1f  %12.4f  %10.4f", i + 1, sigma * sigma,
                  (double)basis->component[i].ratio - before, (double)basis->component[i].ratio);
    }
}

static void print_success(const report *rep, const options *opt)
{
    const numbers n = count(rep->bank);

    if (opt->json)
        print_json(rep, opt, &n);
    else if (opt->command == COMMAND_INFO)
        print_text(rep, &n);
    else if (opt->command == COMMAND_FAT && strcmp(opt->output, "-"))
        tool_note("%s: %s, %u vertices, %zu bytes", opt->output, fap_bank_name(rep->bank),
                  fap_bank_mesh(rep->bank)->vertex_count, rep->size);
    else if (opt->command == COMMAND_PCA && strcmp(opt->output, "-"))
        note_basis(rep, opt);
    else if (strcmp(opt->output, "-"))
        tool_note("%s: %s, %u vertices, %d key models", opt->output, fap_bank_name(rep->bank),
                  fap_bank_mesh(rep->bank)->vertex_count, fap_bank_key_count(rep->bank));
    if (opt->command == COMMAND_BUILD)
        note_scans(&rep->recipe);
}

static int print_failure(const report *rep, const options *opt, fap_err err)
{
    if (rep->missing) {
        tool_error("this fapbank was built without %s; install it (make setup) and build again",
                   rep->missing);
        return EXIT_MISSING;
    }
    if (err == FAP_E_UNSUPPORTED && opt->command == COMMAND_RENDER) {
        tool_error("cannot render: %s", rep->where);
        return EXIT_MISSING;
    }
    if (*rep->recipe.why) {
        tool_error("%s%s%s", rep->where, *rep->where ? ": " : "", rep->recipe.why);
        return err == FAP_E_UNSUPPORTED ? EXIT_MISSING : tool_exit_code(err);
    }
    tool_error("%s: %s", rep->where, err == FAP_E_IO && errno ? strerror(errno) : fap_strerror(err));
    return err == FAP_E_ARG ? EXIT_USAGE : EXIT_DATA;
}

int report_print(report *rep, const options *opt, fap_err err)
{
    const int status = err ? print_failure(rep, opt, err) : EXIT_OK;

    if (!err)
        print_success(rep, opt);
    fap_bank_close(&rep->bank);
    if (!err && fflush(stdout)) {
        tool_error("standard output: %s", strerror(errno));
        return EXIT_DATA;
    }
    return status;
}
