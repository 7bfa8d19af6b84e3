/* SPDX-License-Identifier: BSD-2-Clause */
/* The command line of fapbank fit. */
#ifndef DATABANK_FIT_FIT_OPTIONS_H
#define DATABANK_FIT_FIT_OPTIONS_H

#include <fap/studio/registration.h>

typedef struct fit_options {
    const char *scan, *landmarks, *output;
    const char *bank;     /* the generic face; NULL: the default face, else the built-in one; "builtin" */
    const char *pictures; /* a folder; NULL: none */
    const char *gl;       /* how they are drawn; NULL: the first way that works */
    fap_registration_config fit;
    int minor;     /* 1: minor points follow the landmarks */
    int face_only; /* 1: without ears, top and back of the head */
    int json;
    int exit_status; /* when parsing says to stop */
} fit_options;

/* 0: stop with opt->exit_status; help or what is wrong has been printed. */
int fit_options_parse(fit_options *opt, int argc, char **argv);

#endif
