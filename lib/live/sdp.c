/* SPDX-License-Identifier: BSD-2-Clause */
/* See fap/sdp.h. Lines are "x=...", ended by CR LF or LF; those of a medium stand behind its "m=". */
#include <stdio.h>
#include <string.h>

#include <fap/rtp.h>
#include <fap/sdp.h>

enum { LINE_SIZE = 256, MOST_LINES = 1000 };

static int is_address(const char *host)
{
    return *host && strspn(host, "0123456789abcdefABCDEF.:") == strlen(host);
}

size_t fap_sdp_write(const fap_sdp *s, char *out, size_t room)
{
    const char *const family = strchr(s->host, ':') ? "IP6" : "IP4";
    char types[16], redundant[64] = "";

    if (!is_address(s->host))
        return 0;
    snprintf(types, sizeof types, s->redundant_type ? "%u %u" : "%u", s->payload_type, s->redundant_type);
    if (s->redundant_type)
        snprintf(redundant, sizeof redundant, "a=rtpmap:%u red/%u\r\na=fmtp:%u %u/%u\r\n", s->redundant_type,
                 (unsigned)s->clock_hz, s->redundant_type, s->payload_type, s->payload_type);
    const int n = snprintf(
        out, room,
        "v=0\r\no=- %u 1 IN %s %s\r\ns=libfap face\r\nc=IN %s %s\r\nt=0 0\r\nm=video %u RTP/AVP %s\r\n"
        "a=rtpmap:%u MP4V-ES/%u\r\na=fmtp:%u profile-level-id=%u\r\n%s",
        (unsigned)s->session, family, s->host, family, s->host, s->port, types, s->payload_type,
        (unsigned)s->clock_hz, s->payload_type, s->profile_level, redundant);
    return n > 0 && (size_t)n < room ? (size_t)n : 0;
}

/* --- read --- */

typedef struct reading {
    fap_sdp s;
    char session_host[FAP_SDP_HOST_SIZE]; /* of a c= in front of all media */
    int in_medium, ours, has_map;         /* ours: within a medium that may be it */
    char *where;
    int line;
} reading;

static fap_err fail(const reading *r, fap_err err, const char *what)
{
    if (r->where)
        snprintf(r->where, FAP_ERROR_TEXT_SIZE, "line %d: %s", r->line, what);
    return err;
}

/* "IN IP4 127.0.0.1", perhaps with "/ttl" behind. */
static fap_err take_connection(reading *r, const char *text)
{
    char family[4], host[FAP_SDP_HOST_SIZE];

    if (sscanf(text, "IN %3s %63[0-9a-fA-F.:]", family, host) != 2)
        return fail(r, FAP_E_SYNTAX, "expected c=IN IP4 ADDRESS, or IP6");
    if (!r->in_medium)
        memcpy(r->session_host, host, sizeof host);
    else if (r->ours)
        memcpy(r->s.host, host, sizeof host);
    return FAP_OK;
}

/* "video 5004 RTP/AVP 96 97" */
static fap_err take_medium(reading *r, const char *text)
{
    unsigned port, type;

    r->in_medium = 1;
    r->ours =
        !r->has_map && sscanf(text, "video %5u RTP/AVP %3u", &port, &type) == 2 && port > 0 && port < 65535;
    if (!r->ours)
        return FAP_OK;
    r->s = (fap_sdp){ .port = (uint16_t)port, .profile_level = 1 };
    memcpy(r->s.host, r->session_host, sizeof r->s.host);
    return FAP_OK;
}

/* "96 MP4V-ES/90000" */
static void take_map(reading *r, const char *text)
{
    unsigned type, clock;
    char name[16];

    if (!r->ours || sscanf(text, "%3u %15[^/]/%7u", &type, name, &clock) != 3 || type > 127)
        return;
    if (!strcmp(name, "MP4V-ES")) {
        r->s.payload_type = (uint8_t)type;
        r->s.clock_hz = clock;
        r->has_map = 1;
    } else if (!strcmp(name, "red"))
        r->s.redundant_type = (uint8_t)type;
}

static void take_format(reading *r, const char *text)
{
    const char *level = strstr(text, "profile-level-id=");
    unsigned value;

    if (r->ours && level && sscanf(level, "profile-level-id=%3u", &value) == 1 && value < 256)
        r->s.profile_level = (uint8_t)value;
}

static fap_err take_line(reading *r, const char *line)
{
    if (!line[0] || line[1] != '=')
        return fail(r, r->line == 1 ? FAP_E_UNKNOWN_FORMAT : FAP_E_SYNTAX, "expected a letter and \"=\"");
    if (r->line == 1 && strcmp(line, "v=0") != 0)
        return fail(r, FAP_E_UNKNOWN_FORMAT, "no session description: it would begin with v=0");
    if (line[0] == 'c')
        return take_connection(r, line + 2);
    if (line[0] == 'm')
        return take_medium(r, line + 2);
    if (!strncmp(line, "a=rtpmap:", 9))
        take_map(r, line + 9);
    else if (!strncmp(line, "a=fmtp:", 7))
        take_format(r, line + 7);
    return FAP_OK;
}

static fap_err check(const reading *r)
{
    if (!r->has_map)
        return fail(r, FAP_E_UNSUPPORTED,
                    "no medium of MPEG-4 visual planes (video over RTP/AVP, MP4V-ES) in it");
    if (r->s.clock_hz != FAP_RTP_CLOCK_HZ)
        return fail(r, FAP_E_UNSUPPORTED, "its clock is not 90000 Hz");
    return is_address(r->s.host) ? FAP_OK : fail(r, FAP_E_SYNTAX, "no address (c=)");
}

fap_err fap_sdp_read(fap_sdp *out, const void *data, size_t size, char *where)
{
    const char *at = data, *const end = at + size;
    reading r = { .where = where };
    fap_err err = size ? FAP_OK : FAP_E_UNKNOWN_FORMAT;

    while (at < end && err == FAP_OK && r.line < MOST_LINES) {
        const char *stop = memchr(at, '\n', (size_t)(end - at));
        size_t n = (size_t)((stop ? stop : end) - at);
        char line[LINE_SIZE];
        r.line++;
        const size_t kept = n < sizeof line - 1 ? n : sizeof line - 1; /* what is longer is none of ours */
        memcpy(line, at, kept);
        line[kept && line[kept - 1] == '\r' ? kept - 1 : kept] = '\0';
        at += n + (stop != NULL);
        if (*line || r.line == 1)
            err = take_line(&r, line);
    }
    if (err == FAP_OK)
        err = check(&r);
    if (err == FAP_OK)
        *out = r.s;
    return err;
}
