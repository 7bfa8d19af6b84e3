/* SPDX-License-Identifier: BSD-2-Clause */
/* What the C3D reader and writer share. Source: the C3D file format as described at c3d.org. */
#ifndef LIB_TAKE_C3D_H
#define LIB_TAKE_C3D_H

enum { C3D_BLOCK = 512, C3D_KEY = 0x50 };

#endif
