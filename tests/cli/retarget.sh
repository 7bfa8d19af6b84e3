# SPDX-License-Identifier: BSD-2-Clause
# fapbank retarget: a bank's motions on a larger head of its structure, and motions of a face of another structure on it.
. tests/cli/lib.bash

expect 2 "$B/fapbank" retarget
expect 2 "$B/fapbank" retarget builtin -o "$T/x.fbank"
says 'either --to'
expect 2 "$B/fapbank" retarget builtin --from "$T" -o "$T/x.fbank"
says 'landmarks'
expect 2 "$B/fapbank" retarget builtin --to "$T/a.obj" --unit mm -o "$T/x.fbank"
expect 0 "$B/fapbank" retarget --help

# The built-in face's vertices, a tenth larger: motions a tenth larger.
mask="0 0 1 $(printf '0 %.0s' $(seq 1 65))"
printf '2.1 rest 25 1\n%s\n0 0\n' "$mask" >"$T/rest.fap"
expect 0 "$B/fapplay" "$T/rest.fap" --bank builtin --frames 0:1 -o "$T/vertices.csv" --csv vertices --quiet
awk -F, 'NR > 1 { printf "v %.4f %.4f %.4f\n", 1.1 * $4, 1.1 * $5, 1.1 * $6 }' "$T/vertices.csv" >"$T/large.obj"
expect 0 "$B/fapbank" retarget builtin --to "$T/large.obj" -o "$T/large.fbank"
says 'times 1\.100: '
expect 0 "$B/fapbank" info "$T/large.fbank"
head -n 100 "$T/large.obj" >"$T/part.obj"
expect 1 "$B/fapbank" retarget builtin --to "$T/part.obj" -o "$T/x.fbank"
says 'not of one structure'
[ ! -e "$T/x.fbank" ] || fail "a failure left an output"

# A GLB of the player's own, in metres, back into a bank: the same motions, under the same names.
printf '2.1 rest 25 1\n%s\n0 0\n' "$mask" >"$T/again.fap"
expect 0 "$B/fapplay" "$T/again.fap" --bank builtin -o "$T/own.glb" --quiet

# Shapes of another structure: a scan, and the scan with its lower half pulled down.
scans=$FAP_SHARED/data/faces/scans
[ -d "$scans" ] || skip "no scans: $scans is not there"
points=$scans/ict_a_neutral_points.csv
mkdir "$T/shapes"
if ! "$B/fapbank" fit "$scans/ict_a_neutral.ply" --landmarks "$points" --bank builtin -o "$T/laid.obj" 2>"$T/err"; then
    grep -q 'without Embree' "$T/err" && skip "built without Embree"
    fail "no fit: $(cat "$T/err")"
fi
cp "$T/laid.obj" "$T/shapes/neutral.obj"
awk '$1 == "v" { d = $3 < -45 ? -8 : 0; print "v", $2, $3 + d, $4; next } { print }' "$T/laid.obj" >"$T/shapes/jawOpen.obj"
grep -E '^v' "$T/laid.obj" | awk 'NR % 40 == 0 { print "unknown" NR, $2, $3, $4 }' >"$T/odd.csv"
expect 1 "$B/fapbank" retarget builtin --from "$T/shapes" --landmarks "$T/odd.csv" -o "$T/x.fbank"
# Feature points of the laid face are those of the built-in one: the same vertices.
"$B/fapplay" "$T/rest.fap" --bank builtin --frames 0:1 -o "$T/points.csv" --csv points --quiet
awk -F, 'NR == FNR { if (FNR > 1) { x[FNR - 2] = $4; y[FNR - 2] = $5; z[FNR - 2] = $6; n = FNR - 1 }; next }
    FNR == 1 { for (i = 3; i <= NF; i += 3) { name[i] = substr($i, 1, length($i) - 2) }; next }
    FNR == 2 { for (i = 3; i <= NF; i += 3) for (v = 0; v < n; v++)
        if (($i - x[v])^2 + ($(i + 1) - y[v])^2 + ($(i + 2) - z[v])^2 < 1e-4) { print name[i] "," v; break } }' \
    "$T/vertices.csv" "$T/points.csv" | grep -E '^(2\.1|2\.10|3\.7|3\.8|3\.11|3\.12|8\.3|8\.4|9\.3|9\.1|9\.2|4\.1|4\.2|5\.3|5\.4|10\.7|10\.8),' >"$T/marks.csv"
[ "$(wc -l <"$T/marks.csv")" -ge 8 ] || fail "only $(wc -l <"$T/marks.csv") landmarks"
expect 0 "$B/fapbank" retarget builtin --from "$T/shapes" --landmarks "$T/marks.csv" -o "$T/spoken.fbank" --json
says '"motions": 1'
expect 0 "$B/fapbank" info "$T/spoken.fbank"
says 'unit +jawOpen'

# The GLB has a metre as its unit and its vertices in the bank's order.
expect 0 "$B/fapbank" retarget builtin --from "$T/own.glb" --landmarks "$T/marks.csv" --unit m -o "$T/own.fbank" --json
says '"motions": [5-9][0-9]'
expect 0 "$B/fapbank" info "$T/own.fbank"
says 'expression joy'
says 'unit +jawOpen'

# The same faces as banks of their own structure: a folder, a file; every part and point found again.
cp "$T/laid.obj" "$T/shapes/neutral.obj"
expect 2 "$B/fapbank" build "$T/shapes" -o "$T/folder.fbank"
says '--landmarks'
expect 0 "$B/fapbank" build "$T/shapes" --landmarks "$T/marks.csv" --bank builtin -o "$T/folder.fbank"
expect 0 "$B/fapbank" info "$T/folder.fbank"
says 'unit +jawOpen .* 8\.0 mm'
says 'points +84 of 84'
says 'eye_left [1-9].*teeth_lower [1-9]'
expect 0 "$B/fapbank" build "$T/own.glb" --landmarks "$T/marks.csv" --bank builtin --unit m -o "$T/file.fbank"
expect 0 "$B/fapbank" info "$T/file.fbank"
says 'expression joy'
expect 1 "$B/fapbank" build "$T/own.glb" --landmarks "$T/odd.csv" --bank builtin -o "$T/no.fbank"
[ ! -e "$T/no.fbank" ] || fail "a face without landmarks left a bank"
status=0
"$B/fapbank" retarget builtin --from "$T/shapes" --landmarks "$T/marks.csv" -o "$T/shown.fbank" --pictures "$T/pictures" >"$T/out" 2>"$T/err" || status=$?
[ "$status" -eq 3 ] && skip "no OpenGL here: $(tail -n 1 "$T/err")"
[ "$status" -eq 0 ] || fail "pictures give $status: $(cat "$T/err")"
[ "$(head -c 4 "$T/pictures/jawOpen.png" | tail -c 3)" = PNG ] || fail "no picture of jawOpen"
