/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * Feeds every file of the given folders to a fuzz target, then every prefix of the small ones and each with one byte turned
 * over: what "make test" runs where no libFuzzer is at hand.
 */
#include <dirent.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/file.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { MAX_INPUT = 1 << 20, MAX_VARIED = 512 };

/* A copy of exactly @p size bytes, so that a sanitizer sees a read past the end. */
static void feed(const uint8_t *data, size_t size)
{
    uint8_t *copy = calloc(size ? size : 1, 1);
    if (!copy)
        abort();
    memcpy(copy, data, size);
    LLVMFuzzerTestOneInput(copy, size);
    free(copy);
}

static void feed_variations(uint8_t *data, size_t size)
{
    const size_t varied = size < MAX_VARIED ? size : MAX_VARIED;

    for (size_t cut = 0; cut < varied; cut++)
        feed(data, cut);
    for (size_t i = 0; i < varied; i++) {
        data[i] ^= 0xff;
        feed(data, size);
        data[i] ^= 0xff;
    }
}

static int replay(const char *folder)
{
    DIR *dir = opendir(folder);
    int count = 0;

    for (struct dirent *e; dir && (e = readdir(dir));) {
        char path[4096];
        uint8_t *data;
        size_t size;
        snprintf(path, sizeof path, "%s/%s", folder, e->d_name);
        if (e->d_name[0] == '.' || file_read(path, MAX_INPUT, &data, &size) != FAP_OK)
            continue;
        feed(data, size);
        feed_variations(data, size);
        free(data);
        count++;
    }
    if (dir)
        closedir(dir);
    return count;
}

int main(int argc, char **argv)
{
    int count = 0;

    feed((const uint8_t *)"", 0);
    for (int i = 1; i < argc; i++)
        count += replay(argv[i]);
    printf("%d inputs\n", count);
    return count == 0;
}
