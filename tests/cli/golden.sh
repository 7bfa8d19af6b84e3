# SPDX-License-Identifier: BSD-2-Clause
# Golden pictures notice a change, say where it can be seen, and leave nothing behind when all is well.
. tests/cli/lib.bash
play="$B/fapplay --bank builtin --size 64x64"

status=0
$play tests/golden/blink/stream.fap --golden "$T/g" --update >"$T/out" 2>"$T/err" || status=$?
[ "$status" -eq 3 ] && skip "no OpenGL in this build"
[ "$status" -eq 0 ] || fail "--update: exit $status: $(cat "$T/err")"
[ "$(ls "$T/g")" = "$(printf '0000.png\n0001.png\n0002.png')" ] || fail "--update left $(ls "$T/g")"

expect 0 $play tests/golden/blink/stream.fap --golden "$T/g" -o "$T/left"
[ ! -e "$T/left" ] || fail "the same pictures left something"
expect 1 $play tests/golden/jaw/stream.fap --golden "$T/g" -o "$T/left"
[ -s "$T/left/0000.got.png" ] && [ -s "$T/left/0000.diff.png" ] || fail "a difference left nothing to see"

rm "$T/g/0002.png"                              # one is missing
expect 1 $play tests/golden/blink/stream.fap --golden "$T/g" -o "$T/left"
says '1 of 3'
echo damaged >"$T/g/0002.png"                   # or is none
expect 1 $play tests/golden/blink/stream.fap --golden "$T/g" -o "$T/left" --json
says '"different": 1'
expect 1 $play --size 65x65 tests/golden/blink/stream.fap --golden "$T/g" -o "$T/left"
says '3 of 3'
