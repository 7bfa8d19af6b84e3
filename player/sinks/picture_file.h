/* SPDX-License-Identifier: BSD-2-Clause */
/* A PNG file, whole or not at all, with what went wrong in words. */
#ifndef PLAYER_SINKS_PICTURE_FILE_H
#define PLAYER_SINKS_PICTURE_FILE_H

#include "common/fault.h"
#include "player/render/image.h"

/* @path "-": standard output. @level as in image_write_png(). */
int picture_write(const image *picture, const char *path, int level, fault *f);

#endif
