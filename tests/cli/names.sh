# SPDX-License-Identifier: BSD-2-Clause
# --visemes and --expressions: what was spoken as low-level FAPs and captured again gets its names back.
. tests/cli/lib.bash

# A face that smiles, as coefficients; and a table of them is a capture.
{
    echo "frame,time,mouthSmileLeft,mouthSmileRight,cheekSquintLeft,cheekSquintRight,jawOpen,browInnerUp"
    for i in $(seq 0 59); do
        awk "BEGIN { s = $i < 20 ? 0 : 1; printf \"%d,%.4f,%g,%g,%g,%g,0,0\n\", $i, $i / 30, 0.9 * s, 0.9 * s, 0.5 * s, 0.5 * s }"
    done
} >"$T/smile.csv"
expect 0 "$B/fapenc" "$T/smile.csv" -o "$T/smile.fap" --expressions --visemes
says 'FAP 2, expressions, frames each: joy [0-9]+'
expect 0 "$B/fapenc" "$T/smile.csv" -o "$T/smile.fap" --expressions --json
says '"joy": [1-9]'
grep -q '"viseme_frames"' "$T/out" && fail "visemes were not asked for"

# Frames that say FAP 2 say joy: mask bit 2, expression 1.
expect 0 "$B/fapenc" inspect "$T/smile.fap"
says 'expression'
expect 0 "$B/fapenc" tests/assets/demo_take.c3d --markers tests/assets/demo_markers.csv -o "$T/demo.fap" --visemes
says 'FAP 1, visemes'
grep -q 'not sent: 1' "$T/err" && fail "FAP 1 is sent and said not to be"
expect 0 "$B/fapenc" tests/assets/demo_take.c3d --markers tests/assets/demo_markers.csv -o "$T/plain.fap"
says 'not sent: 1 2: .*--visemes'
expect 2 "$B/fapenc" --phonemes x.tsv --visemes -o "$T/x.fap"
