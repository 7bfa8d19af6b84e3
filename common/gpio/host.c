/* SPDX-License-Identifier: BSD-2-Clause */
/* See gpio.h: how this machine calls chips and lines, what its errors mean, its clock. */
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "common/gpio/gpio.h"

static int is_digits(const char *text)
{
    return *text && text[strspn(text, "0123456789")] == '\0';
}

int gpio_chip_path(const char *chip, char *path, size_t room)
{
    static const char usual[] = "gpiochip";
    const char *prefix = "";

    if (is_digits(chip))
        prefix = "/dev/gpiochip";
    else if (!strncmp(chip, usual, sizeof usual - 1) && is_digits(chip + sizeof usual - 1))
        prefix = "/dev/";
    else if (*chip != '/')
        return 0;
    const int length = snprintf(path, room, "%s%s", prefix, chip);
    return length > 0 && (size_t)length < room;
}

int gpio_line_number(const char *line, unsigned *offset)
{
    if (!is_digits(line))
        return 0;
    errno = 0;
    const unsigned long number = strtoul(line, NULL, 10);
    /* What no chip has is one that this chip does not have. */
    *offset = errno || number > INT_MAX ? INT_MAX : (unsigned)number;
    return 1;
}

static void say(int error, char *detail)
{
    snprintf(detail, GPIO_DETAIL_SIZE, "%s", strerror(error));
}

gpio_fault gpio_chip_fault(int error, char *detail)
{
    say(error, detail);
    switch (error) {
    case ENOENT:
    case ENODEV:
    case ENXIO:
    case ENOTTY: /* a file that is no chip */
    case ENOTDIR: return GPIO_NO_CHIP;
    case EACCES:
    case EPERM: return GPIO_DENIED;
    default: return GPIO_FAILED;
    }
}

gpio_fault gpio_line_fault(int error, char *detail)
{
    say(error, detail);
    switch (error) {
    case EBUSY: return GPIO_BUSY;
    case EACCES:
    case EPERM: return GPIO_DENIED;
    case EINVAL:
    case ENXIO:
    case ENODEV:
    case EOPNOTSUPP: return GPIO_REFUSED;
    default: return GPIO_FAILED;
    }
}

int64_t gpio_now_ns(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (int64_t)t.tv_sec * 1000000000 + t.tv_nsec;
}

void gpio_rest(int64_t ns)
{
    struct timespec left = { (time_t)(ns / 1000000000), (long)(ns % 1000000000) };
    while (ns > 0 && nanosleep(&left, &left) && errno == EINTR)
        ;
}

void gpio_fault_text(gpio_fault fault, const gpio_request *r, const char *detail, char *where)
{
    const char *fmt = "%s:%s: this GPIO line failed: %s";

    switch (fault) {
    case GPIO_NO_LIBRARY:
        fmt =
            "%s:%s: built without GPIO: install libgpiod (Debian: apt install libgpiod-dev) and build again";
        break;
    case GPIO_NO_CHIP: fmt = "%s:%s: no such GPIO chip; gpiodetect lists those there are"; break;
    case GPIO_NO_LINE: fmt = "%s:%s: the chip has no such line; gpioinfo lists those it has"; break;
    case GPIO_BUSY: fmt = "%s:%s: this line is in use by %s: stop that first, or take another line"; break;
    case GPIO_DENIED:
        fmt = "%s:%s: no permission for this GPIO chip: join the group that ls -l /dev/gpiochip* shows "
              "(Raspberry Pi OS: gpio), or run as root";
        break;
    case GPIO_REFUSED:
        fmt = "%s:%s: this line cannot be used so (%s): try without pull and debounce, or another line";
        break;
    case GPIO_OK:
    case GPIO_FAILED: break;
    }
    snprintf(where, FAP_ERROR_TEXT_SIZE, fmt, r->chip, r->line, detail);
}
