# SPDX-License-Identifier: BSD-2-Clause
# A take becomes FAPs: the demo take, from file and from standard input, whole or not at all.
. tests/cli/lib.bash
take=tests/assets/demo_take.c3d

expect 0 "$B/fapenc" "$take" --markers tests/assets/demo_markers.csv --fps 25 -o "$T/a.fap"
says 'head: .*rms'
says 'FAPU'
expect 0 "$B/fapenc" inspect "$T/a.fap" --json
python3 - "$T/out" <<'P' 2>/dev/null || says '"frames"'
import json, sys
j = json.load(open(sys.argv[1]))
assert j["rate_hz"] == 25, j
P
# What 56 markers on skin and lids determine is there, inner lips after the outer ones; the tongue is not invented.
mask=$(sed -n 2p "$T/a.fap")
on() { [ "$(echo "$mask" | cut -d' ' -f"$1")" = 1 ]; }
for fap in 3 19 20 31 33 35 48 49 50 51 52 53 54 59 60; do on "$fap" || fail "FAP $fap was not found"; done
for fap in 4 5; do on "$fap" || fail "FAP $fap does not follow the outer lip"; done
for fap in 43 46 47; do on "$fap" && fail "FAP $fap was invented"; done

# The same take twice gives the same bytes.
expect 0 "$B/fapenc" "$take" --markers tests/assets/demo_markers.csv --fps 25 -o "$T/b.fap" --quiet
[ ! -s "$T/err" ] || fail "--quiet speaks: $(cat "$T/err")"
cmp -s <(tail -n +2 "$T/a.fap") <(tail -n +2 "$T/b.fap") || fail "two runs differ"

# The nose's tip may carry the head; its own FAPs are then not sent.
expect 0 "$B/fapenc" "$take" --markers tests/assets/demo_markers.csv --head nose -o "$T/n.fap"
says "carried by the nose's tip"
says 'not sent: .*64.*--head nose'
[ "$(sed -n 2p "$T/n.fap" | cut -d' ' -f48)" = 1 ] || fail "--head nose loses the head's turning"
expect 2 "$B/fapenc" "$take" --head sideways -o "$T/n.fap"

# Cut short: named, and no output.
head -c 3000 "$take" >"$T/cut.c3d"
rm -f "$T/c.fap"
"$B/fapenc" "$T/cut.c3d" --markers tests/assets/demo_markers.csv -o "$T/c.fap" >"$T/out" 2>"$T/err" && status=0 || status=$?
[ "$status" -le 1 ] || fail "a cut take ends with $status"
[ "$status" -eq 1 ] && [ -e "$T/c.fap" ] && fail "a failed run left an output"

# An output folder that is not there.
expect 1 "$B/fapenc" "$take" --markers tests/assets/demo_markers.csv -o "$T/nowhere/x.fap"
says 'nowhere'
