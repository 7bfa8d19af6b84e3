/* SPDX-License-Identifier: BSD-2-Clause */
/** @file
 * Face animation tables (FAT) for the smallest clients: each FAP moves its vertices along piecewise linear paths, each on
 * its own, and the movements add up. No solver, no key models; a pose is sums alone, and a sine for what turns. Baked from a
 * bank, written and read as a file (docs/fat.md).
 * Source: ISO/IEC 14496-1, FaceDefTables, FaceDefMesh and FaceDefTransform nodes.
 */
#ifndef FAP_FAT_H
#define FAP_FAT_H

#include <fap/bank.h>
#include <fap/frame.h>
#include <fap/io.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Tables and the neutral face they belong to. Never changes once made: threads may share it. */
typedef struct fap_fat fap_fat;

/**
 * Bake the tables of a bank: what its key models say that the face does with each FAP while the others stay, so that
 * movements can be added and every commanded feature point still arrives where its FAPs say.
 * @return FAP_OK; FAP_E_ARG; FAP_E_DATA the bank cannot be posed; FAP_E_NOMEM. *fat is NULL unless FAP_OK.
 */
FAP_API FAP_NODISCARD fap_err fap_fat_bake(fap_fat **fat, const fap_bank *bank, const fap_allocator *alloc);
/** Every count, index and checksum is looked at. @return FAP_OK; FAP_E_UNKNOWN_FORMAT; FAP_E_UNSUPPORTED a newer version;
 *  FAP_E_DATA; FAP_E_LIMIT; FAP_E_NOMEM; FAP_E_ARG. *fat is NULL unless FAP_OK. */
FAP_API FAP_NODISCARD fap_err fap_fat_load(fap_fat **fat, const void *data, size_t size,
                                           const fap_allocator *alloc);
/** What is written loads into equal tables. @return FAP_OK; FAP_E_IO */
FAP_API FAP_NODISCARD fap_err fap_fat_write(const fap_fat *fat, const fap_writer *out);
/** Sets @p *fat to NULL; accepts NULL. */
FAP_API void fap_fat_close(fap_fat **fat);

FAP_API uint32_t fap_fat_vertex_count(const fap_fat *fat);
/** [count][3], counter-clockwise seen from outside; as long as @p fat. */
FAP_API const uint32_t *fap_fat_triangles(const fap_fat *fat, uint32_t *count);
/** [vertex count][3] of the neutral face, millimetres; as long as @p fat. */
FAP_API const float (*fap_fat_neutral(const fap_fat *fat))[3];

/**
 * Pose the face. A FAP of state FAP_ABSENT is derived as fap_derive() does, or else follows one that is there, as the
 * key models have it (lips the jaw); beside a viseme or an expression that shows nothing follows. Visemes give way to explicit FAPs of the mouth (groups 2 and 8), expressions to explicit FAPs of anything but head, eyeballs and jaw.
 * Allocates nothing; any value is accepted.
 * @param position  [vertex count][3], millimetres
 */
FAP_API void fap_fat_pose(const fap_fat *fat, const fap_frame *frame, float (*position)[3]);

#ifdef __cplusplus
}
#endif
#endif
