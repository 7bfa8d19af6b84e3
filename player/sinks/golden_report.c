/* SPDX-License-Identifier: BSD-2-Clause */
/* See golden_report.h. */
#include <dirent.h>
#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/file.h"
#include "common/folder.h"
#include "common/html.h"
#include "common/tool.h"
#include "player/sinks/golden_report.h"
#include "player/sinks/picture_file.h"

enum { LEVEL_LEFT = 3, MOST_PICTURED = 300 };

/* --- names --- */

int golden_picture_name(char path[GOLDEN_PATH_SIZE], const char *folder, int64_t number, const char *kind,
                        fault *f)
{
    if (snprintf(path, GOLDEN_PATH_SIZE, "%s/%04" PRId64 "%s.png", folder, number, kind) < GOLDEN_PATH_SIZE)
        return 1;
    return fault_set(f, EXIT_DATA, "%s: the name is too long", folder);
}

int golden_make_folders(const char *path, fault *f)
{
    return folder_make(path) ? 1 : fault_set(f, EXIT_DATA, "%s: %s", path, strerror(errno));
}

/* A name that nobody has by chance: it is taken away again. */
const char golden_page_name[] = "golden-report.html";

static int is_ours(const char *name)
{
    static const char *const kinds[] = { ".golden.png", ".got.png", ".diff.png", ".side.png" };
    const size_t digits = strspn(name, "0123456789");

    for (size_t i = 0; digits >= 4 && i < sizeof kinds / sizeof *kinds; i++)
        if (!strcmp(name + digits, kinds[i]))
            return 1;
    return 0;
}

/* Pictures of the comparison before this one would be taken for its own. */
static void sweep(const char *folder)
{
    DIR *d = opendir(folder);
    const struct dirent *entry;
    char path[GOLDEN_PATH_SIZE + sizeof entry->d_name];

    while (d && (entry = readdir(d)))
        if (is_ours(entry->d_name) || !strcmp(entry->d_name, golden_page_name)) {
            snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
            unlink(path);
        }
    if (d)
        closedir(d);
}

int golden_report_open(golden_report *r, const char *folder)
{
    *r = (golden_report){ 0 };
    if (snprintf(r->folder, sizeof r->folder, "%s", folder) >= GOLDEN_PATH_SIZE - 64)
        return 0;
    sweep(folder);
    return 1;
}

void golden_report_close(golden_report *r)
{
    free(r->finding);
    *r = (golden_report){ 0 };
}

/* --- pictures --- */

static int write_picture(const golden_report *r, int64_t number, const char *kind, const image *im, fault *f)
{
    char path[GOLDEN_PATH_SIZE];

    return !im ||
           (golden_picture_name(path, r->folder, number, kind, f) && picture_write(im, path, LEVEL_LEFT, f));
}

/* What there is of golden, got and diff, from left to right. Too large for a picture: none. */
static int write_side(const golden_report *r, int64_t number, const image *const part[3], fault *f)
{
    image side;
    int width = 0, height = 0;

    for (int i = 0; i < 3; i++)
        if (part[i]) {
            width += part[i]->width;
            height = part[i]->height > height ? part[i]->height : height;
        }
    if (image_create(&side, width, height))
        return 1;
    for (int i = 0, x = 0; i < 3; i++)
        if (part[i]) {
            image_blit(&side, part[i], x, 0);
            x += part[i]->width;
        }
    const int ok = write_picture(r, number, ".side", &side, f);
    image_free(&side);
    return ok;
}

static int write_pictures(golden_report *r, int64_t number, const image *const part[3], fault *f)
{
    r->pictured++;
    return golden_make_folders(r->folder, f) && write_picture(r, number, ".golden", part[0], f) &&
           write_picture(r, number, ".got", part[1], f) && write_picture(r, number, ".diff", part[2], f) &&
           write_side(r, number, part, f);
}

static int make_room(golden_report *r)
{
    if (r->count < r->room)
        return 1;
    const int64_t room = r->room ? 2 * r->room : 64;
    golden_finding *finding = realloc(r->finding, (size_t)room * sizeof *finding);
    if (!finding)
        return 0;
    r->finding = finding;
    r->room = room;
    return 1;
}

int golden_report_add(golden_report *r, const golden_finding *finding, const image *golden, const image *got,
                      const image *diff, fault *f)
{
    const image *const part[3] = { golden, got, diff };

    if (!make_room(r))
        return fault_set(f, EXIT_DATA, "out of memory");
    golden_finding *kept = &r->finding[r->count++];
    *kept = *finding;
    kept->has_pictures = r->pictured < MOST_PICTURED;
    return !kept->has_pictures || write_pictures(r, finding->number, part, f);
}

/* --- the page --- */

static const char head[] =
    "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
    "<meta name=\"viewport\" content=\"width=device-width\">\n<title>Golden pictures</title>\n<style>\n"
    "body { font: 15px/1.45 system-ui, sans-serif; margin: 2em auto; max-width: 1100px; padding: 0 1em; "
    "color: #222; background: #f6f6f7 }\n"
    "h1 { font-size: 1.3em } .bad { color: #a4260f }\n"
    "section { background: #fff; border: 1px solid #ddd; border-radius: 6px; margin: 1em 0; padding: .8em "
    "1em }\n"
    "h2 { font-size: 1.05em; margin: 0 0 .5em } .row { display: flex; gap: .6em; flex-wrap: wrap }\n"
    "figure { margin: 0; flex: 0 1 calc(25% - .5em); min-width: 160px } figure img { width: 100%; display: "
    "block; "
    "background: #888 }\n"
    "figcaption { color: #666; font-size: .85em; padding-top: .2em }\n"
    ".flip { position: relative } .flip img + img { position: absolute; top: 0; left: 0; opacity: 0 }\n"
    ".flip:hover img + img { opacity: 1 }\n"
    "table { border-collapse: collapse } td { padding: .1em 1em .1em 0 }\n"
    "</style></head><body>\n";

