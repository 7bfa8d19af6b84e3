# SPDX-License-Identifier: BSD-2-Clause
# fapbank fit: a face onto a scan, in words, as JSON, as pictures; a bank comes out that plays.
. tests/cli/lib.bash

expect 2 "$B/fapbank" fit
says 'what to fit to'
expect 2 "$B/fapbank" fit x.ply -o x.obj
says 'landmarks'
expect 2 "$B/fapbank" fit x.ply --landmarks p.csv -o x.stl
says '\.obj, \.ply or \.fbank'
expect 2 "$B/fapbank" fit x.ply --landmarks p.csv -o x.obj --method best
expect 1 "$B/fapbank" fit "$T/nowhere.ply" --landmarks p.csv --bank builtin -o "$T/x.obj"
says 'nowhere'
expect 2 "$B/fapbank" fit x.ply --landmarks p.csv -o x.fbank --method zhu --subdivide 1
expect 2 "$B/fapbank" fit x.ply --landmarks p.csv -o x.obj --subdivide 1
expect 0 "$B/fapbank" fit --help

scans=$FAP_SHARED/data/faces/scans
[ -d "$scans" ] || skip "no scans: $scans is not there"
scan=$scans/ict_a_neutral.ply points=$scans/ict_a_neutral_points.csv

printf '8.3,1,2,3\n' >"$T/one.csv"
expect 1 "$B/fapbank" fit "$scan" --landmarks "$T/one.csv" --bank builtin -o "$T/x.obj"
says 'three are the least'
[ ! -e "$T/x.obj" ] || fail "a failure left an output"

if ! "$B/fapbank" fit "$scan" --landmarks "$points" --bank builtin -o "$T/anna.obj" --json >"$T/out" 2>"$T/err"; then
    grep -q 'without Embree' "$T/err" && skip "built without Embree"
    fail "no fit: $(cat "$T/err")"
fi
number() { grep -o "\"$1\": [-0-9.e]*" "$T/out" | grep -o '[-0-9.e]*$'; }
awk "BEGIN { exit !($(number surface_rms_mm) < 0.8) }" || fail "the face is $(number surface_rms_mm) mm off the scan"
grep -c '^v ' "$T/anna.obj" >"$T/count"
expect 0 "$B/fapbank" fit "$scan" --landmarks "$points" --bank builtin -o "$T/anna.fbank" --pictures "$T/pictures"
says 'surface: 0\.'
for name in points before after wireframe distances; do
    [ "$(head -c 4 "$T/pictures/$name.png" | tail -c 3)" = PNG ] || fail "no picture of $name"
done
expect 0 "$B/fapbank" info "$T/anna.fbank"
expect 0 "$B/fapplay" tests/assets/moments.fap --bank "$T/anna.fbank" -o "$T/points.csv" --csv points

# The thesis's own way, and a face sixteen times as fine.
expect 0 "$B/fapbank" fit "$scan" --landmarks "$points" --bank builtin --method zhu --subdivide 2 -o "$T/fine.ply" --json
coarse=$(grep -c '^f ' "$T/anna.obj")
grep -aq "element face $((16 * coarse))" "$T/fine.ply" || fail "not sixteen times as fine"

# The face alone: the same triangles on everybody, whatever the method.
for method in auto zhu; do
    expect 0 "$B/fapbank" fit "$scan" --landmarks "$points" --bank builtin --method $method --face-only -o "$T/face_$method.obj"
    grep '^f ' "$T/face_$method.obj" >"$T/triangles_$method"
done
cmp "$T/triangles_auto" "$T/triangles_zhu" || fail "--face-only leaves out other triangles by another method"
[ "$(wc -l <"$T/triangles_auto")" -lt "$(grep -c '^f ' "$T/anna.obj")" ] || fail "--face-only leaves nothing out"
expect 2 "$B/fapbank" fit "$scan" --landmarks "$points" --face-only -o "$T/x.fbank"
