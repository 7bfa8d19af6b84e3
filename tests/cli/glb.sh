# SPDX-License-Identifier: BSD-2-Clause
# A face as glTF: read by a checker that shares no code with the writer, and every vertex where the player has it.
. tests/cli/lib.bash
command -v python3 >/dev/null || skip "no python3: nobody here to check a .glb"
check="python3 tests/cli/glb_check.py"
expect 0 "$B/fapenc" tests/assets/demo_take.c3d --markers tests/assets/demo_markers.csv --fps 25 -o "$T/demo.fap"

# Every FAP in motion, head, eyes, pupils and tongue far out.
python3 - >"$T/waves.fap" <<'END'
import math
far = {23: 20000, 24: 20000, 25: 20000, 26: 20000, 47: 60000, 48: 40000, 49: 40000, 50: 40000}
print("2.1 waves 25 12")
for n in range(12):
    print(" ".join("0" if fap < 3 else "1" for fap in range(1, 69)))
    print(n, *(round(far.get(fap, 150) * math.sin(0.37 * n * (1 + fap % 5) / 3 + fap)) for fap in range(3, 69)))
END

# compare STREAM MM OPTIONS...: the export of the built-in face, checked.
compare() {
    local stream=$1 most=$2
    shift 2
    expect 0 "$B/fapplay" "$stream" --bank builtin --quiet --csv vertices -o "$T/v.csv" "$@"
    expect 0 "$B/fapplay" "$stream" --bank builtin --json -o "$T/v.glb" "$@"
    says 'export_worst_error_mm'
    expect 0 $check "$T/v.glb" "$T/v.csv" "$most"
}
compare "$T/waves.fap" 0.05
compare "$T/demo.fap" 0.05 --frames 10:13 --blend rbf
compare "$T/demo.fap" 0.1 --fps 8

mv "$T/v.glb" "$T/long.glb"
compare "$T/demo.fap" 0.05 --frames 60:62

# The checker sees what it should: a number changed anywhere, a file cut, another take.
size=$(stat -c %s "$T/v.glb")
for at in $((size / 3)) $((size / 2)) $((size - 1000)); do
    cp "$T/v.glb" "$T/bad.glb"
    printf '\377\377\177\177' | dd of="$T/bad.glb" bs=1 seek=$((at / 4 * 4)) conv=notrunc 2>/dev/null
    expect 1 $check "$T/bad.glb" "$T/v.csv" 0.1
done
head -c $((size - 4)) "$T/v.glb" >"$T/bad.glb"
expect 1 $check "$T/bad.glb" "$T/v.csv" 0.1
expect 0 "$B/fapplay" "$T/demo.fap" --bank builtin --quiet --frames 60:62 --no-residual --csv vertices -o "$T/other.csv"
expect 1 $check "$T/v.glb" "$T/other.csv" 0.1

# Twice the same bytes; whole or not at all; no gigabytes; not one a frame.
expect 0 "$B/fapplay" "$T/demo.fap" --bank builtin --quiet --fps 8 -o "$T/again.glb"
cmp -s "$T/again.glb" "$T/long.glb" || fail "two runs differ"
expect 1 "$B/fapplay" "$T/demo.fap" --bank builtin -o "$T/no such folder/a.glb"
expect 2 "$B/fapplay" "$T/demo.fap" --bank builtin -o "$T/a_%04d.glb"
python3 -c 'print("2.1 long 25 40000"); m = "0 0 1 " + "0 " * 65
for n in range(40000): print(m); print(n, n % 200)' >"$T/long.fap"
expect 2 "$B/fapplay" "$T/long.fap" --bank builtin --fps 1000 -o "$T/large.glb"
says 'GB'
[ ! -e "$T/large.glb" ] || fail "what is too large was begun"
