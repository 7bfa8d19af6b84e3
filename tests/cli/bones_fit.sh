# SPDX-License-Identifier: BSD-2-Clause
# fapbank fit --method lorenzo by both optimizers; fapbank masks: lips and lids of a face of another structure, and a bank made
# with them.
. tests/cli/lib.bash

expect 2 "$B/fapbank" fit x.ply --landmarks p.csv -o x.obj --method lorenzo --optimizer best
says 'lbfgs or simplex'
expect 2 "$B/fapbank" fit x.ply --landmarks p.csv -o x.obj --method lorenzo --control 5
says '12 to 4000'
expect 2 "$B/fapbank" masks
says 'masks for what'
expect 2 "$B/fapbank" masks x.obj -o x.csv
says 'landmarks'
expect 2 "$B/fapbank" masks x.obj --landmarks p.csv
says 'where to'
expect 2 "$B/fapbank" masks x.obj y.obj --landmarks p.csv -o x.csv
expect 2 "$B/fapbank" masks x.obj --landmarks p.csv -o x.csv --method best
expect 2 "$B/fapbank" masks x.obj --landmarks p.csv -o x.csv --unit ell
expect 1 "$B/fapbank" masks "$T/nowhere.obj" --landmarks p.csv --bank builtin -o "$T/x.csv"
says 'nowhere'
expect 0 "$B/fapbank" masks --help

# A recipe takes masks, and refuses what is none.
printf 'v %s 0\n' '31 5' '-31 5' '31 -5' '-31 -5' '31 0' '-31 0' '0 -48' '0 -68' '25 -70' '-25 -70' >"$T/flat.obj"
printf 'f 1 2 3\nf 4 5 6\nf 7 8 9\nf 8 9 10\n' >>"$T/flat.obj"
printf 'vertex,side\n7,lip_upper\n8,lip_upper\n6,lip_lower\n' >"$T/flat.csv"
{
    printf 'fapbank recipe\nmesh flat.obj\n'
    printf 'point %s\n' '3.1 0' '3.2 1' '3.3 2' '3.4 3' '3.5 4' '3.6 5' '9.15 6' '2.2 7' '8.3 8' '8.4 9'
    printf 'masks flat.csv\n'
} >"$T/flat.recipe"
expect 0 "$B/fapbank" build "$T/flat.recipe" -o "$T/flat.fbank"
expect 0 "$B/fapbank" info "$T/flat.fbank"
says 'lip_upper 2, lip_lower 1,'
printf '10,lip_upper\n' >"$T/flat.csv"
expect 1 "$B/fapbank" build "$T/flat.recipe" -o "$T/x.fbank"
says 'flat.recipe:13'

scans=$FAP_SHARED/data/faces/scans
[ -d "$scans" ] || skip "no scans: $scans is not there"
scan=$scans/ict_a_neutral.ply points=$scans/ict_a_neutral_points.csv
if ! "$B/fapbank" fit "$scan" --landmarks "$points" --bank builtin --method lorenzo -o "$T/anna.obj" --json >"$T/out" 2>"$T/err"; then
    grep -q 'without Embree' "$T/err" && skip "built without Embree"
    fail "no fit: $(cat "$T/err")"
fi
number() { grep -o "\"$1\": [-0-9.e]*" "$T/out" | grep -o '[-0-9.e]*$'; }
awk "BEGIN { exit !($(number surface_rms_mm) < 1) }" || fail "the face is $(number surface_rms_mm) mm off the scan"
expect 0 "$B/fapbank" fit "$scan" --landmarks "$points" --bank builtin --method lorenzo --optimizer simplex \
    --control 60 -o "$T/slow.obj"
says 'lorenzo on '

expect 0 "$B/fapbank" masks "$scan" --landmarks "$points" --bank builtin -o "$T/anna.csv" --pictures "$T/pictures" --json
for side in lip_upper lip_lower lid_upper_left lid_lower_left lid_upper_right lid_lower_right; do
    grep -q ",$side\$" "$T/anna.csv" || fail "no vertex of $side"
done
for name in masks laid; do
    [ "$(head -c 4 "$T/pictures/$name.png" | tail -c 3)" = PNG ] || fail "no picture of $name"
done