static const char *const words[GOLDEN_VERDICT_COUNT] = {
    [GOLDEN_SAME] = "the same",
    [GOLDEN_DIFFERS] = "differs",
    [GOLDEN_OTHER_SIZE] = "the golden picture has another size",
    [GOLDEN_DAMAGED] = "the golden picture cannot be read",
    [GOLDEN_MISSING] = "there is no golden picture",
};

/* Without a comparison worst of all; then by structure, then by how many pixels. */
static int by_harm(const void *a, const void *b)
{
    const golden_finding *x = a, *y = b;

    if (x->verdict != y->verdict)
        return x->verdict > y->verdict ? -1 : 1;
    if (x->difference.structure != y->difference.structure)
        return x->difference.structure < y->difference.structure ? -1 : 1;
    if (x->difference.far_count != y->difference.far_count)
        return x->difference.far_count > y->difference.far_count ? -1 : 1;
    return x->number < y->number ? -1 : x->number > y->number;
}

static void put_numbers(FILE *out, const golden_finding *g)
{
    const image_difference *d = &g->difference;

    if (g->verdict != GOLDEN_DIFFERS) {
        fprintf(out, "<p class=\"bad\">%s</p>\n", words[g->verdict]);
        return;
    }
    fprintf(out,
            "<table><tr><td>furthest channel <b>%d</b> of 255</td><td>pixels beyond the tolerance <b>%zu</b> "
            "(%.3f %%)</td><td>structure <b>%.4f</b></td></tr></table>\n",
            d->worst, d->far_count, 100.0 * (double)d->far_count / (double)d->pixel_count, d->structure);
}

static void put_figure(FILE *out, int64_t number, const char *kind, const char *caption)
{
    fprintf(out,
            "<figure><a href=\"%04" PRId64 ".%s.png\"><img src=\"%04" PRId64
            ".%s.png\" alt=\"%s\"></a><figcaption>%s</figcaption></figure>\n",
            number, kind, number, kind, caption, caption);
}

/* Golden and got lie on each other: the mouse changes between them, and the eye sees what moves. */
static void put_figures(FILE *out, const golden_finding *g)
{
    const int64_t n = g->number;

    fputs("<div class=\"row\">\n", out);
    if (g->verdict == GOLDEN_DIFFERS || g->verdict == GOLDEN_OTHER_SIZE)
        put_figure(out, n, "golden", "golden");
    put_figure(out, n, "got", "got");
    if (g->verdict == GOLDEN_DIFFERS) {
        put_figure(out, n, "diff", "difference, 16 times; red: beyond the tolerance");
        fprintf(
            out,
            "<figure><div class=\"flip\"><img src=\"%04" PRId64
            ".golden.png\" alt=\"golden\"><img src=\"%04" PRId64
            ".got.png\" alt=\"got\"></div><figcaption>golden; got under the mouse</figcaption></figure>\n",
            n, n);
    }
    fputs("</div>\n", out);
}

static void put_finding(FILE *out, const golden_finding *g)
{
    fprintf(out, "<section><h2>Frame %" PRId64 ", %.3f s</h2>\n", g->number, g->time_s);
    put_numbers(out, g);
    if (g->has_pictures)
        put_figures(out, g);
    fputs("</section>\n", out);
}

static void put_page(FILE *out, const golden_report *r, const char *title, const char *advice,
                     int64_t compared)
{
    fputs(head, out);
    fputs("<h1>Golden pictures: ", out);
    html_text(out, title);
    fprintf(out, "</h1>\n<p><b class=\"bad\">%" PRId64 " of %" PRId64 " pictures differ.</b> ", r->count,
            compared);
    fprintf(out, "The worst come first. %s</p>\n", advice);
    if (r->count > r->pictured)
        fprintf(out, "<p>Pictures of the first %" PRId64 " are kept.</p>\n", r->pictured);
    for (int64_t i = 0; i < r->count; i++)
        put_finding(out, &r->finding[i]);
    fputs("</body></html>\n", out);
}

int golden_report_finish(golden_report *r, const char *title, const char *advice, int64_t compared, fault *f)
{
    char path[GOLDEN_PATH_SIZE + 32];
    out_file file;

    snprintf(path, sizeof path, "%s/%s", r->folder, golden_page_name);
    if (!r->count)
        return 1;
    qsort(r->finding, (size_t)r->count, sizeof *r->finding, by_harm);
    if (out_file_open(&file, path))
        return fault_set(f, EXIT_DATA, "%s: %s", path, strerror(errno));
    put_page(file.stream, r, title, advice, compared);
    if (!ferror(file.stream))
        return out_file_commit(&file) ? fault_set(f, EXIT_DATA, "%s: %s", path, strerror(errno)) : 1;
    out_file_abandon(&file);
    return fault_set(f, EXIT_DATA, "%s: %s", path, strerror(errno));
}
