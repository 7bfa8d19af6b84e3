/* SPDX-License-Identifier: BSD-2-Clause */
/* mirror-compare TRUTH TAKE: how far TAKE is from the truth, in one line: "rms_mm 0.3 p95_mm 0.6 max_mm 1.2 points 40 missing 3 ...". */
#include <stdio.h>
#include <stdlib.h>

#include "common/file.h"
#include "compare.h"

enum { MOST = 1 << 28 };

static fap_take *read_take(const char *path)
{
    char where[FAP_ERROR_TEXT_SIZE] = "";
    fap_take *take = NULL;
    uint8_t *data = NULL;
    size_t size;

    fap_err err = file_read(path, MOST, &data, &size);
    if (!err)
        err = fap_take_read(&take, data, size, NULL, where);
    free(data);
    if (err)
        fprintf(stderr, "mirror-compare: %s: %s: %s\n", path, fap_strerror(err), where);
    return take;
}

int main(int argc, char **argv)
{
    take_difference d;

    if (argc != 3) {
        fprintf(stderr, "usage: mirror-compare TRUTH TAKE\n");
        return 2;
    }
    fap_take *truth = read_take(argv[1]), *got = read_take(argv[2]);
    const int compared = truth && got && take_compare(truth, got, &d);
    if (compared)
        printf("rms_mm %.4f p95_mm %.4f max_mm %.4f points %u samples %u missing %u worst %s at_s %.3f\n",
               d.rms_mm, d.p95_mm, d.max_mm, d.points, d.samples, d.missing, d.worst, d.worst_s);
    fap_take_close(&got);
    fap_take_close(&truth);
    return compared ? 0 : 1;
}
