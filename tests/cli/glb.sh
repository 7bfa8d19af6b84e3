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

# A texture lies on the skin in place of its colours, where the face has coordinates for it.
python3 - "$T/skin.png" <<'END'
import struct, sys, zlib
def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
rows = b"".join(b"\0" + bytes((x * 8, y * 8, 128)[k] for x in range(32) for k in range(3)) for y in range(32))
open(sys.argv[1], "wb").write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 32, 32, 8, 2, 0, 0, 0)) +
                              chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))
END
expect 1 "$B/fapplay" "$T/demo.fap" --bank builtin --texture "$T/skin.png" -o "$T/skin.glb"
says 'no texture coordinates'
if grep -q '^makehuman:' build/default.fbank.from 2>/dev/null; then
    face="$B/fapplay $T/demo.fap --bank build/default.fbank --quiet --frames 60:61"
    expect 1 $face --texture "$T/demo.fap" -o "$T/skin.glb"
    says 'no PNG'
    expect 0 $face --texture "$T/skin.png" -o "$T/skin.glb"
    expect 0 $face --csv vertices -o "$T/skin.csv"
    expect 0 $check "$T/skin.glb" "$T/skin.csv" 0.05
    grep -aq 'baseColorTexture' "$T/skin.glb" || fail "no texture in it"
fi

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
