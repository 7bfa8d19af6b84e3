/* SPDX-License-Identifier: BSD-2-Clause */
#include "tests/test.h"

#include <string.h>

#include <fap/sdp.h>

static char where[FAP_ERROR_TEXT_SIZE];

static fap_err read_text(fap_sdp *s, const char *text)
{
    return fap_sdp_read(s, text, strlen(text), where);
}

TEST(sdp, what_is_written_is_read)
{
    const fap_sdp in[2] = { { "127.0.0.1", 5004, 77, 96, 97, 90000, 0x61 },
                            { "fe80::1", 6000, 1, 100, 0, 90000, 0x62 } };

    for (int i = 0; i < 2; i++) {
        char text[FAP_SDP_MAX_SIZE];
        fap_sdp out;
        const size_t n = fap_sdp_write(&in[i], text, sizeof text);
        assert_true(n > 100 && n == strlen(text));
        assert_int_equal(fap_sdp_read(&out, text, n, where), FAP_OK);
        assert_string_equal(out.host, in[i].host);
        assert_true(out.port == in[i].port && out.payload_type == in[i].payload_type);
        assert_true(out.redundant_type == in[i].redundant_type && out.profile_level == in[i].profile_level);
        assert_int_equal(fap_sdp_write(&in[i], text, n), 0);
    }
    assert_int_equal(fap_sdp_write(&(fap_sdp){ .host = "a\r\nb" }, (char[600]){ 0 }, 600), 0);
}

TEST(sdp, other_media_are_passed_over_and_an_own_address_counts)
{
    fap_sdp s;

    assert_int_equal(
        read_text(&s, "v=0\no=- 1 1 IN IP4 1.2.3.4\nc=IN IP4 1.2.3.4\nm=audio 4000 RTP/AVP 0\n"
                      "a=rtpmap:96 MP4V-ES/90000\nm=video 5006 RTP/AVP 98\nc=IN IP4 5.6.7.8/127\n"
                      "a=rtpmap:98 MP4V-ES/90000\nm=video 7000 RTP/AVP 96\na=rtpmap:96 MP4V-ES/90000\n"),
        FAP_OK);
    assert_string_equal(s.host, "5.6.7.8");
    assert_true(s.port == 5006 && s.payload_type == 98 && !s.redundant_type);
}

TEST(sdp, what_is_none_is_refused_with_its_line)
{
    fap_sdp s;

    assert_int_equal(read_text(&s, ""), FAP_E_UNKNOWN_FORMAT);
    assert_int_equal(read_text(&s, "hello\n"), FAP_E_UNKNOWN_FORMAT);
    assert_int_equal(read_text(&s, "v=0\nnonsense\n"), FAP_E_SYNTAX);
    assert_non_null(strstr(where, "line 2"));
    assert_int_equal(read_text(&s, "v=0\nc=IN IP4 nowhere\n"), FAP_E_SYNTAX);
    assert_int_equal(read_text(&s, "v=0\nc=IN IP4 1.2.3.4\nm=audio 4 RTP/AVP 0\n"), FAP_E_UNSUPPORTED);
    assert_int_equal(
        read_text(&s, "v=0\nc=IN IP4 1.2.3.4\nm=video 5004 RTP/AVP 96\na=rtpmap:96 MP4V-ES/1000\n"),
        FAP_E_UNSUPPORTED);
    assert_int_equal(read_text(&s, "v=0\nm=video 5004 RTP/AVP 96\na=rtpmap:96 MP4V-ES/90000\n"),
                     FAP_E_SYNTAX);
}
