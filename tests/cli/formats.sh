# SPDX-License-Identifier: BSD-2-Clause
# Real files with real faults, none of them a face: fapenc says what is wrong, leaves no output and never crashes.
. tests/cli/lib.bash
dir=$FAP_SHARED/data/takes/format_samples
[ -d "$dir" ] || skip "needs ../shared/data/takes"

for file in "$dir"/*; do
    expect 1 "$B/fapenc" "$file" -o "$T/x.fap"
    says "$(basename "$file"): (trc|c3d|no label is known)"
    [ ! -e "$T/x.fap" ] || fail "$file left an output"
done

# With the truth given they are takes like any other: their faults are in the report.
printf 'Channel101,8.3\nChannel102,8.4\nChannel103,rigid\nChannel104,rigid\nChannel105,rigid\nChannel106,rigid\n' >"$T/map.csv"
expect 0 "$B/fapenc" "$dir/Dance.c3d" --markers "$T/map.csv" --axes +x+y+z -o "$T/x.fap"
says 'POINT:FRAMES 500; the smaller is used'

# What the user says counts more than the file: rate and unit.
take=$FAP_SHARED/data/takes/optical_animface/jaw_60hz.c3d
expect 0 "$B/fapenc" "$take" --take-rate 30 --unit cm --json -o "$T/slow.fap"
says '"rate_hz": 30'
says '"mm_per_unit": 10'

# Landmarks as JSON, from standard input.
table=$FAP_SHARED/data/takes/mediapipe/wolfgang_facemesh478_24fps.csv
python3 - "$table" >"$T/l.json" <<'P'
import csv, json, sys
frames = [{"timestamp_ms": float(r["time_ms"]),
           "faceLandmarks": [[{a: float(r[f"{a}_{i}"]) for a in "xyz"} for i in range(478)]]}
          for r in csv.DictReader(open(sys.argv[1]))]
json.dump(frames, sys.stdout)
P
expect 0 "$B/fapenc" - -o "$T/l.fap" <"$T/l.json"
says 'landmarks JSON, 478 points, 240 frames at 23.976 Hz'
says 'as 16:9'

# OpenFace: eyes and head among the FAPs, and units alone do as well.
expect 0 "$B/fapenc" "$FAP_SHARED/data/takes/openface/openfacer_lara_0001-0600.csv" -o "$T/o.fap"
says '23 yaw_l_eyeball'
says '48 head_pitch'
expect 0 "$B/fapenc" "$FAP_SHARED/data/takes/openface/facsvatar_jt.csv" -o "$T/u.fap"
says 'the head among them'
expect 2 "$B/fapenc" "$FAP_SHARED/data/takes/openface/OpenFace_Test.csv" -o "$T/i.fap"
says 'give it with --take-rate'
expect 0 "$B/fapenc" "$FAP_SHARED/data/takes/openface/OpenFace_Test.csv" --take-rate 25 -o "$T/i.fap"
