# SPDX-License-Identifier: BSD-2-Clause
# fapenc --speech, --phonemes, --text: a mouth that shuts at p, b and m, from every source of times.
. tests/cli/lib.bash

# "Bob, maybe": lines of start, end, phoneme.
printf '%s\t%s\t%s\n' 0.0 0.2 sil 0.2 0.28 b 0.28 0.45 ɑ 0.45 0.53 b 0.53 0.63 m 0.63 0.8 eɪ 0.8 0.88 b 0.88 1.1 iː >"$T/bob.tsv"

# The widest and the narrowest the inner lips are apart in these seconds, millimetres.
lips() {
    "$B/fapplay" "$1" --bank builtin -o "$T/points.csv" --csv points --quiet
    awk -F, -v from="$2" -v to="$3" '
        NR == 1 { for (i = 1; i <= NF; i++) { if ($i == "2.2.y") up = i; if ($i == "2.3.y") low = i }; next }
        NR == 2 { rest = $up - $low }
        $2 >= from - 0.001 && $2 <= to + 0.001 { gap = $up - $low - rest; if (n++ == 0 || gap < min) min = gap; if (n == 1 || gap > max) max = gap }
        END { printf "%.2f %.2f\n", min, max }' "$T/points.csv"
}
shut_at() { # FILE FROM TO: somewhere in there
    local gap
    gap=$(lips "$@")
    awk -v g="${gap% *}" 'BEGIN { exit !(g < 0.6) }' || fail "$1: lips are $gap mm apart between $2 and $3 s"
}
open_at() {
    local gap
    gap=$(lips "$@")
    awk -v g="${gap#* }" 'BEGIN { exit !(g > 3) }' || fail "$1: lips are only $gap mm apart between $2 and $3 s"
}

for way in "" --lips; do
    expect 0 "$B/fapenc" --phonemes "$T/bob.tsv" $way --fps 50 -o "$T/bob$way.fap"
    says '8 phonemes \(ipa\), 7 of them sounds'
    shut_at "$T/bob$way.fap" 0.20 0.28
    open_at "$T/bob$way.fap" 0.32 0.42
    shut_at "$T/bob$way.fap" 0.45 0.53
    shut_at "$T/bob$way.fap" 0.55 0.61
    shut_at "$T/bob$way.fap" 0.80 0.88
done
expect 0 "$B/fapenc" inspect "$T/bob.fap" --json
says '"fap": *1,|viseme'

# The same as a TextGrid, and coded; the same sounds, the same mouth.
cat >"$T/bob.TextGrid" <<'END'
File type = "ooTextFile"
Object class = "TextGrid"

xmin = 0
xmax = 1.1
tiers? <exists>
size = 1
item []:
    item [1]:
        class = "IntervalTier"
        name = "phones"
        xmin = 0
        xmax = 1.1
        intervals: size = 8
END
i=0
while read -r from to name; do
    [ "$name" = sil ] && name=
    i=$((i + 1))
    printf '        intervals [%d]:\n            xmin = %s\n            xmax = %s\n            text = "%s"\n' $i "$from" "$to" "$name"
done <"$T/bob.tsv" >>"$T/bob.TextGrid"
expect 0 "$B/fapenc" --phonemes "$T/bob.TextGrid" --fps 50 -o "$T/grid.fap"
says 'tier "phones"'
cmp -s <(tail -n +2 "$T/bob.fap") <(tail -n +2 "$T/grid.fap") || fail "a TextGrid is spoken otherwise than its lines"
expect 0 "$B/fapenc" --phonemes "$T/bob.TextGrid" -o "$T/bob.fba"
expect 0 "$B/fapenc" inspect "$T/bob.fba"

# What is not said, or said twice.
expect 2 "$B/fapenc" --speech "$T/bob.wav" -o "$T/x.fap"
says 'what is said\?'
expect 2 "$B/fapenc" --phonemes "$T/bob.tsv" --text bob -o "$T/x.fap"
expect 2 "$B/fapenc" --phonemes "$T/bob.tsv" take.c3d -o "$T/x.fap"
expect 2 "$B/fapenc" --phonemes "$T/bob.tsv" --language de -o "$T/x.fap"
expect 2 "$B/fapenc" --phonemes "$T/bob.tsv" -o "$T/x.csv"
expect 1 "$B/fapenc" --phonemes "$T/nowhere.tsv" -o "$T/x.fap"
says 'nowhere'
printf '1\t0\tb\n' >"$T/bad.tsv"
expect 1 "$B/fapenc" --phonemes "$T/bad.tsv" -o "$T/x.fap"
says 'bad.tsv: '
[ ! -e "$T/x.fap" ] || fail "a failure left an output"

# Text, where espeak-ng is there.
if [ ! -x "$B/fap-phonemes" ]; then
    mkdir "$T/empty"
    expect 3 env PATH="$T/empty:/usr/bin" "$B/fapenc" --text bob -o "$T/x.fap"
    says 'libespeak-ng-dev'
    skip "built without espeak-ng"
fi
expect 0 "$B/fap-phonemes" -w "$T/made.wav" "Bob made five big moving vans"
cp "$T/out" "$T/made.tsv"
expect 0 "$B/fapenc" --speech "$T/made.wav" --phonemes "$T/made.tsv" -o "$T/made.fap"
# Every p, b and m of it.
while read -r from to name; do
    case $name in p | b | m) shut_at "$T/made.fap" "$(awk "BEGIN { print $from - 0.02 }")" "$(awk "BEGIN { print $to + 0.02 }")" ;; esac
done <"$T/made.tsv"
expect 0 "$B/fapenc" --speech "$T/made.wav" --text "Bob made five big moving vans" --json -o "$T/text.fap"
says '"sounds": [12][0-9]'
expect 1 "$B/fapenc" --text "bob" --language nowhere -o "$T/x.fap"
says 'no such language'
expect 2 "$B/fap-phonemes"
expect 2 "$B/fap-phonemes" --speed 1 bob
expect 1 "$B/fap-phonemes" -w "$T/nowhere/x.wav" bob
expect 0 "$B/fap-phonemes" --help
says 'GPL'
