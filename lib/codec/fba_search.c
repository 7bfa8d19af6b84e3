/* SPDX-License-Identifier: BSD-2-Clause */
/* See fba_search.h. */
#include "codec/fba_search.h"

int fap_fba_search_open(fap_encoder *e)
{
    (void)e;
    return 1;
}

void fap_fba_search_close(fap_encoder *e)
{
    (void)e;
}

int fap_fba_thin(fap_encoder *e, const fap_frame *want, const fba_coded_list *list, int32_t *level,
                 int strength)
{
    (void)e, (void)want, (void)list, (void)level;
    return strength < 0;
}
