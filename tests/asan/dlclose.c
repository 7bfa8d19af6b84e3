/* SPDX-License-Identifier: BSD-2-Clause */
/*
 * In sanitizer builds of fapplay nothing is unloaded: a leak inside a graphics driver that is gone by then has no name, and what
 * has none cannot be told from ours in tests/lsan.supp.
 */
int dlclose(void *handle);

__attribute__((visibility("default"))) int dlclose(void *handle)
{
    (void)handle;
    return 0;
}
