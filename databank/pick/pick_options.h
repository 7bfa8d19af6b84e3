/* SPDX-License-Identifier: BSD-2-Clause */
/* The command line of fapbank pick. */
#ifndef DATABANK_PICK_PICK_OPTIONS_H
#define DATABANK_PICK_PICK_OPTIONS_H

typedef struct pick_options {
    const char *scan, *output;
    const char *bank;      /* the generic face; NULL: the default face, else the built-in one; "builtin" */
    const char *landmarks; /* to begin with; NULL: none */
    int minor;             /* 1: feature points that followed are written too */
    int exit_status;       /* when parsing says to stop */
} pick_options;

/* 0: stop with opt->exit_status; help or what is wrong has been printed. */
int pick_options_parse(pick_options *opt, int argc, char **argv);

#endif
