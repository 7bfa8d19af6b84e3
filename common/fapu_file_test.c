/* SPDX-License-Identifier: BSD-2-Clause */
/* FAPU files. */
#include "tests/test.h"

#include <string.h>

#include "common/fapu_file.h"

TEST(fapu_file, reads_what_people_write)
{
    char where[FAP_ERROR_TEXT_SIZE];
    fap_fapu f;

    assert_int_equal(
        fapu_file_parse("# Anna\nirisd0 = 11.5\r\nES, 62\n\nENS: 47.5\nMNS\t20\nMW 51", &f, where), FAP_OK);
    assert_float_equal(f.irisd_mm, 11.5, 1e-6);
    assert_float_equal(f.es_mm, 62, 1e-6);
    assert_float_equal(f.mw_mm, 51, 1e-6);
}

TEST(fapu_file, says_what_is_missing_or_wrong)
{
    char where[FAP_ERROR_TEXT_SIZE];
    fap_fapu f;

    assert_int_equal(fapu_file_parse("ES 62\n", &f, where), FAP_E_SYNTAX);
    assert_non_null(strstr(where, "IRISD"));
    assert_int_equal(fapu_file_parse("ES 62\nES x\n", &f, where), FAP_E_SYNTAX);
    assert_non_null(strstr(where, "line 2"));
    assert_int_equal(fapu_file_parse("ES -1\n", &f, where), FAP_E_SYNTAX);
    assert_int_equal(fapu_file_parse("EYES 62\n", &f, where), FAP_E_SYNTAX);
}
