/* SPDX-License-Identifier: BSD-2-Clause */
/* fapbank pick: landmarks of a scan, by hand. */
#ifndef DATABANK_PICK_PICK_RUN_H
#define DATABANK_PICK_PICK_RUN_H

/* @argv[0] is "pick". @return the exit status */
int pick_run(int argc, char **argv);

#endif
