# SPDX-License-Identifier: BSD-2-Clause
# fapenc inspect: every bit of an .fba is accounted for, in words of at most 100 columns and in JSON.
. tests/cli/lib.bash

# Jaw and head for 4 s; the head is held from frame 60 on.
awk 'BEGIN {
    print "2.1 wave 25 100"
    for (f = 0; f < 100; f++) {
        mask = ""; values = f
        for (fap = 1; fap <= 68; fap++) {
            on = fap == 3 || (fap == 48 && f < 60)
            mask = mask (fap > 1 ? " " : "") on
            if (on) values = values " " int(300 * sin(f / 10 + fap))
        }
        print mask; print values
    }
}' >"$T/a.fap"
expect 0 "$B/fapenc" "$T/a.fap" --quant 2 --intra 40 -o "$T/a.fba"

expect 0 "$B/fapenc" inspect "$T/a.fba"
says '^100 frames at 25 Hz, 4.00 s, 2 FAPs'
says 'fap_quant  2 \(3 I, 97 P\)'
says '7 head .*1 of 3.*frame 60: none'
says '^  3 open_jaw .*-[23][0-9]+\.\.[23][0-9]+ +100'
[ "$(awk '{ if (length > n) n = length } END { print n }' "$T/out")" -le 100 ] || fail "lines are over 100 columns"
expect 0 "$B/fapenc" inspect "$T/a.fba" --planes
[ "$(grep -cE '^ +[0-9]+ +[0-9]+\.[0-9]{3} ' "$T/out")" -eq 100 ] || fail "--planes is not a line a plane"
[ "$(awk '{ if (length > n) n = length } END { print n }' "$T/out")" -le 100 ] || fail "lines are over 100 columns"

expect 0 "$B/fapenc" inspect "$T/a.fba" --planes --json
command -v python3 >/dev/null || skip "no python3 to read JSON with"
python3 - "$T/out" "$T/a.fba" <<'P' || fail "the JSON is not what was encoded"
import json, sys
j = json.load(open(sys.argv[1]))
assert j["format"] == "fba" and j["rate_hz"] == 25 and j["frames"] == 100 and j["length_s"] == 4, j
assert j["intra_frames"] == 3 and j["broken_planes"] == 0 and j["skipped_frames"] == 0
assert j["notices"] == [] and j["broken"] == []
i, p = j["planes"]["i"], j["planes"]["p"]
assert i["planes"] == 3 and p["planes"] == 97 and i["start_codes"] == 2
for k in i, p:
    parts = sum(k[n + "_bits"] for n in ("header", "setup", "range", "fap", "run", "body"))
    assert parts == k["bits"], (parts, k)
assert p["setup_bits"] == p["range_bits"] == 0 and i["range_bits"] > 0
faps = {f["fap"]: f for f in j["faps"]}
assert sorted(faps) == [3, 48] and faps[3]["frames"] == 100 and faps[48]["frames"] == 60
assert sum(f["bits"] for f in j["faps"]) == i["fap_bits"] + p["fap_bits"]
assert all(f["bits"] == f["i_bits"] + f["p_bits"] for f in j["faps"])
assert faps[3]["levels"]["i_max"] <= 60 * 31 // 2
head = j["groups"][6]
assert head["group"] == 7 and head["changes"] == 1 and head["masks"][1]["frame"] == 60, head
assert j["quantisers"] == [{"quant": 2, "i_planes": 3, "planes": 100}]
# The planes, one behind the other, are the stream but for its first code and its end.
planes = j["plane_list"]
assert [q["frame"] for q in planes] == list(range(100))
for a, b in zip(planes, planes[1:]):
    assert a["bit"] + a["bits"] == b["bit"], (a, b)
# The fullest two seconds: counted here once more. Stuffing in front of a code is of the plane before.
data = open(sys.argv[2], "rb").read()
def code_at(q):
    at = q["bit"]
    if not q["start_code"]: return at
    return (at + 7) // 8 * 8 if at % 8 else at + 8 * (data[at // 8] == 0x7F)
starts = [0] + [code_at(q) for q in planes[1:]]
bits = [e - s for s, e in zip(starts, starts[1:] + [j["bytes"] * 8])]
assert j["largest_2s_bits"] == max(sum(bits[k:k + 50]) for k in range(100)), j["largest_2s_bits"]
P

# Damage is named, by bit and plane, and what is left is shown.
head -c $(($(stat -c %s "$T/a.fba") - 60)) "$T/a.fba" >"$T/cut.fba"
expect 0 "$B/fapenc" inspect "$T/cut.fba"
says 'broken and passed over'
says 'bit [0-9]+, plane [0-9]+'

# Text: deviations have their line.
sed 1d "$T/a.fap" >"$T/headless.fap"
expect 0 "$B/fapenc" inspect "$T/headless.fap"
says 'line 1: there is no header'
expect 0 "$B/fapenc" inspect "$T/headless.fap" --json
python3 - "$T/out" <<'P' || fail "the JSON of a .fap is not right"
import json, sys
j = json.load(open(sys.argv[1]))
assert j["format"] == "fap" and j["frames"] == 100 and j["notices"][0]["line"] == 1
P
