/* SPDX-License-Identifier: BSD-2-Clause */
/* How long after an edge fapplay shows its first frame. Measured where there is a chip: in the machine of tests/gpio/run. */
#include <stdio.h>

#include "bench.h"

double bench_gpio_trigger_ms(void)
{
    double ms = -1;
    FILE *pipe = popen("tests/gpio/run --figure 2>/dev/null", "r");

    if (pipe && fscanf(pipe, "%lf", &ms) != 1)
        ms = -1; /* it could not run, and says why on its own */
    if (pipe)
        pclose(pipe);
    return ms;
}
