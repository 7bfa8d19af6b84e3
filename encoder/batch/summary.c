/* SPDX-License-Identifier: BSD-2-Clause */
/* See summary.h. */
#include <stdio.h>
#include <string.h>

#include "common/file.h"
#include "common/html.h"
#include "common/json.h"
#include "encoder/batch/summary.h"

static int has_status(const result *r, const char *status)
{
    return !strcmp(r->value[RESULT_status], status);
}

static int has_failed(const result *r)
{
    return has_status(r, result_failed) || has_status(r, result_ended);
}

void summary_count(summary *s)
{
    s->encoded = s->failed = s->no_take = 0;
    for (size_t i = 0; i < s->count; i++) {
        s->encoded += (size_t)has_status(&s->row[i], result_encoded);
        s->failed += (size_t)has_failed(&s->row[i]);
        s->no_take += (size_t)has_status(&s->row[i], result_no_take);
    }
}

/* --- CSV (RFC 4180) --- */

static void put_cell(FILE *out, const char *text)
{
    if (!strpbrk(text, ",\"\r\n")) {
        fputs(text, out);
        return;
    }
    fputc('"', out);
    for (; *text; text++)
        fprintf(out, *text == '"' ? "\"\"" : "%c", *text);
    fputc('"', out);
}

int summary_write_csv(const summary *s, const char *path)
{
    out_file f;

    if (out_file_open(&f, path) != FAP_OK)
        return 0;
    for (int c = 0; c < RESULT_COLUMN_COUNT; c++)
        fprintf(f.stream, "%s%s", c ? "," : "", result_field_name((result_field)c));
    for (size_t i = 0; i < s->count; i++)
        for (int c = 0; c < RESULT_COLUMN_COUNT; c++) {
            fputs(c ? "," : "\n", f.stream);
            put_cell(f.stream, s->row[i].value[c]);
        }
    fputc('\n', f.stream);
    return out_file_commit(&f) == FAP_OK;
}

/* --- HTML --- */

static const char head[] =
    "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
    "<meta name=\"viewport\" content=\"width=device-width\">\n<title>fapenc batch</title>\n<style>\n"
    "body { font: 14px/1.45 system-ui, sans-serif; margin: 2em auto; max-width: 1500px; padding: 0 1em; "
    "color: "
    "#222; background: #f6f6f7 }\n"
    "h1 { font-size: 1.3em } h2 { font-size: 1.1em; margin-top: 1.6em } .wide { overflow-x: auto }\n"
    "table { border-collapse: collapse; background: #fff; border: 1px solid #ddd; white-space: nowrap }\n"
    "th, td { padding: .3em .7em; text-align: right; border-bottom: 1px solid #eee }\n"
    "th:first-child, td:first-child { text-align: left }\n"
    ".reasons { white-space: normal } .reasons td { text-align: left; vertical-align: top }\n"
    "details { background: #fff; border: 1px solid #ddd; border-radius: 6px; margin: .6em 0; padding: .5em "
    "1em "
    "}\n"
    "summary { cursor: pointer } details img { width: 100%; max-width: 1400px; display: block; margin-top: "
    ".5em "
    "}\n"
    "</style></head><body>\n";

static void put_row(FILE *out, const result *r)
{
    fputs("<tr>", out);
    for (int c = 0; c < RESULT_error; c++) {
        if (c == RESULT_status)
            continue;
        fputs("<td>", out);
        if (c == RESULT_output) {
            fputs("<a href=\"", out);
            html_path(out, r->value[c]);
            fputs("\">", out);
        }
        html_text(out, r->value[c]);
        fputs(c == RESULT_output ? "</a></td>" : "</td>", out);
    }
    fputs("</tr>\n", out);
}

