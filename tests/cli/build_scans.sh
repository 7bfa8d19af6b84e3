# SPDX-License-Identifier: BSD-2-Clause
# A bank out of scans of one person: a recipe says which is which, motions come out, and what was not scanned is taken over.
. tests/cli/lib.bash

S=$FAP_SHARED/data/faces/scans
[ -f "$S/ict_a_neutral.ply" ] || skip "no $S"
cp "$S"/ict_a_neutral* "$S"/ict_a_joy* "$S"/ict_a_viseme10* "$T"
cat >"$T/anna.recipe" <<'R'
fapbank recipe
name Anna
like builtin
scan ict_a_neutral.ply ict_a_neutral_points.csv
expression joy ict_a_joy.ply ict_a_joy_points.csv
viseme 10 ict_a_viseme10_A.ply ict_a_viseme10_A_points.csv
R
got=0
"$B/fapbank" build "$T/anna.recipe" -o "$T/anna.fbank" >"$T/out" 2>"$T/err" || got=$?
grep -q Embree "$T/err" && skip "a build without Embree"
[ "$got" -eq 0 ] || fail "build gives $got: $(cat "$T/err")"
says 'Anna, .* 85 key models'
says 'joy +0\.[0-9]+'
says 'aa +0\.[0-9]+ .* [1-9][0-9]*$'
expect 0 "$B/fapbank" build --json "$T/anna.recipe" -o "$T/anna2.fbank"
cmp "$T/anna.fbank" "$T/anna2.fbank" || fail "two builds of the same scans differ"
python3 - "$T/out" <<'P' || fail "the report is not what was scanned: $(cat "$T/out")"
import json, sys
s = {x["name"]: x for x in json.load(open(sys.argv[1]))["scans"]}
assert list(s) == ["at rest", "joy", "aa"]
assert s["joy"]["masked_vertices"] == 0 and s["aa"]["masked_vertices"] > 20
assert s["aa"]["moves_mm"] > 15 and s["joy"]["moves_mm"] > 6
P
expect 0 "$B/fapbank" info "$T/anna.fbank"
says 'Anna'

# Only what was scanned; the thesis's method; another way to bring the heads together.
sed 's/^like builtin/like builtin\nalone\nmethod zhu\nalignment orientation/' "$T/anna.recipe" >"$T/alone.recipe"
expect 0 "$B/fapbank" build "$T/alone.recipe" -o "$T/alone.fbank"
says 'Anna, .* 2 key models'

# What is wrong is said with its line, and leaves nothing.
bad() {
    printf '%s\n' "fapbank recipe" "like builtin" "$@" >"$T/bad.recipe"
    expect 1 "$B/fapbank" build "$T/bad.recipe" -o "$T/bad.fbank"
    [ ! -e "$T/bad.fbank" ] || fail "a bad recipe left a bank"
}
bad "scan ict_a_neutral.ply"
says 'bad.recipe:3'
bad "scan none.ply none.csv"
says 'bad.recipe:3: none.ply'
bad "method magic"
says 'bad.recipe:3'
bad "scan ict_a_neutral.ply ict_a_neutral_points.csv" "expression 7 ict_a_joy.ply ict_a_joy_points.csv"
says 'bad.recipe:4'
printf '8.3,1,2,3\n8.4,1,2,3\n' >"$T/two.csv"
bad "scan ict_a_neutral.ply two.csv"
says 'bad.recipe:3: .*three'
bad "like builtin"
says 'bad.recipe:3'

# A picture of each scan with the face on it.
status=0
"$B/fapbank" build "$T/anna.recipe" -o "$T/anna3.fbank" --pictures "$T/pictures" >"$T/out" 2>"$T/err" || status=$?
[ "$status" -eq 3 ] && skip "no OpenGL here: $(tail -n 1 "$T/err")"
[ "$status" -eq 0 ] || fail "build with pictures gives $status: $(cat "$T/err")"
cmp "$T/anna.fbank" "$T/anna3.fbank" || fail "pictures change the bank"
for name in 01-at_rest 02-joy 03-aa; do
    [ "$(head -c 4 "$T/pictures/$name.png" | tail -c 3)" = PNG ] || fail "no picture $name"
done
expect 2 "$B/fapbank" info builtin --pictures "$T/pictures"
