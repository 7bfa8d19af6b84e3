/* SPDX-License-Identifier: BSD-2-Clause */
/* Pictures in memory: PNG files, comparison, labels, contact sheets. Pixels are sRGB RGBA, 8 bits, top row first. */
#ifndef PLAYER_RENDER_IMAGE_H
#define PLAYER_RENDER_IMAGE_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <fap/error.h>

typedef struct image {
    int width, height;
    uint8_t *rgba;   /* [height][width][4] */
    int transparent; /* alpha is part of the picture: files keep it; 0 after image_create() */
} image;

/* Zeroed pixels. FAP_E_LIMIT past 16384 pixels a side. */
fap_err image_create(image *im, int width, int height);
void image_free(image *im);

/* PNG through libpng; FAP_E_UNSUPPORTED in a build without it. @level: 0..9, 1 for sequences, 6 for keeping. */
fap_err image_write_png(const image *im, FILE *out, int level);
fap_err image_read_png(image *im, const char *path);

/* How far two pictures of one size are apart. */
typedef struct image_difference {
    int worst;        /* largest difference of any channel */
    double structure; /* as image_structure() says */
    size_t far_count; /* pixels with a channel further apart than the tolerance */
    size_t pixel_count;
} image_difference;

/* FAP_E_DATA: sizes differ. @diff may be NULL; else it becomes a picture of the differences. */
fap_err image_compare(const image *a, const image *b, int tolerance, image_difference *d, image *diff);
/* How alike shapes are where they are least alike, whatever the light: 1 the same, 0 nothing alike. Pictures of one size. */
double image_structure(const image *a, const image *b);
/* The measured rule for software GL: at most 0.05 % of the pixels may be further apart than the tolerance; and shapes are the
 * same, which noise of 2 of 255 everywhere leaves them. */
int image_same(const image_difference *d);

/* Copies @src into @dst with its top left corner at (x, y), cut at the border. */
void image_blit(image *dst, const image *src, int x, int y);
/* Writes ASCII text, 6 * scale pixels a letter and 7 * scale high, top left corner at (x, y), in @rgb. */
void image_text(image *dst, int x, int y, int scale, const uint8_t rgb[3], const char *text);
/* Size in cells of a sheet for @count pictures, as square as it looks good: columns >= rows. */
void image_sheet_grid(int count, int *columns, int *rows);

#endif