static void put_encoded(FILE *out, const summary *s)
{
    fputs("<div class=\"wide\"><table><thead><tr>", out);
    for (int c = 0; c < RESULT_error; c++)
        if (c != RESULT_status)
            fprintf(out, "<th>%s</th>", result_heading((result_field)c));
    fputs("</tr></thead><tbody>\n", out);
    for (size_t i = 0; i < s->count; i++)
        if (has_status(&s->row[i], result_encoded))
            put_row(out, &s->row[i]);
    fputs("</tbody></table></div>\n", out);
}

static int is_no_take(const result *r)
{
    return has_status(r, result_no_take);
}

/* Takes and the reasons why nothing came of them. */
static void put_reasons(FILE *out, const summary *s, int (*wanted)(const result *r), const char *title)
{
    fprintf(out, "<h2>%s</h2>\n<table class=\"reasons\">\n", title);
    for (size_t i = 0; i < s->count; i++) {
        if (!wanted(&s->row[i]))
            continue;
        fputs("<tr><td>", out);
        html_text(out, s->row[i].value[RESULT_take]);
        fputs("</td><td>", out);
        html_text(out, s->row[i].value[RESULT_error]);
        fputs("</td></tr>\n", out);
    }
    fputs("</table>\n", out);
}

/* The same name with another ending. */
static void put_sibling(FILE *out, const result *r, const char *ending)
{
    char path[RESULT_VALUE_SIZE + 8];
    const char *const output = r->value[RESULT_output], *const dot = strrchr(output, '.');

    snprintf(path, sizeof path, "%.*s%s", (int)(dot ? dot - output : 0), output, ending);
    html_path(out, path);
}

/* Opened curves are few, takes may be many: pictures are loaded when they are looked at. */
static void put_curves(FILE *out, const result *r, int open)
{
    fprintf(out, "<details%s><summary>", open ? " open" : "");
    html_text(out, r->value[RESULT_take]);
    fprintf(out, " · %s s · <a href=\"", r->value[RESULT_length_s]);
    put_sibling(out, r, ".json");
    fputs("\">report</a></summary>\n<img loading=\"lazy\" alt=\"FAP curves\" src=\"", out);
    put_sibling(out, r, ".svg");
    fputs("\"></details>\n", out);
}

int summary_write_html(const summary *s, const char *path, const char *batch)
{
    enum { OPEN = 3 };
    out_file f;
    size_t shown = 0;

    if (out_file_open(&f, path) != FAP_OK)
        return 0;
    fputs(head, f.stream);
    fputs("<h1>", f.stream);
    html_text(f.stream, batch);
    fprintf(
        f.stream,
        "</h1>\n<p>%zu encoded, %zu failed, %zu no takes. The same as <a href=\"summary.csv\">CSV</a>.</p>\n",
        s->encoded, s->failed, s->no_take);
    if (s->failed)
        put_reasons(f.stream, s, has_failed, "Failed");
    fputs("<h2>Encoded</h2>\n", f.stream);
    put_encoded(f.stream, s);
    for (size_t i = 0; i < s->count; i++)
        if (has_status(&s->row[i], result_encoded))
            put_curves(f.stream, &s->row[i], shown++ < OPEN);
    if (s->no_take)
        put_reasons(f.stream, s, is_no_take, "No takes");
    fputs("</body></html>\n", f.stream);
    return out_file_commit(&f) == FAP_OK;
}

/* --- JSON --- */

void summary_print_json(const summary *s)
{
    json j = { .out = stdout };

    json_open(&j, NULL, '{');
    json_integer(&j, "encoded", (int64_t)s->encoded);
    json_integer(&j, "failed", (int64_t)s->failed);
    json_integer(&j, "no_take", (int64_t)s->no_take);
    json_open(&j, "takes", '[');
    for (size_t i = 0; i < s->count; i++) {
        json_open(&j, NULL, '{');
        for (int c = 0; c < RESULT_COLUMN_COUNT; c++)
            if (*s->row[i].value[c])
                json_string(&j, result_field_name((result_field)c), s->row[i].value[c]);
        json_close(&j, '}');
    }
    json_close(&j, ']');
    json_close(&j, '}');
    putchar('\n');
}
