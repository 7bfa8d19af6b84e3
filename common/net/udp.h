/* SPDX-License-Identifier: BSD-2-Clause */
/* Datagrams by address: IPv4 and IPv6, never wider than loopback unless an address says so. */
#ifndef COMMON_NET_UDP_H
#define COMMON_NET_UDP_H

#include <stddef.h>
#include <stdint.h>
#include <sys/socket.h>

#include "common/fault.h"

typedef struct udp_address {
    struct sockaddr_storage to;
    socklen_t size;
} udp_address;

/*
 * "rtp://127.0.0.1:5004", "rtp://[::1]:5004"; without a host, "rtp://:5004", it is 127.0.0.1. @scheme "rtp". 0: @f says what is
 * wrong.
 */
int udp_address_parse(udp_address *out, const char *url, const char *scheme, fault *f);
/* The same host, another port. */
/* The host as numbers; FAP_SDP_HOST_SIZE bytes are enough. */
void udp_address_host(const udp_address *a, char *out, size_t room);
int udp_address_port(const udp_address *a);
void udp_address_set_port(udp_address *a, int port);
/* A number of it: the same for the same host and port, hardly ever for another. */
uint64_t udp_address_number(const udp_address *a);

/* Both non-blocking and closed on exec; -1: @f says why. @what: for words, an URL. */
int udp_open_listening(const udp_address *a, const char *what, fault *f);
int udp_open_sending(const udp_address *like, const char *what, fault *f);
/* Nobody listening is no error. */
void udp_send(int socket, const udp_address *to, const void *data, size_t size);
/* Bytes of the datagram, 0 and up; -1: there is none. One that is longer than @room is cut, and as long as it was is returned. */
long udp_receive(int socket, void *data, size_t room, udp_address *from);
/* Waits until one of both (-1: none) has something, or that long; microseconds, up to a second at once. */
void udp_wait(int a, int b, int64_t us);

/* A clock that only goes on, microseconds. */
int64_t udp_now_us(void);

#endif
