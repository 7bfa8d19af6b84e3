# SPDX-License-Identifier: BSD-2-Clause
# A stream becomes pictures: offscreen, the same bytes every time, films with sound.
. tests/cli/lib.bash
expect 0 "$B/fapenc" tests/assets/demo_take.c3d --markers tests/assets/demo_markers.csv --fps 25 -o "$T/demo.fap"
play="$B/fapplay $T/demo.fap --bank builtin --size 128x128"

$play --help >/dev/null
expect 0 $play -o "$T/points.csv"
[ "$(wc -l <"$T/points.csv")" -gt 50 ] || fail "points.csv is short"

expect 0 $play -o "$T/none.null"
"$B/fapplay" --help | grep -q osmesa || true
status=0
$play --frames 10:11 -o "$T/a.png" >"$T/out" 2>"$T/err" || status=$?
[ "$status" -eq 3 ] && skip "no OpenGL in this build"
[ "$status" -eq 0 ] || fail "a picture: exit $status: $(cat "$T/err")"
expect 0 $play --frames 10:11 -o "$T/b.png"
cmp -s "$T/a.png" "$T/b.png" || fail "two runs differ"
expect 0 $play --frames 10:13 -o "$T/f_%04d.png"
[ "$(ls "$T"/f_*.png | wc -l)" -eq 3 ] || fail "three frames give $(ls "$T"/f_*.png | wc -l) pictures"
expect 0 $play --sheet 6 -o "$T/sheet.png"

command -v ffprobe >/dev/null || skip "no ffmpeg here"
expect 0 $play --frames 0:50 --audio tests/assets/demo_take.wav -o "$T/film.mp4"
ffprobe -v error -count_frames -show_entries stream=codec_type,nb_read_frames -of csv=p=0 "$T/film.mp4" >"$T/out"
says '^video,50'
says '^audio'
expect 1 $play --audio "$T/demo.fap" -o "$T/bad.mp4"
[ ! -e "$T/bad.mp4" ] || fail "a failed run left a film"
