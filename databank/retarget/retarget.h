/* SPDX-License-Identifier: BSD-2-Clause */
/* fapbank retarget: motions of one face on another. */
#ifndef DATABANK_RETARGET_RETARGET_H
#define DATABANK_RETARGET_RETARGET_H

/* @argv[0] is "retarget". @return the exit status */
int retarget_run(int argc, char **argv);

#endif
