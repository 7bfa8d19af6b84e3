/* SPDX-License-Identifier: BSD-2-Clause */
/** @file
 * The ASCII .fap file, read and written a frame at a time in constant memory.
 * Source: ISO/IEC 14496-2 annexes on FAP files; the dialects of real producers in docs/fap-ascii.md.
 */
#ifndef FAP_ASCII_H
#define FAP_ASCII_H

#include <fap/alloc.h>
#include <fap/error.h>
#include <fap/frame.h>
#include <fap/io.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct fap_ascii_reader fap_ascii_reader;
typedef struct fap_ascii_writer fap_ascii_writer;

/** The header line; defaults where the file has none. */
typedef struct fap_ascii_header {
    char version[8];     /**< "2.1" */
    char name[128];      /**< sequence name, cut to fit */
    double rate_hz;      /**< 25 where the file does not say */
    int64_t frame_count; /**< as stated; -1: not stated, or senseless. The frames themselves decide */
    int present;         /**< 0: the file has no header */
} fap_ascii_header;

/** A tolerated deviation: told once per kind. @p line is where it was first met, from 1. @p text is static. */
typedef void (*fap_ascii_notice)(void *user, int64_t line, const char *text);

/** Options; start from fap_ascii_reader_config_init(). */
typedef struct fap_ascii_reader_config {
    size_t struct_size;      /**< sizeof of this struct, set by init */
    int strict;              /**< 0; 1: every deviation is an error */
    fap_ascii_notice notice; /**< NULL */
    void *notice_user;
    fap_allocator alloc;
} fap_ascii_reader_config;

/** Sets every default. */
FAP_API void fap_ascii_reader_config_init(fap_ascii_reader_config *cfg);

/**
 * @param in   copied; its user data must live until close
 * @param cfg  NULL: defaults
 * @return FAP_OK; FAP_E_SYNTAX not a .fap file; FAP_E_IO; FAP_E_NOMEM. On error *reader is NULL and @p where (may be
 *         NULL; FAP_ERROR_TEXT_SIZE bytes) says line, column and what was expected.
 */
FAP_API FAP_NODISCARD fap_err fap_ascii_reader_open(fap_ascii_reader **reader, const fap_reader *in,
                                                    const fap_ascii_reader_config *cfg, char *where);
/** What open found in front of the first frame. Never NULL; lives as long as the reader. */
FAP_API const fap_ascii_header *fap_ascii_reader_header(const fap_ascii_reader *reader);
/**
 * @return FAP_OK and one frame; FAP_E_END; FAP_E_SYNTAX; FAP_E_IO. After an error the reader stays at it. A file
 * that is cut inside a frame, with whole ones before it, ends there: a deviation, not an error.
 * FAPs whose mask digit is 0 are FAP_HELD with the value last sent, FAP_ABSENT when none was. A value written as inf
 * or nan makes its FAP FAP_ABSENT until it is sent again. @c number is as written; @c pts_us follows from it and the
 * rate (or is the written time where frame numbers are milliseconds) and never goes back. @p out is untouched on error.
 */
FAP_API FAP_NODISCARD fap_err fap_ascii_reader_next(fap_ascii_reader *reader, fap_frame *out);
/** Line, column and what was expected. Never NULL; "" when nothing went wrong. */
FAP_API const char *fap_ascii_reader_last_error(const fap_ascii_reader *reader);
/** Sets @p *reader to NULL; accepts NULL. */
FAP_API void fap_ascii_reader_close(fap_ascii_reader **reader);

/**
 * Writes version 2.1, LF, no trailing blanks; blanks in the name become '_'.
 * @param header  name, rate and the exact frame count (the format states it in front, so it must be known); other
 *                members are ignored. Rates that are no whole number are written with up to six decimals.
 * @return FAP_OK; FAP_E_ARG; FAP_E_NOMEM; FAP_E_IO. *writer is NULL unless FAP_OK.
 */
FAP_API FAP_NODISCARD fap_err fap_ascii_writer_open(fap_ascii_writer **writer, const fap_writer *out,
                                                    const fap_ascii_header *header,
                                                    const fap_allocator *alloc);
/**
 * Frames must be as many as the header said. FAPs of state FAP_CODED, FAP_DERIVED and FAP_CONCEALED are written,
 * and come back as FAP_CODED. FAP_HELD is a mask digit 0, which readers take as the value they have; where they
 * have another or none (a take that begins in its middle, a loss) the value is written. FAP_ABSENT is a 0 too.
 * Frame numbers count from 0; where @c pts_us leaves a gap of whole frames the count does too.
 * @return FAP_OK; FAP_E_ARG a viseme or expression out of its range, nothing written; FAP_E_DATA one frame too many;
 *         FAP_E_IO. The last two stay.
 */
FAP_API FAP_NODISCARD fap_err fap_ascii_writer_put(fap_ascii_writer *writer, const fap_frame *frame);
/** @return FAP_E_DATA when fewer or more frames came than the header promised. Frees the writer in any case. */
FAP_API FAP_NODISCARD fap_err fap_ascii_writer_close(fap_ascii_writer **writer);

#ifdef __cplusplus
}
#endif
#endif
