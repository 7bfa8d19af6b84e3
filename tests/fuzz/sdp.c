/* SPDX-License-Identifier: BSD-2-Clause */
/* Any bytes as a session description; what is read is written and read again, and is the same. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <fap/error.h>
#include <fap/sdp.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char where[FAP_ERROR_TEXT_SIZE], text[FAP_SDP_MAX_SIZE];
    fap_sdp a, b;

    if (fap_sdp_read(&a, data, size, where) != FAP_OK)
        return 0;
    const size_t n = fap_sdp_write(&a, text, sizeof text);
    if (!n || fap_sdp_read(&b, text, n, where) != FAP_OK || strcmp(a.host, b.host) != 0 || a.port != b.port ||
        a.payload_type != b.payload_type)
        abort();
    return 0;
}
