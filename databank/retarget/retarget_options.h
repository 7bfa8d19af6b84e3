/* SPDX-License-Identifier: BSD-2-Clause */
/* The command line of fapbank retarget. */
#ifndef DATABANK_RETARGET_RETARGET_OPTIONS_H
#define DATABANK_RETARGET_RETARGET_OPTIONS_H

typedef struct retarget_options {
    const char *bank, *output;
    const char *to;               /* another face of the bank's structure; NULL: not that */
    const char *from, *landmarks; /* shapes of another structure, and where the face is on them */
    double mm_per_unit;           /* of --from; 0: found */
    const char *pictures;         /* a folder; NULL: none */
    int json;
    int exit_status; /* when parsing says to stop */
} retarget_options;

/* 0: stop with opt->exit_status; help or what is wrong has been printed. */
int retarget_options_parse(retarget_options *opt, int argc, char **argv);

#endif
