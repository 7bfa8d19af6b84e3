/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * csv2c NAME.csv NAME OUT.h: turns one table of the standard into an X-macro list,
 *     #define NAME_ROWS(X) X(3, "open_jaw", ...) ...
 * which lib/param/tables.c expands into typed arrays. It runs on the build machine and stops the build at the first
 * bad cell. The first line that is not a # comment names the columns and their types:
 *     u8 i8 u16 i16   an integer within the type's range
 *     str             any text, written as a string literal
 *     sym             an identifier, written bare, for ## pasting
 *     point           a feature point "8.4", written POINT(8, 4), or NO_POINT where empty
 *     skip            a remark, left out
 */
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_LINE = 4096, MAX_COLUMNS = 32 };

static const char *path;
static int line_number;

static void die(int column, const char *what)
{
    fprintf(stderr, "%s:%d: column %d: %s\n", path, line_number, column + 1, what);
    exit(1);
}

/* Cuts a line into cells in place; a cell in double quotes may hold commas and doubled quotes. */
static int split(char *line, char **cell)
{
    int count = 0;
    char *in = line;

    for (;;) {
        if (count == MAX_COLUMNS)
            die(count, "too many columns");
        char *out = in;
        cell[count++] = out;
        if (*in == '"') {
            for (in++; *in && (*in != '"' || in[1] == '"'); in++)
                *out++ = *in == '"' ? *in++ : *in;
            if (*in++ != '"')
                die(count - 1, "quote is not closed");
        } else {
            while (*in && *in != ',')
                *out++ = *in++;
        }
        const char end = *in++;
        *out = '\0';
        if (end == '\0')
            return count;
        if (end != ',')
            die(count - 1, "text after a closing quote");
    }
}

static void put_integer(FILE *f, const char *cell, long min, long max, int column)
{
    char *end;
    const long v = strtol(cell, &end, 10);

    if (end == cell || *end || v < min || v > max)
        die(column, "not an integer within the column's type");
    fprintf(f, "%ld", v);
}

static void put_string(FILE *f, const char *cell)
{
    fputc('"', f);
    for (; *cell; cell++) {
        if (*cell == '"' || *cell == '\\')
            fputc('\\', f);
        fputc(*cell, f);
    }
    fputc('"', f);
}

static void put_symbol(FILE *f, const char *cell, int column)
{
    if (!isalpha((unsigned char)*cell))
        die(column, "not an identifier");
    for (const char *p = cell; *p; p++)
        if (!isalnum((unsigned char)*p) && *p != '_')
            die(column, "not an identifier");
    fputs(cell, f);
}

static void put_point(FILE *f, const char *cell, int column)
{
    unsigned group, index;
    char rest;

    if (!*cell) {
        fputs("NO_POINT", f);
        return;
    }
    if (sscanf(cell, "%u.%u%c", &group, &index, &rest) != 2)
        die(column, "not a feature point (8.4)");
    fprintf(f, "POINT(%u, %u)", group, index);
}

static void put_cell(FILE *f, const char *type, const char *cell, int column)
{
    if (!strcmp(type, "u8"))
        put_integer(f, cell, 0, 255, column);
    else if (!strcmp(type, "i8"))
        put_integer(f, cell, -128, 127, column);
    else if (!strcmp(type, "u16"))
        put_integer(f, cell, 0, 65535, column);
    else if (!strcmp(type, "i16"))
        put_integer(f, cell, -32768, 32767, column);
    else if (!strcmp(type, "str"))
        put_string(f, cell);
    else if (!strcmp(type, "sym"))
        put_symbol(f, cell, column);
    else if (!strcmp(type, "point"))
        put_point(f, cell, column);
    else
        die(column, "unknown column type");
}

static int read_line(FILE *f, char *line)
{
    while (fgets(line, MAX_LINE, f)) {
        line_number++;
        if (!strchr(line, '\n') && !feof(f))
            die(0, "line is too long");
        line[strcspn(line, "\r\n")] = '\0';
        if (*line && *line != '#')
            return 1;
    }
    return 0;
}

int main(int argc, char **argv)
{
    static char head[MAX_LINE], line[MAX_LINE];
    char *type[MAX_COLUMNS], *cell[MAX_COLUMNS];

    if (argc != 4) {
        fprintf(stderr, "usage: csv2c TABLE.csv NAME OUT.h\n");
        return 2;
    }
    path = argv[1];
    FILE *in = fopen(path, "r"), *out = fopen(argv[3], "w");
    if (!in || !out) {
        fprintf(stderr, "csv2c: cannot open %s\n", in ? argv[3] : path);
        return 1;
    }
    if (!read_line(in, head))
        die(0, "no column names");
    const int columns = split(head, type);
    for (int c = 0; c < columns; c++) {
        char *colon = strchr(type[c], ':');
        if (!colon)
            die(c, "column name without a type");
        type[c] = colon + 1;
    }

    fprintf(out, "/* made by csv2c from %s */\n#define ", path);
    for (const char *p = argv[2]; *p; p++)
        fputc(toupper((unsigned char)*p), out);
    fputs("_ROWS(X)", out);
    while (read_line(in, line)) {
        if (split(line, cell) != columns)
            die(0, "row has another number of columns than the head");
        fputs(" \\\n    X(", out);
        for (int c = 0, written = 0; c < columns; c++) {
            if (!strcmp(type[c], "skip"))
                continue;
            if (written++)
                fputs(", ", out);
            put_cell(out, type[c], cell[c], c);
        }
        fputc(')', out);
    }
    fputc('\n', out);
    fclose(in);
    return fclose(out) ? 1 : 0;
}
