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

# Pictures that move, in a loop and without sound.
expect 0 $play $stream -o "$T/film.webp"
[ "$(head -c 4 "$T/film.webp")" = RIFF ] && grep -aq ANIM "$T/film.webp" || fail "film.webp is no animation"
[ "$(grep -ao ANMF "$T/film.webp" | wc -l)" -ge 2 ] || fail "film.webp does not move"
expect 0 $play $stream -o "$T/film.gif"
ffprobe -v error -count_frames -show_entries stream=codec_name,nb_read_frames -of default=nw=1 "$T/film.gif" >"$T/out"
says '^codec_name=gif'
says '^nb_read_frames=3$'
grep -aq NETSCAPE2.0 "$T/film.gif" || fail "film.gif does not loop"
expect 2 $play $stream --audio "$T/short.wav" -o "$T/silent.gif"
[ ! -e "$T/silent.gif" ] || fail "a refused run left a picture"

# Video for encoders, in a file and through a pipe: the same bytes, and the picture that a PNG shows.
expect 0 $play $stream -o "$T/video.y4m"
[ "$(head -n 1 "$T/video.y4m")" = "YUV4MPEG2 W64 H64 F25:1 Ip A1:1 C420jpeg XCOLORRANGE=LIMITED" ] ||
    fail "y4m begins with $(head -n 1 "$T/video.y4m")"
$play $stream -o - --y4m | cmp - "$T/video.y4m" || fail "a pipe gets other video than a file"
expect 0 $play $stream --size 63x31 -o "$T/odd.y4m"
ffprobe -v error -count_frames -show_entries stream=nb_read_frames -of default=nw=1 "$T/odd.y4m" >"$T/out"
says '^nb_read_frames=3$'
expect 0 $play $stream --frames 0:1 -o "$T/first.png"
ffmpeg -v error -i "$T/video.y4m" -frames:v 1 -vf scale=in_color_matrix=bt709:in_range=tv -pix_fmt rgb24 "$T/back.png"
ffmpeg -hide_banner -i "$T/first.png" -i "$T/back.png" -lavfi '[0]format=rgb24[a];[1]format=rgb24[b];[a][b]psnr' -f null - 2>&1 |
    sed -n 's/.*average:\([0-9]*\).*/\1/p' >"$T/out"
[ "$(cat "$T/out")" -ge 35 ] || fail "y4m and PNG differ: PSNR $(cat "$T/out")"
[ ! -w /dev/full ] || expect 1 sh -c "$play $stream -o - --y4m >/dev/full"
