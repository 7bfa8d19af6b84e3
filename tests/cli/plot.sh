# SPDX-License-Identifier: BSD-2-Clause
# fapenc --plot: curves as PNG and SVG, of captures and of streams.
. tests/cli/lib.bash
take=tests/assets/demo_take.c3d markers=tests/assets/demo_markers.csv

"$B/fapenc" "$take" --markers $markers -o "$T/a.fap" --plot "$T/a.png" --quiet 2>"$T/err" || {
    grep -q 'built without cairo' "$T/err" && skip "built without cairo"
    fail "no plot: $(cat "$T/err")"
}
[ "$(head -c 4 "$T/a.png" | tail -c 3)" = PNG ] || fail "a.png is no PNG"

# A stream has curves too; the same frames, the same picture of them.
expect 0 "$B/fapenc" "$T/a.fap" -o "$T/b.fba" --quant 0 --plot "$T/b.svg"
grep -q '</svg>' "$T/b.svg" || fail "b.svg does not end"
[ "$(grep -o '<path' "$T/b.svg" | wc -l)" -gt 50 ] || fail "b.svg has no curves"

expect 2 "$B/fapenc" "$take" -o "$T/c.fap" --plot "$T/c.jpg"
says '\.png or \.svg'
expect 1 "$B/fapenc" "$T/a.fap" -o "$T/d.fap" --plot "$T/nowhere/d.png"
says 'nowhere'
expect 2 "$B/fapenc" inspect "$T/a.fap" --plot "$T/e.png"
[ -z "$(ls "$T" | grep -vE '^(a|b|d)\.|^out$|^err$')" ] || fail "left behind: $(ls "$T")"

# Markers that have a place on the face are shown on it, above the curves; curves alone have none.
height() { grep -o 'height="[0-9.]*' "$1" | head -1 | tr -dc 0-9; }
expect 0 "$B/fapenc" "$take" --markers $markers -o "$T/f.fap" --plot "$T/f.svg"
expect 0 "$B/fapenc" "$T/f.fap" -o "$T/g.fba" --plot "$T/g.svg"
[ "$(height "$T/f.svg")" -ge $(($(height "$T/g.svg") + 600)) ] || fail "no map of the markers"
[ "$(grep -c '<image' "$T/f.svg")" -ge 2 ] || fail "the map has no face"
