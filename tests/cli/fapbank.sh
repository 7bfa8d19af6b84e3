# SPDX-License-Identifier: BSD-2-Clause
# fapbank makes the same bank twice, whole or not at all, and says what is wrong with what it is given.
. tests/cli/lib.bash

expect 0 "$B/fapbank" build builtin -o "$T/a.fbank"
expect 0 "$B/fapbank" build --quiet builtin -o "$T/b.fbank"
[ ! -s "$T/err" ] || fail "--quiet is not"
cmp "$T/a.fbank" "$T/b.fbank" || fail "two builds of the same face differ"
expect 0 "$B/fapbank" build builtin -o -
cmp "$T/a.fbank" "$T/out" || fail "standard output gets another bank"
expect 0 "$B/fapbank" info --json "$T/a.fbank"
python3 -c 'import json, sys; j = json.load(open(sys.argv[1])); assert j["points"] == 84 and len(j["keys"]) == 85' "$T/out"
python3 -c 'import json, sys; o = json.load(open(sys.argv[1]))["observed"]["units_faps"]
assert o["axes"] == 52 and 20 < o["rank"] < o["keys"] and o["condition"] > 1 and "eyeLookInLeft" in o["unseen"]' "$T/out" ||
    fail "what the points can tell is not told"
expect 0 "$B/fapbank" info builtin
says 'built-in'
says 'alike: jawLeft and jawRight'

echo keep >"$T/keep.fbank"
expect 1 "$B/fapbank" build "$T/no.whl" -o "$T/keep.fbank"
says 'no.whl'
printf 'v 0 0\n' >"$T/base.obj"
expect 1 "$B/fapbank" build "makehuman:$T" -o "$T/keep.fbank"
says 'base.obj'
expect 1 "$B/fapbank" build builtin -o "$T/no/such/folder.fbank"
[ "$(cat "$T/keep.fbank")" = keep ] || fail "a failed build changed its output"
expect 1 "$B/fapbank" info tests/cli/fapbank.sh
says 'not recognised'

# Face animation tables: the same twice, whole or not at all.
expect 0 "$B/fapbank" fat builtin -o "$T/a.fat"
says 'bytes'
expect 0 "$B/fapbank" fat --quiet builtin -o "$T/b.fat"
cmp "$T/a.fat" "$T/b.fat" || fail "the tables of the same face differ"
expect 0 "$B/fapbank" fat builtin -o -
cmp "$T/a.fat" "$T/out" || fail "standard output gets other tables"
expect 2 "$B/fapbank" fat builtin
expect 1 "$B/fapbank" fat tests/cli/fapbank.sh -o "$T/keep.fbank"
[ "$(cat "$T/keep.fbank")" = keep ] || fail "a failed fat changed its output"

# Masks, region map and principal components.
expect 0 "$B/fapbank" info "$T/a.fbank"
says 'masks +lip_upper [1-9].* lid_lower_right [1-9]'
says 'region map +borders'
says 'components +none'
expect 0 "$B/fapbank" pca "$T/a.fbank" -o "$T/pca.fbank" --components=8
says '8 components of 32 models, [0-9.]+ % of the variance'
says 'component +eigenvalue, mm2 +contribution +cumulative'
says ' 8 +[0-9.]+ +0\.[0-9]+ +0\.[0-9]+'
expect 0 "$B/fapbank" pca builtin --components=8 -q -o "$T/pca2.fbank"
expect 0 "$B/fapbank" info "$T/pca.fbank"
says 'component +8 +sigma'
expect 0 "$B/fapbank" info --json "$T/pca.fbank"
python3 -c 'import json, sys; j = json.load(open(sys.argv[1])); c = [x["cumulative"] for x in j["components"]]
assert len(c) == 8 and c == sorted(c) and 0.8 < c[-1] <= 1 and all(n > 0 for n in j["masks"].values()), c
assert j["regions"]["width_mm"] > 100' "$T/out" || fail "components are not told"
expect 0 "$B/fapbank" pca --json "$T/a.fbank" -o "$T/pca3.fbank" --components=8
cmp "$T/pca.fbank" "$T/pca3.fbank" || fail "two analyses of the same bank differ"
expect 1 "$B/fapbank" pca tests/cli/fapbank.sh -o "$T/keep.fbank"
[ "$(cat "$T/keep.fbank")" = keep ] || fail "a failed pca changed its output"
expect 2 "$B/fapbank" pca builtin
expect 2 "$B/fapbank" pca builtin -o "$T/x" --components=0
expect 2 "$B/fapbank" pca builtin -o "$T/x" --components=129

# A text recipe: two triangles that happen to have a face's measures.
cat >"$T/face.obj" <<'O'
v 3.1 .5 0
v -3.1 .5 0
v 3.1 -.5 0
v -3.1 -.5 0
v 3.1 0 0
v -3.1 0 0
v 0 -4.8 0
v 0 -6.8 0
v 2.5 -7 0
v -2.5 -7 0
f 1 2 3
g eye
f 4 5 6
O
sed 's/^v 0 -6.8 0/v 0 -9 0/' "$T/face.obj" >"$T/open.obj"
echo '7 0 -1 0' >"$T/jaw.target"
cat >"$T/face.recipe" <<'R'
fapbank recipe
# lengths are centimetres
name tiny
scale 10
group eye eye_left 255 255 255 255
mesh face.obj
point 3.1 0
point 3.2 1
point 3.3 2
point 3.4 3
point 3.5 4
point 3.6 5
point 9.15 6
point 2.2 7
point 8.3 8
point 8.4 9
place 7.1 0 0 -9
eye left 3.1 0 -1 1
unit jawOpen jaw.target
viseme 10 open.obj
R
expect 0 "$B/fapbank" build "$T/face.recipe" -o "$T/tiny.fbank"
expect 0 "$B/fapbank" info "$T/tiny.fbank"
says 'tiny'
says 'unit +jawOpen .* 10.0 mm'
says 'viseme +aa .* 22.0 mm'
says 'eye_left 3'
for line in 'point 8.5 99' 'point 20.1 1' 'unit x none.obj' 'scale 2' 'viseme 15 open.obj' 'paint it red' 'eye left 1 2 3 -1'; do
    cp "$T/face.recipe" "$T/bad.recipe"
    echo "$line" >>"$T/bad.recipe"
    expect 1 "$B/fapbank" build "$T/bad.recipe" -o "$T/bad.fbank"
    says 'bad.recipe:21'
done
[ ! -e "$T/bad.fbank" ] || fail "a bad recipe left a bank"

expect 2 "$B/fapbank" build builtin
expect 2 "$B/fapbank" paint builtin -o "$T/x"
expect 2 "$B/fapbank" render builtin -o "$T/x.png" --tile 5
expect 2 "$B/fapbank" render builtin -o "$T/x.png" --camera above
expect 2 "$B/fapbank" render builtin -o "$T/x.png" --gl vulkan
expect 2 "$B/fapbank" info --json -o - builtin

status=0
"$B/fapbank" render builtin -o "$T/sheet.png" --tile 64 >"$T/out" 2>"$T/err" || status=$?
[ "$status" -eq 3 ] && skip "no OpenGL here: $(cat "$T/err")"
[ "$status" -eq 0 ] || fail "render gives $status"
[ "$(head -c 4 "$T/sheet.png" | tail -c 3)" = PNG ] || fail "the sheet is no PNG"
for what in masks regions; do
    expect 0 "$B/fapbank" render builtin -o "$T/$what.png" --tile 64 --$what
    ! cmp -s "$T/sheet.png" "$T/$what.png" || fail "--$what paints nothing"
done
