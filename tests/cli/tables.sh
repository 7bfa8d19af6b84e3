# SPDX-License-Identifier: BSD-2-Clause
# A bad cell in a table of the standard stops the build, with its place.
. tests/cli/lib.bash
bad() {         # bad TEXT...: a table that csv2c must refuse
    printf '%b' "$1" >"$T/t.csv"
    expect 1 "$B/gen/csv2c" "$T/t.csv" t "$T/t.h"
    says "t.csv:$2"
}
bad 'a:u8\n256\n' 2
bad 'a:u8\nx\n' 2
bad '# remark\na:u8,b:str\n1\n' 3
bad 'a:point\n8-4\n' 2
bad 'a:colour\n1\n' 2
bad 'a:str\n"open\n' 2
printf 'a:u8,b:str,c:point,d:skip\n1,"x ""y"", z",8.4,why\n' >"$T/t.csv"
expect 0 "$B/gen/csv2c" "$T/t.csv" t "$T/t.h"
grep -qF 'X(1, "x \"y\", z", POINT(8, 4))' "$T/t.h" || fail "$(cat "$T/t.h")"
