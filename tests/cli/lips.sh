# SPDX-License-Identifier: BSD-2-Clause
# Where the demo's speaker says p, b or m, the middles of the inner lips (2.2, 2.3) are at most 0.1 mm apart, by every
# method; elsewhere they open by a centimetre and more.
. tests/cli/lib.bash

expect 0 "$B/fapenc" tests/assets/demo_take.c3d --markers tests/assets/demo_markers.csv --fps 25 --quiet -o "$T/demo.fap"
for method in ga qp zhu pca rbf fat; do
    expect 0 "$B/fapplay" "$T/demo.fap" --bank builtin --blend $method --quiet -o "$T/points.csv"
    awk -F, -v method=$method '
        NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
        { gap = $at["2.2.y"] - $at["2.3.y"]; most = gap > most ? gap : most }
        $1 ~ /^(41|44|53|76|81|93|98|101|103|126)$/ { n++; if (gap > 0.1 || gap < -0.1) { print method ": frame " $1 ": " gap; bad = 1 } }
        END { if (n != 10 || most < 10) { print method ": " n " frames, lips part by " most " mm"; bad = 1 } exit bad }
    ' "$T/points.csv" >"$T/said" || fail "$(cat "$T/said")"
done
