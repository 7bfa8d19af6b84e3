/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The .fap reader between its files: ascii_read.c (frames and time), ascii_header.c (the first lines),
 * ascii_values.c (mask and value lines). Parsers note errors and deviations in the reader and go on; callers
 * look at r->err.
 */
#ifndef LIB_CODEC_ASCII_READER_H
#define LIB_CODEC_ASCII_READER_H

#include <fap/ascii.h>
#include <fap/tables.h>

#include "codec/ascii_lines.h"
#include "codec/ascii_number.h"

enum {
    ASCII_VISEME_NUMBERS = 4,
    ASCII_EXPRESSION_NUMBERS = 6,
    ASCII_MAX_NUMBERS = 1 + ASCII_VISEME_NUMBERS + ASCII_EXPRESSION_NUMBERS + FAP_COUNT - 2 +
                        1, /* frame number, FAPs, a 69th column */
    ASCII_MASK_KEPT = 160, /* a mask line up to this length is recognised when it comes again */
};

/* Every deviation that is tolerated, in the words of the notice. */
#define ASCII_DEVIATIONS(X)                                                                                  \
    X(BYTE_ORDER_MARK, "a byte order mark stands before the text")                                           \
    X(LONE_CR, "lines end in CR alone")                                                                      \
    X(TABS, "tabs between the numbers")                                                                      \
    X(EMPTY_LINE, "an empty line was skipped")                                                               \
    X(NO_HEADER, "there is no header line: 25 frames a second are assumed")                                  \
    X(LONE_NUMBER, "a lone number before the first mask was skipped: a time in milliseconds")                \
    X(VERSION, "the version is none of 2.0, 2.1 and 2.2: read like 2.1")                                     \
    X(NAME, "the sequence name is not one word")                                                             \
    X(RATE, "the frame rate makes no sense: 25 frames a second are assumed")                                 \
    X(COUNT, "the header states another number of frames than the file has")                                 \
    X(NO_COUNT, "the number of frames in the header makes no sense: it is not used")                         \
    X(MASK_69, "the mask has 69 digits: the last one was ignored")                                           \
    X(NUMBERS, "frame numbers do not count up from 0 by 1")                                                  \
    X(MILLISECONDS, "frame numbers are times in milliseconds")                                               \
    X(ONE_VISEME, "FAP 1 has one value in place of four: viseme taken as absent")                            \
    X(ONE_EXPRESSION, "FAP 2 has one value in place of six: expression taken as absent")                     \
    X(PACKED_VISEME, "FAP 1 has one value with viseme and blend packed into it")                             \
    X(SELECT_RANGE, "viseme or expression number out of its range: taken as absent")                         \
    X(AMPLITUDE, "viseme or expression strength out of its range: brought to the nearest end")               \
    X(DECIMALS, "values with decimals were rounded")                                                         \
    X(NOT_FINITE, "values that are inf or nan: taken as absent")                                             \
    X(CUT, "the file ends inside a frame, which was dropped")

typedef enum ascii_deviation {
#define X(name, text) ASCII_##name,
    ASCII_DEVIATIONS(X)
#undef X
} ascii_deviation;

struct fap_ascii_reader {
    fap_allocator alloc;
    fap_ascii_reader_config cfg;
    fap_ascii_header header;
    uint32_t noticed; /* a bit for every deviation already told */
    fap_err err;      /* what next() keeps returning once something went wrong */
    char text[FAP_ERROR_TEXT_SIZE];

    char *line; /* the line being parsed, ended by '\n' */
    size_t length;
    int unread; /* the line was looked at, and is still to be used */

    char mask_line[ASCII_MASK_KEPT]; /* the mask as it was written: most frames repeat it */
    size_t mask_length;
    uint8_t has_viseme, has_expression, has_dummy;
    int fap_count, number_count;
    uint8_t fap[FAP_COUNT]; /* FAPs 3..68 whose digit is 1 */

    int32_t number[ASCII_MAX_NUMBERS]; /* the value line */
    int parsed;
    int odd; /* some number of the line is absent */
    uint8_t absent[ASCII_MAX_NUMBERS];

    int64_t frame_number; /* of the value line */
    int64_t header_line, count_column;
    int64_t frames, base_number, base_pts_us;
    double period_us;
    int in_ms;
    fap_frame frame;
    ascii_lines lines;
};

/*
 * Notes line, column and what was expected; @p at NULL: where the file ends. The first error stays. What is
 * wrong at the very end of a file with whole frames is its end: a deviation, and FAP_E_END.
 */
fap_err fap_ascii_fail(fap_ascii_reader *r, fap_err err, const char *at, const char *expected, ...)
    __attribute__((format(printf, 4, 5)));
/* A deviation at a place of the line at hand: told once, or fatal when strict. */
void fap_ascii_note(fap_ascii_reader *r, ascii_deviation which, const char *at);
/* The place of the first tab of the line at hand is a deviation. */
void fap_ascii_note_tabs(fap_ascii_reader *r);
/* The next line that is neither comment nor empty. FAP_E_END is not final: the caller knows what is missing.
 */
fap_err fap_ascii_next_line(fap_ascii_reader *r);

/* What stands in front of the first mask: a header, nothing, or a lone time. */
fap_err fap_ascii_read_header(fap_ascii_reader *r);
/* The line at hand is a mask: which FAPs the next value line has. */
fap_err fap_ascii_read_mask(fap_ascii_reader *r);
/* The line at hand is a value line: r->number[0] is its frame number, r->frame gets the FAPs. */
fap_err fap_ascii_read_values(fap_ascii_reader *r);

#endif
