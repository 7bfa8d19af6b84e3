/* SPDX-License-Identifier: BSD-2-Clause */
/* The command line of fapbank masks. */
#ifndef DATABANK_MASKS_MASKS_OPTIONS_H
#define DATABANK_MASKS_MASKS_OPTIONS_H

#include <fap/studio/registration.h>

typedef struct masks_options {
    const char *face, *landmarks, *output;
    const char *bank;          /* whose masks; NULL: the default face, else the built-in one; "builtin" */
    const char *pictures, *gl; /* a folder, and how they are drawn; NULL: none, the first way that works */
    fap_registration_config fit;
    int json;
    int exit_status; /* when parsing says to stop */
} masks_options;

/* 0: stop with opt->exit_status; help or what is wrong has been printed. */
int masks_options_parse(masks_options *opt, int argc, char **argv);

#endif
