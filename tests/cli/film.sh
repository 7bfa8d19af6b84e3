# SPDX-License-Identifier: BSD-2-Clause
# Films as a whole or not at all, as long as the stream whatever the sound; pictures in a row; points from a pipe.
. tests/cli/lib.bash
stream=tests/golden/blink/stream.fap
play="$B/fapplay --bank builtin --size 64x64 --quiet"

"$B/fapplay" - --bank builtin --quiet -o - <$stream >"$T/points.csv" || fail "points from a pipe"
[ "$(wc -l <"$T/points.csv")" -eq 4 ] || fail "three frames give $(wc -l <"$T/points.csv") lines"
expect 0 $play $stream --fps 50 -o "$T/p50.csv"
[ "$(wc -l <"$T/p50.csv")" -eq 7 ] || fail "twice the rate gives $(wc -l <"$T/p50.csv") lines"
expect 2 $play $stream --frames 3: -o "$T/x.csv"
head -c 200 $stream >"$T/cut.fap"
expect 1 $play "$T/cut.fap" -o "$T/x.csv"
says 'line [0-9]'
expect 1 $play $stream -o "$T/no/x.csv"
[ ! -e "$T/x.csv" ] || fail "a failed run left points"

status=0
$play $stream -o "$T/a.png" >"$T/out" 2>"$T/err" || status=$?
[ "$status" -eq 3 ] && skip "no OpenGL in this build"
mkdir "$T/row"
expect 0 $play $stream --frames 1: -o "$T/row/%02d.png"
[ "$(ls "$T/row")" = "$(printf '01.png\n02.png')" ] || fail "frames 1 and 2 are called $(ls "$T/row")"

expect 3 env PATH="$T" "$B/fapplay" $stream --bank builtin --size 64x64 -o "$T/film.mp4"
says 'install'
[ -z "$(ls "$T" | grep film)" ] || fail "without ffmpeg something is left"
command -v ffprobe >/dev/null || skip "no ffmpeg here"
ffmpeg -v error -f lavfi -i sine=440:duration=9 "$T/long.wav"
ffmpeg -v error -f lavfi -i sine=440:duration=0.05 "$T/short.wav"
for sound in long short; do
    for kind in mp4 webm mkv; do
        expect 0 $play $stream --audio "$T/$sound.wav" -o "$T/film.$kind"
        ffprobe -v error -count_frames -show_entries stream=codec_type,nb_read_frames:format=duration \
            -of default=nw=1 "$T/film.$kind" >"$T/out"
        says '^nb_read_frames=3$'
        says '^codec_type=audio'
        says '^duration=0\.1'
    done
done
[ "$(ls "$T" | grep -c film)" -eq 3 ] || fail "temporary names are left: $(ls "$T")"
