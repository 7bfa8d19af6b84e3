/* SPDX-License-Identifier: BSD-2-Clause */
/* The command line of fapenc. */
#ifndef ENCODER_OPTIONS_H
#define ENCODER_OPTIONS_H

#include <fap/encoder.h>
#include <fap/studio/capture.h>

#include "common/gpio/spec.h"
#include "encoder/neutral.h"

typedef enum command { COMMAND_ENCODE, COMMAND_INSPECT, COMMAND_BATCH, COMMAND_SPEECH } command;

/* What is said, and how it was recorded. */
typedef struct speech_options {
    const char *sound, *phonemes, *text; /* files, and words; NULL: not given */
    const char *language, *tier;
    int lips; /* FAPs of lips, jaw and tongue instead of FAP 1 */
} speech_options;

typedef struct options {
    command command;
    const char *input, *output; /* "-" is standard input, standard output */
    const char *markers_path, *fapu_path;
    double take_rate_hz; /* 0: as the file says */
    double mm_per_unit;  /* 0: as the file says */
    int rate_given;      /* --fps was there */
    neutral_option neutral;
    fap_capture_config capture;
    fap_encoder_config bits; /* how an .fba is coded; its rate is the frames' */
    const char *rate_option; /* which of --quant, --bitrate and --max-error was there; NULL: none */
    const char *bank_path;   /* the face that errors are measured on; NULL: find one; "builtin" */
    const char *fit_path, *learn_path;
    gpio_spec trigger;        /* the line whose edge is waited for; no chip: none */
    const char *plot_path;    /* NULL: no plot */
    int visemes, expressions; /* FAP 1, FAP 2 are to be found */
    speech_options speech;
    const char *batch_path; /* the folder whose takes are encoded; NULL: one take */
    int jobs;               /* takes at a time; 0: as many as there are processors */
    int to_given;
    int batch_bits;   /* .fba instead of .fap for each */
    char given[4096]; /* the options that change what is encoded, as they were given */
    int strict;
    int planes; /* inspect: a line each */
    int json;
    int exit_status; /* when parsing says to stop */
} options;

/* 0: stop with opt->exit_status; help, version or what is wrong has been printed. */
int options_parse(options *opt, int argc, char **argv);

/* 1: the output is an .fba, by its name. */
int options_want_bits(const options *opt);
/* 1: the output is a .csv of ARKit's coefficients, by its name. */
int options_want_livelink(const options *opt);

#endif
