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
expect 0 "$B/fapbank" info builtin
says 'built-in'

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

expect 2 "$B/fapbank" build builtin
expect 2 "$B/fapbank" paint builtin -o "$T/x"
expect 2 "$B/fapbank" render builtin -o "$T/x.png" --tile 5
expect 2 "$B/fapbank" render builtin -o "$T/x.png" --camera above
expect 2 "$B/fapbank" info --json -o - builtin

status=0
"$B/fapbank" render builtin -o "$T/sheet.png" --tile 64 >"$T/out" 2>"$T/err" || status=$?
[ "$status" -eq 3 ] && skip "no OpenGL here: $(cat "$T/err")"
[ "$status" -eq 0 ] || fail "render gives $status"
[ "$(head -c 4 "$T/sheet.png" | tail -c 3)" = PNG ] || fail "the sheet is no PNG"
