/* SPDX-License-Identifier: BSD-2-Clause */
/* fapenc track: dots in a video, with or without mirrors, to a take in space. docs/track.md */
#ifndef ENCODER_TRACK_TRACK_H
#define ENCODER_TRACK_TRACK_H

/* Does it all and tells; the exit status. @argv[0] is "track". */
int track_run(int argc, char **argv);

#endif
