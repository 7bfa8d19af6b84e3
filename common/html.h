/* SPDX-License-Identifier: BSD-2-Clause */
/* Text that comes from outside, in pages that we write. */
#ifndef COMMON_HTML_H
#define COMMON_HTML_H

#include <stdio.h>

/* Between tags and in quoted attributes. */
void html_text(FILE *out, const char *text);
/* A relative address of a file, for quoted attributes: percent signs for all that is more than letters, digits and -._/ */
void html_path(FILE *out, const char *path);

#endif
