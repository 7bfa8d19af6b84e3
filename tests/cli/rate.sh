# SPDX-License-Identifier: BSD-2-Clause
# What is kept constant is kept: a quantiser, a bitrate over every two seconds, an error in millimetres. Every other
# option of the encoder shows in the stream.
. tests/cli/lib.bash

# A head that talks for 12 s: jaw, lips, brows, lids and head, with a blink now and then. Left and right are alike.
awk 'BEGIN {
    n = split("3 4 5 6 7 12 13 19 20 31 32 33 34 48 49 51 52 53 54 59 60", use, " ")
    for (i = 1; i <= n; i++) on[use[i]] = 1
    mirror[7] = 6; mirror[13] = 12; mirror[20] = 19; mirror[32] = 31; mirror[34] = 33; mirror[54] = 53; mirror[60] = 59
    print "2.1 talk 25 300"
    for (f = 0; f < 300; f++) {
        mask = ""; values = f
        for (fap = 1; fap <= 68; fap++) {
            mask = mask (fap > 1 ? " " : "") (fap in on ? 1 : 0)
            if (!(fap in on)) continue
            k = fap in mirror ? mirror[fap] : fap
            v = 120 * sin(f * (0.2 + k / 100)) + 60 * sin(f * 0.71 + k)
            if (k == 19) v = f % 75 < 5 ? 900 : 0
            if (k == 48 || k == 49) v = 9000 * sin(f / 40 + k)
            values = values " " int(v)
        }
        print mask; print values
    }
}' >"$T/a.fap"

