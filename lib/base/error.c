/* SPDX-License-Identifier: BSD-2-Clause */
/* Error texts and the version: the two things a caller can ask without a handle. */
#include <fap/error.h>
#include <fap/version.h>

const char *fap_strerror(fap_err err)
{
    switch (err) {
#define X(name, value, text)                                                                                 \
    case name: return text;
        FAP_ERRORS(X)
#undef X
    }
    return "unknown error";
}

const char *fap_version(void)
{
    return FAP_VERSION_STRING;
}
