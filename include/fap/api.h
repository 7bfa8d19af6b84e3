/* SPDX-License-Identifier: BSD-2-Clause */
/** @file
 * The marks every public declaration carries. Nothing else lives here.
 */
#ifndef FAP_API_H
#define FAP_API_H

#if defined(__GNUC__)
#define FAP_API       __attribute__((visibility("default")))
#define FAP_NODISCARD __attribute__((warn_unused_result))
#else
#define FAP_API
#define FAP_NODISCARD
#endif

#endif
