/* SPDX-License-Identifier: BSD-2-Clause */
/* Any bytes as packets, each behind a byte that says how long it is; times go on and sources change. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <fap/rtp.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void drain(fap_rtp_receiver *r, int64_t now_us)
{
    fap_rtp_unit u;

    for (int i = 0; i < 200 && fap_rtp_receiver_get(r, now_us, &u) == FAP_OK; i++)
        if (u.data ? !u.size || u.size > FAP_RTP_MAX_PACKET : u.lost_us <= 0)
            abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fap_rtp_sender_config sc;
    fap_rtp_receiver_config rc;
    fap_rtp_sender *s;
    fap_rtp_receiver *r;
    uint8_t report[FAP_RTP_REPORT_SIZE];
    int64_t now_us = 0;

    fap_rtp_sender_config_init(&sc);
    fap_rtp_receiver_config_init(&rc);
    rc.any_source = size && data[0] & 1;
    if (fap_rtp_sender_open(&s, &sc) != FAP_OK || fap_rtp_receiver_open(&r, &rc) != FAP_OK)
        abort();
    while (size > 2) {
        const size_t n = data[0] < size - 2 ? data[0] : size - 2;
        now_us += data[1] * 500;
        (void)!fap_rtp_receiver_put(r, data[1] >> 7, data + 2, n, now_us);
        fap_rtp_receiver_heard(r, data + 2, n, now_us);
        fap_rtp_sender_heard(s, data + 2, n, now_us);
        drain(r, now_us);
        data += 2 + n;
        size -= 2 + n;
    }
    if (fap_rtp_receiver_report(r, now_us, report) > sizeof report)
        abort();
    fap_rtp_sender_close(&s);
    fap_rtp_receiver_close(&r);
    return 0;
}
