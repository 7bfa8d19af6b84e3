/* SPDX-License-Identifier: BSD-2-Clause */
/* Landmarks: read, and named on the built-in face. */
#include <stddef.h>
#include <stdint.h>

#include <fap/studio/landmarks.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static fap_bank *bank; /* read only */
    fap_pin pin[FAP_POINT_COUNT];
    char where[FAP_ERROR_TEXT_SIZE];
    uint32_t count;
    fap_take *t;

    if (!bank && fap_bank_builtin(&bank, NULL) != FAP_OK)
        return 0;
    if (fap_landmarks_read(&t, data, size, NULL, NULL, where) != FAP_OK)
        return 0;
    (void)!fap_landmarks_pin(t, bank, pin, &count, where);
    fap_take_close(&t);
    return 0;
}
