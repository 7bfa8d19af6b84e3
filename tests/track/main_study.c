/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * mirror-study OUT: runs the noise study and writes OUT.csv, the numbers, and OUT.svg, the picture of docs/track.md. The axes are those
 * of Lin, Yeh, Ouhyoung 2001, fig. 6. Takes a minute.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "common/file.h"
#include "noise_study.h"

enum { TRIALS = 400, MAX_STEPS = 12, PANELS = 2, PATH_SIZE = 512 };

typedef struct panel {
    const char *title, *axis;
    int steps;
    double x[MAX_STEPS];
} panel;

typedef study_result results[PANELS][MAX_STEPS][STUDY_METHODS];

/* The paper's two pictures. */
static const panel panels[PANELS] = {
    { "30 calibration points",
      "variance of the noise, square pixels",
      8,
      { 0.05, 0.1, 0.25, 0.5, 1, 1.5, 2, 3 } },
    { "variance of the noise 1 square pixel",
      "calibration points",
      9,
      { 8, 10, 15, 20, 30, 50, 80, 120, 200 } },
};

static study_setting setting_of(int which, double x)
{
    return which ? (study_setting){ 1, (int)x, TRIALS } : (study_setting){ x, 30, TRIALS };
}

static int measure(results r)
{
    for (int p = 0; p < PANELS; p++)
        for (int i = 0; i < panels[p].steps; i++) {
            const study_setting s = setting_of(p, panels[p].x[i]);
            if (!study_run(&s, r[p][i]))
                return 0;
        }
    return 1;
}

/* --- numbers --- */

static void put_numbers(FILE *out, results all)
{
    fprintf(out, "# %d trials each; RMS of 50 points in mm, the object is 200 mm high and 480 pixels\n",
            TRIALS);
    fputs("variance_px2,points,method,median_mm,worst_tenth_mm,failed\n", out);
    for (int p = 0; p < PANELS; p++)
        for (int i = 0; i < panels[p].steps; i++) {
            const study_setting s = setting_of(p, panels[p].x[i]);
            for (int m = 0; m < STUDY_METHODS; m++) {
                const study_result *r = &all[p][i][m];
                fprintf(out, "%g,%d,%s,%.4g,%.4g,%d\n", s.variance_px2, s.points, study_method_name(m),
                        r->median_mm, r->tenth_mm, r->failed);
            }
        }
}

/* --- picture --- */

static const double left = 70, top = 60, wide = 380, high = 300, least_mm = 0.1, most_mm = 100;
static const char *const ink[STUDY_METHODS] = { "#c0392b", "#2e6da4", "#1d8348" };

static double across(const panel *p, int which, double x)
{
    const double a = log(p->x[0]), b = log(p->x[p->steps - 1]);

    return left + which * (wide + 110) + wide * (log(x) - a) / (b - a);
}

static double up(double mm)
{
    const double part = log(mm / least_mm) / log(most_mm / least_mm);

    return top + high * (1 - fmin(fmax(part, 0), 1));
}

static void put_text(FILE *out, double x, double y, const char *anchor, const char *text)
{
    fprintf(out, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\">%s</text>\n", x, y, anchor, text);
}

static void put_frame(FILE *out, const panel *p, int which)
{
    const double x0 = left + which * (wide + 110);
    char text[32];

    for (double mm = least_mm; mm <= most_mm * 1.01; mm *= 10) {
        fprintf(out, "<path d=\"M%.1f %.1fh%.1f\" stroke=\"#ddd\"/>\n", x0, up(mm), wide);
        snprintf(text, sizeof text, "%g", mm);
        put_text(out, x0 - 8, up(mm) + 4, "end", text);
    }
    for (int i = 0; i < p->steps; i++) {
        const double x = across(p, which, p->x[i]);
        fprintf(out, "<path d=\"M%.1f %.1fv5\" stroke=\"#444\"/>\n", x, top + high);
        snprintf(text, sizeof text, "%g", p->x[i]);
        put_text(out, x, top + high + 20, "middle", text);
    }
    fprintf(out,
            "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" fill=\"none\" stroke=\"#444\"/>\n",
            x0, top, wide, high);
    put_text(out, x0 + wide / 2, top - 12, "middle", p->title);
    put_text(out, x0 + wide / 2, top + high + 42, "middle", p->axis);
}

static void put_line(FILE *out, results all, int which, int method, int worst)
{
    const panel *p = &panels[which];

    fprintf(out, "<polyline fill=\"none\" stroke=\"%s\" stroke-width=\"%s\" points=\"", ink[method],
            worst ? "1.2\" stroke-dasharray=\"5 4" : "2.4");
    for (int i = 0; i < p->steps; i++) {
        const study_result *r = &all[which][i][method];
        fprintf(out, "%.1f,%.1f ", across(p, which, p->x[i]), up(worst ? r->tenth_mm : r->median_mm));
    }
    fputs("\"/>\n", out);
}

static void put_key(FILE *out)
{
    for (int m = 0; m < STUDY_METHODS; m++) {
        const double x = left + 230 * m, y = top + high + 68;
        fprintf(out, "<path d=\"M%.1f %.1fh28\" stroke=\"%s\" stroke-width=\"2.4\"/>\n", x, y, ink[m]);
        put_text(out, x + 36, y + 4, "start", study_method_name(m));
    }
    put_text(out, left + 690, top + high + 72, "start", "dashed: worst tenth");
}

static void put_picture(FILE *out, results all)
{
    fputs("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"980\" height=\"450\" viewBox=\"0 0 980 450\" "
          "font-family=\"sans-serif\" "
          "font-size=\"13\">\n"
          "<rect width=\"980\" height=\"450\" fill=\"#fff\"/>\n",
          out);
    put_text(out, 490, 24, "middle", "Error of places in mm (RMS), of an object 200 mm high");
    for (int i = 0; i < PANELS; i++) {
        put_frame(out, &panels[i], i);
        for (int m = 0; m < STUDY_METHODS; m++) {
            put_line(out, all, i, m, 1);
            put_line(out, all, i, m, 0);
        }
    }
    put_key(out);
    fputs("</svg>\n", out);
}

static int write_as(const char *out, const char *ending, void (*put)(FILE *, results), results all)
{
    char path[PATH_SIZE];
    out_file file;

    snprintf(path, sizeof path, "%s%s", out, ending);
    if (out_file_open(&file, path) != FAP_OK)
        return 0;
    put(file.stream, all);
    return out_file_commit(&file) == FAP_OK;
}

int main(int argc, char **argv)
{
    results all;

    if (argc != 2) {
        fprintf(stderr, "usage: mirror-study OUT\n");
        return 2;
    }
    return measure(all) && write_as(argv[1], ".csv", put_numbers, all) &&
                   write_as(argv[1], ".svg", put_picture, all)
               ? 0
               : 1;
}
