# SPDX-License-Identifier: BSD-2-Clause
# Text to bits and back: without loss at --quant 0, within half a step otherwise; broken bits are named.
. tests/cli/lib.bash

# A wave on every tenth FAP, small enough for an I plane.
awk 'BEGIN {
    print "2.1 wave 25 300"
    for (f = 0; f < 300; f++) {
        mask = ""; values = f
        for (fap = 1; fap <= 68; fap++) {
            on = fap % 10 == 3
            mask = mask (fap > 1 ? " " : "") on
            if (on) values = values " " int(500 * sin(f / 10 + fap))
        }
        print mask; print values
    }
}' >"$T/a.fap"

expect 0 "$B/fapenc" "$T/a.fap" --quant 0 -o "$T/a.fba"
says 'I planes'
expect 0 "$B/fapenc" "$T/a.fba" -o "$T/b.fap"
cmp -s <(tail -n +2 "$T/a.fap") <(tail -n +2 "$T/b.fap") || fail "--quant 0 is not without loss"
expect 0 "$B/fapenc" inspect "$T/a.fba"
says '300 frames at 25 Hz'
# And from there on: bits, text and bits hold the same.
expect 0 "$B/fapenc" "$T/b.fap" --quant 0 -o "$T/b.fba"
cmp -s "$T/a.fba" "$T/b.fba" || fail "text made of bits becomes other bits"
expect 0 "$B/fapenc" "$T/a.fba" --quant 0 --intra 40 --plane-codes -o "$T/d.fba"
expect 0 "$B/fapenc" "$T/d.fba" -o "$T/d.fap"
cmp -s <(tail -n +2 "$T/a.fap") <(tail -n +2 "$T/d.fap") || fail "bits to bits at --quant 0 is not without loss"

# A still face: frames that change nothing are left out, and are there again in the text, each in its place.
awk 'NR == 1 { print } NR > 1 && NR % 2 == 0 { print } NR > 1 && NR % 2 { f = (NR - 3) / 2; v = f < 100 ? 50 : f < 200 ? 51 + f : 40
    n = NF; $1 = f; for (i = 2; i <= n; i++) $i = v; print }' "$T/a.fap" >"$T/still.fap"
expect 0 "$B/fapenc" "$T/still.fap" --bitrate 8 --skip -o "$T/still.fba"
says ' [0-9]{2,} skipped'
expect 0 "$B/fapenc" "$T/still.fba" -o "$T/held.fap"
awk 'NR > 1 && NR % 2 { if ($1 != (NR - 3) / 2 || NF != 8) bad = 1 } END { exit bad || NR != 601 }' "$T/held.fap" ||
    fail "skipped frames are not held in the text"
expect 0 "$B/fapplay" "$T/still.fba" --bank builtin -o "$T/still.csv"
expect 0 "$B/fapplay" "$T/held.fap" --bank builtin -o "$T/held.csv"
cmp -s "$T/still.csv" "$T/held.csv" || fail "skipped frames play differently from held ones"
expect 0 "$B/fapenc" "$T/a.fap" --quant 8 --intra 50 -o "$T/c.fba"
[ "$(stat -c %s "$T/c.fba")" -lt "$(stat -c %s "$T/a.fba")" ] || fail "a coarser quantiser saves nothing"
expect 0 "$B/fapenc" "$T/c.fba" -o - --quiet
[ "$(wc -l <"$T/out")" -eq 601 ] || fail "frames are missing"

head -c 8 "$T/a.fba" >"$T/cut.fba"
expect 1 "$B/fapenc" inspect "$T/cut.fba"
says 'cut.fba'
expect 2 "$B/fapenc" "$T/a.fap" --quant 32 -o "$T/x.fba"
[ ! -e "$T/x.fba" ] || fail "a failed run left an output"

# --strict: what is tolerated otherwise is an error, with its place.
tail -c +5 "$T/a.fba" | cat <(printf '\0\0\1\1') - >"$T/draft.fba"
expect 0 "$B/fapenc" "$T/draft.fba" -o "$T/draft.fap"
says 'bit [0-9]+: .*draft'
expect 1 "$B/fapenc" "$T/draft.fba" --strict -o "$T/x.fap"
says 'draft.fba: .*draft'
expect 1 "$B/fapenc" inspect "$T/draft.fba" --strict
sed 1d "$T/a.fap" >"$T/headless.fap"
expect 1 "$B/fapenc" "$T/headless.fap" --strict -o "$T/x.fap"
says 'headless.fap: line 1'
[ ! -e "$T/x.fap" ] || fail "a failed run left an output"

# fapplay shows an .fba as it shows the .fap made from it.
expect 0 "$B/fapenc" tests/assets/demo_take.c3d --markers tests/assets/demo_markers.csv -o "$T/play.fba"
expect 0 "$B/fapenc" "$T/play.fba" -o "$T/play.fap"
expect 0 "$B/fapplay" "$T/play.fba" --bank builtin -o "$T/bits.csv"
expect 0 "$B/fapplay" "$T/play.fap" --bank builtin -o "$T/text.csv"
cmp -s "$T/bits.csv" "$T/text.csv" || fail "an .fba plays differently from its .fap"
head -c 2000 "$T/play.fba" >"$T/cut.fba"
expect 0 "$B/fapplay" "$T/cut.fba" --bank builtin -o "$T/cut.csv"
says 'broken'
