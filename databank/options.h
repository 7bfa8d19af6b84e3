/* SPDX-License-Identifier: BSD-2-Clause */
/* fapbank's command line. */
#ifndef DATABANK_OPTIONS_H
#define DATABANK_OPTIONS_H

#include "databank/paint.h"
#include "databank/sheet.h"

typedef enum command { COMMAND_BUILD, COMMAND_INFO, COMMAND_RENDER, COMMAND_FAT, COMMAND_PCA } command;

typedef struct options {
    command command;
    const char *input;            /* recipe or bank */
    const char *output;           /* NULL where the command needs none */
    const char *landmarks, *like; /* of build from shapes; NULL: not said */
    double unit_mm;               /* the same; 0: not said */
    const char *pictures;         /* of build, a folder; NULL: none */
    int json;
    int components; /* of pca, at most */
    paint paint;    /* what render shows by colours */
    sheet_style sheet;
    int exit_status; /* when options_parse() says no */
} options;

/* 0: prints --help, --version or what is wrong, and sets exit_status. */
int options_parse(options *opt, int argc, char **argv);

#endif
