# SPDX-License-Identifier: BSD-2-Clause
# The face at rest: found, or a frame, a time or a stretch of the take; and each FAPU says where it is from.
. tests/cli/lib.bash
take=tests/assets/demo_take.c3d
encode() { expect 0 "$B/fapenc" "$take" --markers tests/assets/demo_markers.csv -o "$T/$1.fap" "${@:2}"; }
same() { cmp -s <(tail -n +2 "$T/$1.fap") <(tail -n +2 "$T/$2.fap"); }

# The take has 120 frames a second: 1.5 s are frame 180.
encode frame --neutral 180
says 'neutral: 1\.52? s, mean of 0\.04 s, given'
encode time --neutral 1.5s
same frame time || fail "frame 180 and 1.5s differ"
encode stretch --neutral 180-240
says 'neutral: 1\.7[0-9] s, mean of 0\.5[0-9] s, given'
encode times --neutral 1.5-2s
same stretch times || fail "180-240 and 1.5-2s differ"
same stretch frame && fail "a stretch is its first frame"
encode auto --neutral auto
says 'neutral: .* found'
encode none
same auto none || fail "auto is not the default"

# A frame that is not encoded, a stretch that runs out of the take, and what is no time at all.
for wrong in 999999 180-999999 9999s; do
    expect 2 "$B/fapenc" "$take" --markers tests/assets/demo_markers.csv --neutral $wrong -o "$T/x.fap"
    says "--neutral .*frames 0 to"
done
expect 2 "$B/fapenc" "$take" --markers tests/assets/demo_markers.csv --start 2 --neutral 1.5s -o "$T/x.fap"
for wrong in soon 1.5 240-180 1-2-3 -- -4 ''; do
    expect 2 "$B/fapenc" "$take" --neutral="$wrong" -o "$T/x.fap"
    says 'expected a frame \(120\)'
done
[ ! -e "$T/x.fap" ] || fail "a failed run left an output"

# FAPU: in words and in JSON, each with its source.
printf 'IRISD 11\nES 60\nENS 44\nMNS 22\nMW 48\n' >"$T/anna.fapu"
encode given --fapu "$T/anna.fapu"
says 'FAPU, mm: IRISD 11\.0 \(given\), ES 60\.0 \(given\), ENS 44\.0 \(given\), MNS 22\.0 \(given\), MW 48\.0 \(given\)'
encode words
says 'FAPU, mm: IRISD .* \(measured\), ES .* \(measured\), ENS .* \(measured\), MNS .* \(typical, scaled\), MW .* \(measured\)'
encode bank --bank builtin
says 'MNS .* \(bank, scaled\), MW .* \(measured\)'
encode json --json
for unit in IRISD ES ENS MNS MW; do says "\"$unit\""; done
says '"origin": ?"typical, scaled"'
expect 1 "$B/fapenc" "$take" --markers tests/assets/demo_markers.csv --bank "$T/nobody.fbank" -o "$T/x.fap"
says 'nobody.fbank'
