/* SPDX-License-Identifier: BSD-2-Clause */
/* The faces that unit tests pose. */
#ifndef LIB_BANK_FACES_TEST_H
#define LIB_BANK_FACES_TEST_H

#include <fap/bank.h>

enum { BUILTIN, DEFAULT_FACE, FACE_COUNT };

/* For the caller to close. Where build/default.fbank has not been made, the test is counted as skipped. */
fap_bank *test_bank(int which);

#endif
