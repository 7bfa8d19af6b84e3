# SPDX-License-Identifier: BSD-2-Clause
# What other programs read: tables of all kinds, whole or not at all, and never gigabytes.
. tests/cli/lib.bash
expect 0 "$B/fapenc" tests/assets/demo_take.c3d --markers tests/assets/demo_markers.csv --fps 25 -o "$T/demo.fap"
play="$B/fapplay $T/demo.fap --bank builtin --quiet"

for kind in points vertices weights faps arkit; do
    expect 0 $play --frames 10:13 --csv $kind -o "$T/$kind.csv"
    lines=$(wc -l <"$T/$kind.csv")
    [ "$kind" = vertices ] && per_frame=$("$B/fapbank" info builtin --json | sed -n 's/.*"vertices": *\([0-9]*\).*/\1/p') || per_frame=1
    [ "$lines" -eq $((1 + 3 * per_frame)) ] || fail "$kind.csv has $lines lines"
    expect 0 $play --frames 10:13 --csv $kind -o -
    cmp -s "$T/out" "$T/$kind.csv" || fail "$kind: standard output and file differ"
done
expect 0 $play --frames 10:13 -o "$T/default.csv"
cmp -s "$T/default.csv" "$T/points.csv" || fail "points are not what a table has by default"

# The FAPs of a table are those of the stream.
head -n 1 "$T/faps.csv" | grep -q ',open_jaw.MNS,' || fail "no column open_jaw.MNS"

# ARKit as Live Link Face writes it, coefficients within 0 and 1, and somebody speaks.
head -n 1 "$T/arkit.csv" | grep -qE '^Timecode,BlendShapeCount,EyeBlinkLeft,.*,TongueOut,HeadYaw,.*,RightEyeRoll$' || fail "arkit.csv: header"
expect 0 $play --csv arkit -o "$T/arkit.csv"
awk -F, 'NF != 63 { exit 1 } NR > 1 { for (i = 3; i <= 54; i++) if ($i < 0 || $i > 1) exit 1; if ($20 > jaw) jaw = $20 }
    END { exit jaw < 0.2 }' "$T/arkit.csv" || fail "arkit.csv: coefficients"

expect 2 $play --fps 1000 --csv vertices -o "$T/large.csv"
says 'GB'
says '\-\-frames'
[ ! -e "$T/large.csv" ] || fail "what is too large was begun"
expect 1 $play -o "$T/no such folder/points.csv"
expect 2 $play -o "$T/points.png" --csv faps
expect 2 $play -o "$T/points.csv" --csv everything
says 'points, vertices, weights, faps or arkit'
