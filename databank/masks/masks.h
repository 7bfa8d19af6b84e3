/* SPDX-License-Identifier: BSD-2-Clause */
/* fapbank masks: which vertices of a face are of which lip and lid. */
#ifndef DATABANK_MASKS_MASKS_H
#define DATABANK_MASKS_MASKS_H

/* @argv[0] is "masks". @return the exit status */
int masks_run(int argc, char **argv);

#endif
