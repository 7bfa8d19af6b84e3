/* SPDX-License-Identifier: BSD-2-Clause */
/* FAP streams of both kinds, .fap text and .fba bits, behind one way to read and one to write. */
#ifndef COMMON_STREAMS_H
#define COMMON_STREAMS_H

#include <fap/ascii.h>
#include <fap/decoder.h>
#include <fap/encoder.h>

enum { STREAM_MAX_NOTICES = 32 };

/* A FAP over a whole stream. */
typedef struct stream_fap {
    uint64_t coded, bits;
    int32_t min, max;
    double sum;
} stream_fap;

/* What a stream holds. */
typedef struct stream_summary {
    const char *format;      /* "fap" or "fba" */
    fap_ascii_header header; /* an .fba has a rate, its first, and no more */
    uint64_t frames, intra_frames, broken_planes, size;
    uint64_t skipped;      /* frames of an .fba that lie between those that were sent */
    uint64_t rate_changes; /* of an .fba */
    uint64_t concealed; /* frames of an .fba that had to be predicted: their I plane is broken or missing */
    int64_t end_us;     /* when the last frame is over */
    stream_fap fap[FAP_COUNT + 1];
    struct {
        int64_t where; /* line or bit */
        const char *text;
    } notice[STREAM_MAX_NOTICES];
    int notice_count;
} stream_summary;

/* How a stream is read. */
typedef struct stream_options {
    int strict;         /* 1: every deviation from the standard is an error */
    const fap_fit *fit; /* of an .fba; NULL: none */
} stream_options;

/* Takes one frame after the other; anything but FAP_OK ends the reading. */
typedef struct frame_sink {
    fap_err (*put)(void *user, const fap_frame *frame);
    void *user;
    /* Of an .fba, may be NULL: what the frame that is put next was made of, unless it
     * was predicted; why a plane gave none. */
    void (*plane)(void *user, const fap_plane_info *plane, const fap_frame *frame);
    void (*broken)(void *user, const char *where);
} frame_sink;

/* By its first bytes: 1 an .fba, 0 a .fap or nothing of ours. */
int stream_is_bits(const uint8_t *data, size_t size);

/* Reads a whole stream, counts into @p s and hands frames to @p sink (may be NULL). @p options: NULL is tolerant
 * and without table. @p where: FAP_ERROR_TEXT_SIZE bytes; of the first broken plane when all went well. */
fap_err stream_read(const uint8_t *data, size_t size, const stream_options *options, stream_summary *s,
                    const frame_sink *sink, char *where);

typedef struct stream_writer {
    fap_ascii_writer *text;
    fap_encoder *bits;
    fap_writer out;
    uint8_t *packet;
    size_t packet_room;
} stream_writer;

/* @p bits: NULL writes text, otherwise how to code bits. */
fap_err stream_writer_open(stream_writer *w, const fap_writer *out, const fap_ascii_header *header,
                           const fap_encoder_config *bits);
fap_err stream_writer_put(stream_writer *w, const fap_frame *frame);
/* Frees in any case. @p stats: what became of the frames, all 0 for text. */
fap_err stream_writer_close(stream_writer *w, fap_encoder_stats *stats);

#endif
