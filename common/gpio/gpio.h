/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * One line of a GPIO chip: an input that tells of edges, or an output. libgpiod 1.6 and 2 share a name and hardly a call, so
 * each has its driver file and the build takes the one that fits (Makefile: GPIO); without either, gpio_none.c says so. Tests
 * bring a chip of their own. Everything that can be had without a chip - what a line is called on a command line, debouncing,
 * what an edge does - stands above this and knows no library.
 * Follows the man pages and headers of libgpiod 1.6.3 and 2.3.
 */
#ifndef COMMON_GPIO_GPIO_H
#define COMMON_GPIO_GPIO_H

#include <stddef.h>
#include <stdint.h>

#include <fap/error.h>

/* Of what a line says, not of its volts: with active-low, a fall to 0 V is rising. */
typedef enum gpio_edge {
    GPIO_RISING = 1,
    GPIO_FALLING = 2,
    GPIO_BOTH = GPIO_RISING | GPIO_FALLING
} gpio_edge;

typedef enum gpio_bias { GPIO_BIAS_AS_IS, GPIO_BIAS_OFF, GPIO_PULL_UP, GPIO_PULL_DOWN } gpio_bias;

typedef struct gpio_request {
    const char *chip;     /* "gpiochip0", "0", "/dev/gpiochip0", or a label such as "pinctrl-bcm2711" */
    const char *line;     /* "17", or a name such as "GPIO17" */
    const char *consumer; /* who asks; others see it when the line is in use */
    int output;           /* 1: driven, inactive at first; 0: an input */
    int active_low;
    /* Of an input. */
    gpio_edge edge;
    gpio_bias bias;
    int64_t debounce_us; /* for a driver that can; 0: every edge */
} gpio_request;

typedef struct gpio_event {
    int64_t time_ns; /* CLOCK_MONOTONIC, stamped by the kernel at the interrupt (from Linux 5.7 on) */
    int rising;
} gpio_event;

typedef enum gpio_fault {
    GPIO_OK,
    GPIO_NO_LIBRARY, /* the build has none */
    GPIO_NO_CHIP,
    GPIO_NO_LINE,
    GPIO_BUSY, /* detail: who has it */
    GPIO_DENIED,
    GPIO_REFUSED, /* this line cannot be used so; detail: the reason */
    GPIO_FAILED   /* detail: the reason */
} gpio_fault;

/* Room for the detail of a fault. */
enum { GPIO_DETAIL_SIZE = 64 };

typedef struct gpio_driver {
    const char *name;
    int debounces; /* 1: debounce_us is the kernel's work */
    /* @line is closed by the caller with close(). */
    gpio_fault (*open)(const gpio_request *r, void **line, char *detail);
    /* 1: an edge can be read; 0: none came in time, or a signal came; -1: failed. @timeout_ns 0: only looks. */
    int (*wait)(void *line, int64_t timeout_ns);
    int (*read)(void *line, gpio_event *event); /* 1, or 0: failed */
    int (*get)(void *line);                     /* 1 active, 0 inactive, -1 failed */
    /* 1, or 0: failed. Called from handlers of signals: nothing but an ioctl, which is what both libraries do here. */
    int (*set)(void *line, int active);
    void (*close)(void *line);
    int64_t (*now_ns)(void); /* the clock of time_ns */
    void (*rest)(int64_t ns);
} gpio_driver;

/* Of this build. */
extern const gpio_driver gpio_system;

/* --- what the drivers share: host.c --- */

/* The path of a chip called by number, name or path. 0: it is none of these, so a label. */
int gpio_chip_path(const char *chip, char *path, size_t room);
/* 1: @line is a number, in @offset. Else it is a name. */
int gpio_line_number(const char *line, unsigned *offset);
/* What errno means after opening a chip, and after asking for a line; the detail says it in words. */
gpio_fault gpio_chip_fault(int error, char *detail);
gpio_fault gpio_line_fault(int error, char *detail);
int64_t gpio_now_ns(void);
void gpio_rest(int64_t ns);

/* A fault in a sentence that says what to do next. @where: FAP_ERROR_TEXT_SIZE bytes. */
void gpio_fault_text(gpio_fault fault, const gpio_request *r, const char *detail, char *where);

#endif
