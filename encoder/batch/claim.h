/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Who works on a take, told to other processes and other machines by a file in a folder they share. A claim beats as long as its
 * owner lives; one that does not is anybody's. At worst two work on one take: outputs appear whole, so the same bytes come twice.
 */
#ifndef ENCODER_BATCH_CLAIM_H
#define ENCODER_BATCH_CLAIM_H

enum { CLAIM_BEAT_S = 10, CLAIM_STALE_S = 60 };

/*
 * @path   of the claim, in a folder that is there
 * @clock  a file of ours in the same folder: its time, when touched, is the file server's
 * @return 1 it is ours now; 0 somebody works on it; -1 errno
 */
int claim_get(const char *path, const char *clock);
/* Still alive. */
void claim_beat(const char *path);
void claim_release(const char *path);

#endif
