/* SPDX-License-Identifier: BSD-2-Clause */
/** @file
 * The version of the headers, and of the library that is linked.
 */
#ifndef FAP_VERSION_H
#define FAP_VERSION_H

#include <fap/api.h>

#define FAP_VERSION_MAJOR  0
#define FAP_VERSION_MINOR  1
#define FAP_VERSION_PATCH  0
#define FAP_VERSION_STRING "0.1.0"

/** The version of the linked library, "MAJOR.MINOR.PATCH". Never NULL, static. */
FAP_API const char *fap_version(void);

#endif