# field FILE.json PATH: a member of a report, "written.kbit_s"
field() { python3 -c 'import json,sys
j = json.load(open(sys.argv[1]))
for k in sys.argv[2].split("."): j = j[int(k)] if isinstance(j, list) else j[k]
print(j)' "$1" "$2"; }
holds() { python3 -c "import sys; sys.exit(not ($1))" || fail "not so: $1"; }
command -v python3 >/dev/null || skip "no python3 to read JSON with"
enc() { expect 0 "$B/fapenc" "$T/a.fap" "$@" --json --quiet; cp "$T/out" "$T/enc.json"; }
look() { expect 0 "$B/fapenc" inspect "$1" --planes --json; cp "$T/out" "$T/look.json"; }

# A bitrate: in no two seconds more, and more error than with more bits. inspect counts no more than the encoder.
for kbps in 1.2 2 6; do
    enc --bitrate $kbps -o "$T/r.fba"
    look "$T/r.fba"
    holds "$(field "$T/look.json" largest_2s_bits) <= 2000 * $kbps"
    holds "$(field "$T/look.json" largest_2s_bits) <= $(field "$T/enc.json" written.largest_2s_bits)"
    holds "$(field "$T/look.json" bytes) == $(field "$T/enc.json" written.bytes)"
    holds "$(field "$T/look.json" frames) + $(field "$T/look.json" skipped_frames) == 300"
    holds "$(field "$T/look.json" length_s) == 12"
    field "$T/enc.json" written.mean_error_mm >>"$T/errors"
done
sort -c -g -r "$T/errors" 2>/dev/null || fail "more bits give more error: $(tr '\n' ' ' <"$T/errors")"

# An error: nowhere more, and a larger one takes fewer bits.
for mm in 0.2 1; do
    enc --max-error $mm --bank builtin -o "$T/e.fba"
    holds "$(field "$T/enc.json" written.max_error_mm) <= $mm"
    field "$T/enc.json" written.bytes >>"$T/sizes"
done
sort -c -n -r "$T/sizes" 2>/dev/null || fail "a larger error takes more bits: $(tr '\n' ' ' <"$T/sizes")"

# A quantiser.
enc --quant 3 --intra 50 -o "$T/q.fba"
look "$T/q.fba"
holds "$(field "$T/look.json" quantisers.0.quant) == 3 and $(field "$T/look.json" skipped_frames) == 0"
holds "$(field "$T/look.json" intra_frames) >= 6"

# The report in words.
expect 0 "$B/fapenc" "$T/a.fap" --bitrate 2 -o "$T/r.fba"
says 'kbit/s, [0-9.]+ in the fullest 2 s'
says 'off by [0-9.]+ mm in the mean'

# --quant 0 carries +-1860 and says so where that is not enough.
expect 0 "$B/fapenc" "$T/a.fap" --quant 0 -o "$T/z.fba"
says 'not exact: .*--quant 1'

# Codes, time, gender, latency.
enc --quant 3 --plane-codes -o "$T/c.fba"
look "$T/c.fba"
holds "$(field "$T/look.json" planes.p.start_codes) == $(field "$T/look.json" planes.p.planes)"
enc --quant 3 --intra 25 --time-codes -o "$T/t.fba"
look "$T/t.fba"
holds "$(field "$T/look.json" planes.i.header_bits) > 12 * 18"
enc --quant 3 --gender male -o "$T/g.fba"
look "$T/g.fba"
[ "$(field "$T/look.json" gender)" = male ] || fail "--gender is not in the stream"
enc --quant 3 --look-ahead 0 --intra 50 -o "$T/l.fba"
look "$T/l.fba"
holds "$(field "$T/look.json" frames) == 300 and $(field "$T/look.json" broken_planes) == 0"

# Sides and lips that are alike are left to the decoder, and come out again.
expect 0 "$B/fapenc" "$T/q.fba" -o "$T/q.fap" --quiet
enc --quant 3 --intra 50 --derive -o "$T/d.fba"
look "$T/d.fba"
holds "$(field "$T/enc.json" written.derived_values) > 0 and $(stat -c %s "$T/d.fba") < $(stat -c %s "$T/q.fba")"
holds "any(g['i_planes_of_type'][2] for g in $(field "$T/look.json" groups))"
expect 0 "$B/fapenc" "$T/d.fba" -o "$T/d.fap" --quiet
cmp -s <(tail -n +2 "$T/d.fap" | cut -d' ' -f1-68) <(tail -n +2 "$T/q.fap" | cut -d' ' -f1-68) || fail "derived FAPs are missing from the text"
enc --bitrate 2 --no-derive -o "$T/n.fba"
holds "$(field "$T/enc.json" written.derived_values) == 0"

# Both inputs: a capture and an .fba.
expect 0 "$B/fapenc" tests/assets/demo_take.c3d --markers tests/assets/demo_markers.csv --bitrate 2 -o "$T/take.fba" --json --quiet
holds "$(field "$T/out" written.largest_2s_kbit_s) <= 2 and $(field "$T/out" written.mean_error_mm) > 0"
expect 0 "$B/fapenc" "$T/q.fba" --bitrate 1.5 -o "$T/again.fba" --json --quiet
holds "$(field "$T/out" written.largest_2s_kbit_s) <= 1.5"

# What excludes each other, and what is no number.
for both in "--quant 3 --bitrate 2" "--bitrate 2 --max-error 1" "--max-error 1 --quant 3"; do
    # shellcheck disable=SC2086
    expect 2 "$B/fapenc" "$T/a.fap" $both -o "$T/x.fba"
    says 'only one of --quant, --bitrate and --max-error'
done
for bad in "--bitrate 0" "--bitrate fast" "--max-error -1" "--look-ahead -1" "--gender x" "--intra 0" "--planes"; do
    # shellcheck disable=SC2086
    expect 2 "$B/fapenc" "$T/a.fap" $bad -o "$T/x.fba"
    says "${bad%% *}"
done
expect 1 "$B/fapenc" "$T/a.fap" --bank "$T/no.fbank" --bitrate 2 -o "$T/x.fba"
says 'no.fbank: No such file'
expect 1 "$B/fapenc" "$T/a.fap" --bank "$T/a.fap" --bitrate 2 -o "$T/x.fba"
says 'a.fap: not a face'
[ ! -e "$T/x.fba" ] || fail "a failed run left an output"
