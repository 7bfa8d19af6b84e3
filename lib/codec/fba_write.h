/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * The syntax of planes, nothing else: what was decided is put into bits. Field names are the standard's.
 * Source: ISO/IEC 14496-2, face object plane syntax and arithmetic coding of FAPs.
 */
#ifndef LIB_CODEC_FBA_WRITE_H
#define LIB_CODEC_FBA_WRITE_H

#include "codec/fba.h"
#include "codec/models.h"

/* A plane but for the setup. */
typedef struct fba_plane {
    int intra;
    uint32_t rate_16; /* intra */
    int offset;
    int64_t time_code_s; /* intra; -1: none */
    uint32_t skipped;
    uint8_t viseme_def, init_face, expression_def;
    uint16_t symbol[FBA_PARAMS]; /* by place in the list of coded parameters */
} fba_plane;

void fap_fba_put_code(fap_bit_writer *w, int code);
/* The smallest bound that can be sent and holds @p level. */
int fap_fba_bound_for(int level, int quant);
/* What an I plane carries in front of its symbols. */
void fap_fba_put_setup(fap_bit_writer *w, const fba_setup *s);
void fap_fba_put_header(fap_bit_writer *w, const fba_plane *p);
/*
 * The symbols. With @p count they are counted as they are put; 0 then says that no decoder need have the memory.
 */
int fap_fba_put_symbols(fap_bit_writer *w, const fba_plane *p, const fba_coded_list *list, model *m,
                        model_pool *pool, int count);
/* Counts what was put without; 0: no memory. */
int fap_fba_count_symbols(const fba_plane *p, const fba_coded_list *list, model *m, model_pool *pool);
/* Bits of the range tables for one FAP. */
int fap_fba_table_bits(void);

#endif
