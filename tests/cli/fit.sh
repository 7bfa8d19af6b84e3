# SPDX-License-Identifier: BSD-2-Clause
# Interpolation tables: learnt from a take and written beside the stream, found there, given, and wrong ones named.
. tests/cli/lib.bash

# FAP 4 follows FAP 3 and FAP 63 follows both: no side and no lip gives them.
awk 'BEGIN {
    print "2.1 follow 25 200"
    for (f = 0; f < 200; f++) {
        mask = ""
        for (fap = 1; fap <= 68; fap++) mask = mask (fap > 1 ? " " : "") (fap == 3 || fap == 31 || fap == 63)
        jaw = int(400 * sin(f / 7)); brow = int(300 * sin(f / 11))
        print mask; print f, jaw, brow, jaw * 2
    }
}' >"$T/a.fap"

expect 0 "$B/fapenc" "$T/a.fap" --quant 1 -o "$T/plain.fba" --quiet
expect 0 "$B/fapenc" "$T/a.fap" --quant 1 --learn-fit "$T/a.fit" -o "$T/a.fba"
says 'a.fit: a table that gives [1-9]'
says '[1-9][0-9]* values left to the decoder'
grep -q '^fap-fit 1' "$T/a.fit" || fail "the table is not one: $(head -1 "$T/a.fit")"
[ "$(stat -c %s "$T/a.fba")" -lt "$(stat -c %s "$T/plain.fba")" ] || fail "the table saves nothing"

# Found beside the stream: the text has all three FAPs again, close to what they were.
expect 0 "$B/fapenc" "$T/a.fba" -o "$T/back.fap"
says 'interpolates by .*a.fit'
paste -d' ' <(awk 'NR > 1 && NR % 2' "$T/a.fap") <(awk 'NR > 1 && NR % 2' "$T/back.fap") |
    awk 'NF != 8 { bad = 1 } { for (i = 2; i <= 4; i++) { d = $i - $(i + 4); if (d > 40 || d < -40) bad = 1 } } END { exit bad }' ||
    fail "FAPs are missing or far off"
expect 0 "$B/fapenc" inspect "$T/a.fba"
says 'interpolates by .*a.fit'
says 'derived by the decoder in 200 frames'
expect 0 "$B/fapplay" "$T/a.fba" --bank builtin -o "$T/fit.csv"
says 'interpolates by .*a.fit'

# Elsewhere it has to be given, and the encoder says so.
mkdir "$T/far"
expect 0 "$B/fapenc" "$T/a.fap" --quant 1 --fit "$T/a.fit" -o "$T/far/b.fba"
says 'needs --fit .*a.fit'
cmp -s "$T/a.fba" "$T/far/b.fba" || fail "the same table, learnt and given, makes two streams"
expect 0 "$B/fapplay" "$T/far/b.fba" --fit "$T/a.fit" --bank builtin -o "$T/given.csv"
cmp -s "$T/fit.csv" "$T/given.csv" || fail "a table given and one found play differently"
expect 0 "$B/fapplay" "$T/far/b.fba" --bank builtin -o "$T/without.csv"
cmp -s "$T/fit.csv" "$T/without.csv" && fail "the table changes nothing"
expect 0 "$B/fapplay" "$T/back.fap" --bank builtin -o "$T/text.csv"
cmp -s "$T/fit.csv" "$T/text.csv" || fail "the text plays differently from the stream it was made from"

# A table that lies where another is meant is warned of.
cp "$T/a.fit" "$T/far/a.fit"
expect 0 "$B/fapenc" "$T/a.fap" --quant 1 --fit "$T/a.fit" -o "$T/far/a.fba"
says 'warning: .*was not made with .*far/a.fit'

# Wrong tables: line and column; nothing is written.
printf 'fap-fit 1\nfrom f3\n    f4 = 2*f5\n' >"$T/bad.fit"
expect 1 "$B/fapenc" "$T/a.fap" --fit "$T/bad.fit" -o "$T/x.fba"
says 'bad.fit: .*line 3'
expect 1 "$B/fapplay" "$T/a.fba" --fit "$T/bad.fit" --bank builtin -o "$T/x.csv"
says 'bad.fit: .*line 3'
expect 1 "$B/fapplay" "$T/a.fba" --fit "$T/no.fit" --bank builtin -o "$T/x.csv"
says 'no.fit'
expect 1 "$B/fapenc" "$T/a.fap" --learn-fit "$T/nowhere/a.fit" -o "$T/x.fba"
says 'nowhere/a.fit: No such file'
expect 1 "$B/fapenc" "$T/a.fap" --learn-fit "$T/x.fit" -o "$T/nowhere/x.fba"
says 'nowhere/x.fba: No such file'
expect 2 "$B/fapenc" "$T/a.fap" --learn-fit "$T/x.fit" -o "$T/x.fap"
says 'learn-fit'
expect 2 "$B/fapenc" "$T/a.fap" --learn-fit "$T/x.fba" -o "$T/x.fba"
[ -z "$(cd "$T" && ls | grep '^x\.')" ] || fail "failed runs left $(cd "$T" && ls | grep '^x\.')"
