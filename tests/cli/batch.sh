# SPDX-License-Identifier: BSD-2-Clause
# fapenc --batch: good and bad takes, going on where it was stopped, several processes on one folder.
. tests/cli/lib.bash
markers=tests/assets/demo_markers.csv
mkdir -p "$T/in/a b/deep" "$T/in/.hidden"
cp tests/assets/demo_take.c3d "$T/in/one.c3d"
cp tests/assets/demo_take.c3d "$T/in/a b/deep/two & <3>.c3d"
cp tests/assets/demo_take.c3d "$T/in/.hidden/no.c3d"
"$B/fapenc" "$T/in/one.c3d" --markers $markers -o "$T/in/one.fap" --quiet
head -c 520 tests/assets/demo_take.c3d >"$T/in/cut.c3d"
echo "shopping list" >"$T/in/notes.txt"
echo "no sound" >"$T/in/one.wav"

batch() { "$B/fapenc" --batch "$T/in" -o "$T/done" --markers $markers "$@"; }
status_of() { python3 -c 'import csv,sys
for r in csv.DictReader(open(sys.argv[1])):
    if r["take"] == sys.argv[2]: print(r["status"])' "$T/done/summary.csv" "$1"; }

# One bad take does not stop the rest, and the exit says that there was one.
expect 1 batch -j 2
says '3 encoded, 1 failed, 1 no takes'
says 'cut\.c3d: '
[ "$(status_of one.c3d)" = encoded ] || fail "one.c3d: $(status_of one.c3d)"
[ "$(status_of cut.c3d)" = failed ] || fail "cut.c3d: $(status_of cut.c3d)"
[ "$(status_of notes.txt)" = "no take" ] || fail "notes.txt: $(status_of notes.txt)"
[ -e "$T/done/no.fap" ] || [ -e "$T/done/.hidden" ] && fail "hidden folders are none of ours"
# Two that would have one name keep their endings.
for f in one.c3d.fap one.fap.fap "a b/deep/two & <3>.fap"; do [ -s "$T/done/$f" ] || fail "$f is missing"; done
grep -q 'two%20%26%20%3C3%3E.fap' "$T/done/index.html" || fail "the page's address of 'two & <3>'"
grep -q 'two &amp; &lt;3&gt;' "$T/done/index.html" || fail "the page's text of 'two & <3>'"
python3 -c 'import json,sys; assert json.load(open(sys.argv[1]))["frames"] > 0' "$T/done/one.c3d.json" || fail "report"
expect 0 "$B/fapenc" "$T/in/one.c3d" --markers $markers -o "$T/alone.fap" --quiet
cmp -s <(tail -n +2 "$T/alone.fap") <(tail -n +2 "$T/done/one.c3d.fap") || fail "alone it comes out another"
[ -z "$(find "$T/done" -name '*.claim*' -o -name '.clock*')" ] || fail "left behind: $(find "$T/done" -name '*.claim*')"

# Again: nothing to do. Where something is missing or has changed, that alone.
stamp() { stat -c %y "$T/done/$1"; }
before=$(stamp one.c3d.fap)
rm "$T/done/a b/deep/two & <3>.fap"
rm "$T/in/cut.c3d"
expect 0 batch
says '3 encoded, 0 failed, 1 no takes'
[ "$(stamp one.c3d.fap)" = "$before" ] || fail "what was done is done again"
[ -s "$T/done/a b/deep/two & <3>.fap" ] || fail "a missing output stays missing"
expect 0 batch --fps 30
[ "$(stamp one.c3d.fap)" != "$before" ] || fail "other options, the old output"

# A claim of a process that died here, or that has not beaten for long: anybody's. One that lives is waited for.
rm "$T/done/one.c3d.fap"
echo "$(hostname) 999999999" >"$T/done/.batch/one.c3d.claim"
expect 0 timeout 20 "$B/fapenc" --batch "$T/in" -o "$T/done" --markers $markers --fps 30
rm "$T/done/one.c3d.fap"
echo "another.machine 1" >"$T/done/.batch/one.c3d.claim"
touch -d '5 minutes ago' "$T/done/.batch/one.c3d.claim"
expect 0 timeout 20 "$B/fapenc" --batch "$T/in" -o "$T/done" --markers $markers --fps 30
rm "$T/done/one.c3d.fap"
echo "another.machine 1" >"$T/done/.batch/one.c3d.claim"
batch --fps 30 --quiet &
sleep 1.5
kill -0 $! 2>/dev/null || fail "somebody else's take was not waited for"
[ ! -e "$T/done/one.c3d.fap" ] || fail "somebody else's take was taken"
rm "$T/done/.batch/one.c3d.claim"
wait $! || fail "the batch did not come to its end"
[ -s "$T/done/one.c3d.fap" ] || fail "the take was not taken over"

# Four processes share one folder: each take once, and all of them know all of it.
for i in 1 2 3 4 5 6; do cp tests/assets/demo_take.c3d "$T/in/more$i.c3d"; done
for i in 1 2 3 4; do batch --fps 30 -j 1 --json >"$T/json$i" 2>"$T/err$i" & done
wait
for i in 1 2 3 4; do
    python3 -c 'import json,sys; assert json.load(open(sys.argv[1]))["encoded"] == 9' "$T/json$i" || fail "process $i: $(cat "$T/err$i")"
done

# A worker that is shot: the take failed, the others did not.
rm -r "$T/done" "$T/in/more"*
if (ulimit -f 12 && batch -j 1 >"$T/words" 2>"$T/err"); then fail "outputs past the limit"; fi
grep -q 'ended by signal' "$T/err" || fail "nobody says that a worker was shot: $(cat "$T/err")"
expect 0 batch
says '3 encoded, 0 failed'

# Ended by a signal: nothing half, no claims, and the next run goes on.
rm -r "$T/done"
for i in 1 2 3 4 5 6; do cp tests/assets/demo_take.c3d "$T/in/more$i.c3d"; done
"$B/fapenc" --batch "$T/in" -o "$T/done" --markers $markers -j 2 --quiet &
while [ -z "$(find "$T/done" -name '*.result' 2>/dev/null)" ]; do sleep 0.02; done
kill -TERM $!
wait $! && fail "a signal is no success"
sleep 0.3
[ -z "$(find "$T/done" -name '*.claim' -o -name '*.??????' -name '*.fap.*')" ] || fail "left behind: $(find "$T/done" -name '*.claim')"
expect 0 batch --to fba
[ -s "$T/done/more6.fba" ] || fail "--to fba"

expect 2 "$B/fapenc" --batch "$T/in"
expect 2 "$B/fapenc" --batch "$T/in" -o "$T/done" --to wav
expect 2 "$B/fapenc" tests/assets/demo_take.c3d -o "$T/x.fap" -j 3
expect 1 "$B/fapenc" --batch "$T/nowhere" -o "$T/done"
says nowhere
