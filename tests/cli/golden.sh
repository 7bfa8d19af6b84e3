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
for kind in golden got diff side; do
    [ -s "$T/left/0000.$kind.png" ] || fail "a difference left no 0000.$kind.png"
done
cmp -s "$T/left/0000.golden.png" "$T/left/0000.got.png" && fail "got is golden"
grep -q '1 of 1 pictures differ' "$T/left/golden-report.html" || fail "the page says $(grep -o '[0-9]* of [0-9]*' "$T/left/golden-report.html")"
for name in $(grep -o '"[0-9]*\.[a-z]*\.png"' "$T/left/golden-report.html" | tr -d '"'); do
    [ -s "$T/left/$name" ] || fail "the page shows $name, which is not there"
done
expect 1 $play tests/golden/blink/stream.fap --frames 1:2 --golden "$T/g" -o "$T/left" --camera left
[ ! -e "$T/left/0000.got.png" ] || fail "a picture of the comparison before is left"
says 'structure down to -?0'
expect 0 $play tests/golden/blink/stream.fap --golden "$T/g" -o "$T/left"
[ ! -e "$T/left/golden-report.html" ] || fail "the page of the comparison before is left"

rm "$T/g/0002.png"                              # one is missing
expect 1 $play tests/golden/blink/stream.fap --golden "$T/g" -o "$T/left"
says '1 of 3'
echo damaged >"$T/g/0002.png"                   # or is none
expect 1 $play tests/golden/blink/stream.fap --golden "$T/g" -o "$T/left" --json
says '"different": 1'
expect 1 $play --size 65x65 tests/golden/blink/stream.fap --golden "$T/g" -o "$T/left"
says '3 of 3'

# An update writes what changed and nothing else, and shows what it replaced.
expect 0 $play tests/golden/blink/stream.fap --golden "$T/u" --update
touch -d '2 hours ago' "$T/u"/*.png
cp -p "$T/u/0000.png" "$T/before.png"
cp "$T/g/0000.png" "$T/u/0001.png"
expect 0 $play tests/golden/blink/stream.fap --golden "$T/u" --update -o "$T/replaced"
says '1 written, 2 the same'
[ ! "$T/u/0000.png" -nt "$T/before.png" ] || fail "a picture that was the same was written"
grep -q 'They have been replaced' "$T/replaced/golden-report.html" || fail "the page of an update says something else"

# Pictures of a longer stream are mentioned, and harm nobody.
cp "$T/u/0000.png" "$T/u/0009.png"
cp "$T/u/0000.png" "$T/u/notes.png"
expect 0 $play tests/golden/blink/stream.fap --golden "$T/u"
says '1 more there, of frames that were not shown'

# Names that HTML would take for its own.
mkdir "$T/<i>&"
expect 1 $play tests/golden/blink/stream.fap --golden "$T/<i>&" -o "$T/odd"
grep -q '&lt;i&gt;&amp;' "$T/odd/golden-report.html" || fail "the page takes a name for HTML"

# What is somebody else's stays; folders that cannot be are refused.
mkdir "$T/pub"
echo mine >"$T/pub/index.html"
expect 1 $play tests/golden/blink/stream.fap --golden "$T/u" --camera left -o "$T/pub"
expect 0 $play tests/golden/blink/stream.fap --golden "$T/u" -o "$T/pub"
[ "$(ls "$T/pub")" = index.html ] || fail "left in the folder: $(ls "$T/pub")"
expect 2 $play tests/golden/blink/stream.fap --golden "$T/u" -o "$T/u/."
expect 2 $play tests/golden/blink/stream.fap --golden "$T/u" -o "$T/x.mp4"
expect 1 $play tests/golden/blink/stream.fap --golden "$T/no-such"
says 'no such folder; --update'

# However many shades are allowed, a mouth that opens is another picture.
expect 0 $play tests/golden/neutral/stream.fap --frames 0:1 --size 256x256 --golden "$T/n" --update
expect 1 $play tests/golden/viseme_pp/stream.fap --frames 0:1 --size 256x256 --golden "$T/n" --tolerance 255
