# SPDX-License-Identifier: BSD-2-Clause
# A take of 200 markers is told in a page, the worst first; --json has every one.
. tests/cli/lib.bash

# A cap, corners of the mouth, brows and a chin, and 190 dots besides, the n-th of which is hidden for n frames of 300.
awk 'BEGIN {
    split("Cap1 Cap2 Cap3 Cap4 8.3 8.4 4.1 4.2 2.1 9.3", name, " ")
    split("70 110 20 -70 110 20 0 130 60 0 100 -60 25 -20 83 -25 -20 83 12 60 88 -12 60 88 0 -60 80 0 8 105", at, " ")
    for (i = 11; i <= 200; i++) {
        name[i] = sprintf("Dot%03d", i - 10)
        at[3*i-2] = (i % 15 - 7) * 8; at[3*i-1] = (i / 15 - 7) * 10; at[3*i] = 80 + i % 7
    }
    line = "frame"
    for (i = 1; i <= 200; i++) line = line "," name[i] "_x," name[i] "_y," name[i] "_z"
    print line
    for (f = 0; f < 300; f++) {
        line = f
        for (i = 1; i <= 200; i++) {
            if (i > 10 && f >= 50 && f < 50 + i - 10) { line = line ",,,"; continue }
            talk = i > 4 && at[3*i-1] < 0 ? sin(f / 9) * at[3*i-1] / 8 : 0
            line = line "," at[3*i-2] + sin(f / 40) * 9 "," at[3*i-1] + talk "," at[3*i]
        }
        print line
    }
}' >"$T/many.csv"
printf 'Cap1,rigid\nCap2,rigid\nCap3,rigid\nCap4,rigid\n' >"$T/map.csv"
expect 0 "$B/fapenc" "$T/many.csv" --markers "$T/map.csv" --fps 30 --take-rate 60 -o "$T/a.fap"
lines=$(wc -l <"$T/err")
[ "$lines" -lt 80 ] || fail "the report has $lines lines"
says 'not used: Dot001, .*Dot012 and 178 more'
says 'and 178 more markers, touched less: --json has all'
dots=$(grep -cE '  Dot[0-9]+ +[0-9]+ spikes' "$T/err")
[ "$dots" = 12 ] || fail "$dots markers are told, not 12"
grep -E '  Dot[0-9]+ +[0-9]+ spikes' "$T/err" | head -n 1 | grep -qE 'Dot190 .* the longest 3\.17 s' ||
    fail "the worst is not the first: $(grep -m 1 -E '  Dot[0-9]+ +[0-9]+ spikes' "$T/err")"

expect 0 "$B/fapenc" "$T/many.csv" --markers "$T/map.csv" --fps 30 --take-rate 60 --json -o "$T/b.fap"
python3 - "$T/out" <<'P' || fail "--json does not have all"
import json, sys
j = json.load(open(sys.argv[1]))
c = j["cleaning"]["markers"]
assert len(c) == 190 and c["Dot007"]["longest_gap"] == 7 and len(j["markers"]["unknown"]) == 190, len(c)
assert len(j["head"]["rigid"]) >= 4
P
