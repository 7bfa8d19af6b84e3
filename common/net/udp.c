/* SPDX-License-Identifier: BSD-2-Clause */
/* See udp.h. */
#define _GNU_SOURCE /* SOCK_NONBLOCK, ppoll */
#include <arpa/inet.h>
#include <errno.h>
#include <netdb.h>
#include <netinet/in.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "common/net/udp.h"
#include "common/tool.h"

enum { HOST_SIZE = 256, PORT_SIZE = 6, LONGEST_WAIT_US = 1000000 };

/* --- addresses --- */

/* "host:port" or "[host]:port" behind the slashes, and nothing else. */
static int split(const char *text, char host[HOST_SIZE], char port[PORT_SIZE])
{
    const char *colon = strrchr(text, ':');

    if (!colon || (size_t)(colon - text) >= HOST_SIZE || strlen(colon + 1) >= PORT_SIZE)
        return 0;
    const char *end;
    for (end = colon + 1; *end >= '0' && *end <= '9'; end++)
        continue;
    const long number = strtol(colon + 1, NULL, 10);
    if (*end || number < 1 || number > 65535)
        return 0;
    snprintf(host, HOST_SIZE, "%.*s", (int)(colon - text), text);
    snprintf(port, PORT_SIZE, "%ld", number);
    const size_t n = strlen(host);
    if (*host == '[' && n > 2 && host[n - 1] == ']') {
        memmove(host, host + 1, n - 2);
        host[n - 2] = '\0';
        return 1;
    }
    return !strchr(host, ':');
}

int udp_address_parse(udp_address *out, const char *url, const char *scheme, fault *f)
{
    char host[HOST_SIZE], port[PORT_SIZE];
    const size_t n = strlen(scheme);
    const struct addrinfo hints = { .ai_family = AF_UNSPEC, .ai_socktype = SOCK_DGRAM };
    struct addrinfo *found;

    if (strncmp(url, scheme, n) || strncmp(url + n, "://", 3) || !split(url + n + 3, host, port))
        return fault_set(f, EXIT_USAGE, "%s: expected %s://HOST:PORT, as in %s://127.0.0.1:5004", url, scheme,
                         scheme);
    const int err = getaddrinfo(*host ? host : "127.0.0.1", port, &hints, &found);
    if (err)
        return fault_set(f, EXIT_DATA, "%s: no such host: %s", url, gai_strerror(err));
    memset(out, 0, sizeof *out);
    memcpy(&out->to, found->ai_addr, found->ai_addrlen);
    out->size = found->ai_addrlen;
    freeaddrinfo(found);
    return 1;
}

static in_port_t *port_of(const udp_address *a)
{
    return a->to.ss_family == AF_INET6 ? &((struct sockaddr_in6 *)(uintptr_t)&a->to)->sin6_port
                                       : &((struct sockaddr_in *)(uintptr_t)&a->to)->sin_port;
}

void udp_address_host(const udp_address *a, char *out, size_t room)
{
    if (getnameinfo((const struct sockaddr *)&a->to, a->size, out, (socklen_t)room, NULL, 0, NI_NUMERICHOST))
        *out = '\0';
}

int udp_address_port(const udp_address *a)
{
    return ntohs(*port_of(a));
}

void udp_address_set_port(udp_address *a, int port)
{
    *port_of(a) = htons((uint16_t)port);
}

/* FNV-1a over host and port; what else is in a socket address, such as padding, does not count. */
uint64_t udp_address_number(const udp_address *a)
{
    const int six = a->to.ss_family == AF_INET6;
    const uint8_t *host = six ? (const uint8_t *)&((const struct sockaddr_in6 *)&a->to)->sin6_addr
                              : (const uint8_t *)&((const struct sockaddr_in *)&a->to)->sin_addr;
    uint64_t h = 14695981039346656037U ^ (uint64_t)udp_address_port(a);

    for (size_t i = 0; i < (six ? 16U : 4U); i++)
        h = (h ^ host[i]) * 1099511628211U;
    return h;
}

/* --- sockets --- */

static int open_socket(const udp_address *a, const char *what, fault *f)
{
    const int s = socket(a->to.ss_family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);

    if (s < 0)
        fault_set(f, EXIT_DATA, "%s: %s", what, strerror(errno));
    return s;
}

int udp_open_sending(const udp_address *like, const char *what, fault *f)
{
    return open_socket(like, what, f);
}

int udp_open_listening(const udp_address *a, const char *what, fault *f)
{
    const int s = open_socket(a, what, f);

    if (s < 0 || !bind(s, (const struct sockaddr *)&a->to, a->size))
        return s;
    fault_set(f, EXIT_DATA, "%s: %s", what, strerror(errno));
    close(s);
    return -1;
}

void udp_send(int socket, const udp_address *to, const void *data, size_t size)
{
    (void)!sendto(socket, data, size, MSG_NOSIGNAL, (const struct sockaddr *)&to->to, to->size);
}

long udp_receive(int socket, void *data, size_t room, udp_address *from)
{
    ssize_t n;

    from->size = sizeof from->to;
    do
        n = recvfrom(socket, data, room, MSG_TRUNC, (struct sockaddr *)&from->to, &from->size);
    while (n < 0 && (errno == EINTR || errno == ECONNREFUSED));
    return n;
}

void udp_wait(int a, int b, int64_t us)
{
    struct pollfd both[2] = { { .fd = a, .events = POLLIN }, { .fd = b, .events = POLLIN } };
    const int64_t shortened = us < 0 ? 0 : us < LONGEST_WAIT_US ? us : LONGEST_WAIT_US;
    const struct timespec t = { (time_t)(shortened / 1000000), (long)(shortened % 1000000) * 1000 };

    ppoll(both, 2, &t, NULL);
}

int64_t udp_now_us(void)
{
    struct timespec t;

    clock_gettime(CLOCK_MONOTONIC, &t);
    return (int64_t)t.tv_sec * 1000000 + t.tv_nsec / 1000;
}
