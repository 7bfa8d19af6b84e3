# SPDX-License-Identifier: BSD-2-Clause
# fapenc track: films of a face between mirrors, of which the truth is known, to takes.
. tests/cli/lib.bash
command -v ffmpeg >/dev/null || skip "no ffmpeg"
track() { "$B/fapenc" track "$@"; }
# film NAME OPTIONS: a second of 320x240, large dots.
film() { "$B/mirror-film" --size 320x240 --dot 5 --samples 2 --seconds 0.7 "${@:2}" "$T/$1" || fail "film $1"; }
# off TAKE: rms_mm, max_mm and missing samples against the film's truth.
off() { "$B/mirror-compare" "$T/$1.c3d" "$T/$2"; }
below() { python3 -c 'import sys; w = sys.argv[1].split(); v = float(w[w.index(sys.argv[2]) + 1]); sys.exit(not v < float(sys.argv[3]))' "$@" ||
    fail "$2 in '$1' is not below $3"; }

film two --noise 2
expect 0 track "$T/two.y4m" --init "$T/two.csv" --camera "$T/two.json" --ruler "ruler A,ruler B,100" -o "$T/two.trc" \
    --overlay "$T/look.mp4"
says 'mirror 2: '
says 'size: by the ruler'
below "$(off two two.trc)" rms_mm 2
[ "$(ffprobe -v error -count_packets -show_entries stream=nb_read_packets -of csv=p=0 "$T/look.mp4")" = 21 ] || fail "overlay"
# As C3D it is the same take, and the report can be read by programs.
expect 0 track "$T/two.y4m" --init "$T/two.csv" --camera "$T/two.json" --ruler "ruler A,ruler B,100" -o "$T/two_again.c3d" --json
python3 -c 'import json,sys
j = json.load(open(sys.argv[1]))
assert len(j["mirrors"]) == 2 and j["take"]["size_measured"] and j["video"]["pictures"] == 21, j' "$T/out" || fail "report"
[ "$(off two two.trc)" = "$(off two two_again.c3d)" ] || fail "TRC and C3D differ: $(off two two.trc), $(off two two_again.c3d)"
# And FAPs come of it: the mouth opens, and the report says of what.
expect 0 "$B/fapenc" "$T/two.trc" -o "$T/two.fap"
says 'markers: '

# A part of it begins where --start says; sizes are guessed without a ruler, and that is said.
expect 0 track "$T/two.y4m" --init "$T/two.csv" --end 0.3 -o "$T/part.trc"
says 'size: guessed'
says 'nobody measured it'
[ "$(sed -n 3p "$T/part.trc" | cut -f 3,5)" = "$(printf '9\tmm')" ] || fail "frames of a part"

film one --mirrors 1
expect 0 track "$T/one.y4m" --init "$T/one.csv" --camera "$T/one.json" --ruler "ruler A,ruler B,100" -o "$T/one.trc"
below "$(off one one.trc)" rms_mm 2
film none --mirrors 0
expect 0 track "$T/none.y4m" --init "$T/none.csv" -o "$T/none.trc"
says 'flat, as there is no mirror'
# Fields are told from frames by the file, and followed one by one.
film fields --interlaced --seconds 0.4
expect 0 track "$T/fields.y4m" --init "$T/fields.csv" --camera "$T/fields.json" --ruler "ruler A,ruler B,100" -o "$T/fields.trc"
says '60 fields a second, 24 of them'
below "$(off fields fields.trc)" rms_mm 2.5

# What is wrong is said, and no output appears.
expect 2 track "$T/two.y4m" -o "$T/no.trc"
says '--init POINTS.csv'
expect 2 track "$T/two.y4m" --init "$T/two.csv" -o "$T/no.fap"
says '.trc or .c3d'
expect 2 track "$T/two.y4m" --init "$T/two.csv" -o "$T/no.trc" --ruler "a,b"
expect 1 track "$T/two.y4m" --init "$T/two.csv" -o "$T/no.trc" --ruler "a,b,100"
says 'there is no "a"'
expect 1 track "$T/nothing.mp4" --init "$T/two.csv" -o "$T/no.trc"
says 'nothing.mp4'
expect 1 track "$T/two.csv" --init "$T/two.csv" -o "$T/no.trc"
expect 1 track "$T/two.y4m" --init "$T/two.y4m" -o "$T/no.trc"
says 'two.y4m: too large'
printf 'label,x,y\n8.4,left,below\n' >"$T/words.csv"
expect 1 track "$T/two.y4m" --init "$T/words.csv" -o "$T/no.trc"
says 'line 2: '
printf '8.4,1000,20\n' >"$T/outside.csv"
expect 1 track "$T/two.y4m" --init "$T/outside.csv" -o "$T/no.trc"
says '8.4 at 1000, 20 is outside of the picture, which has 320 x 240'
printf '{"width":1000,"height":1000,"fx":900,"fy":900,"cx":500,"cy":500}' >"$T/square.json"
expect 1 track "$T/two.y4m" --init "$T/two.csv" --camera "$T/square.json" -o "$T/no.trc"
says 'measure it as it films'
head -c 500000 "$T/two.y4m" >"$T/cut.y4m"
expect 0 track "$T/cut.y4m" --init "$T/two.csv" -o "$T/cut.trc"
expect 3 env PATH=/nowhere "$B/fapenc" track "$T/two.y4m" --init "$T/two.csv" -o "$T/no.trc"
says 'apt install ffmpeg'
[ -e "$T/no.trc" ] && fail "an output in spite of an error"
exit 0
