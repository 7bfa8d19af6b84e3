# SPDX-License-Identifier: BSD-2-Clause
# Coefficients become FAPs, FAPs become a Live Link table, and that becomes FAPs again.
. tests/cli/lib.bash

# Two seconds at 30 in a time code of sixtieths, one frame dropped; the jaw opens once.
python3 - "$T/a.csv" <<'P' || skip "needs python3"
import math, sys
with open(sys.argv[1], "w") as f:
    f.write("Timecode,BlendShapeCount,EyeBlinkLeft,EyeBlinkRight,JawOpen,MouthSmileLeft,MouthSmileRight,BrowInnerUp,Angry\r\n")
    for i in range(61):
        jaw = max(0, math.sin(math.pi * (i - 15) / 30)) if 15 <= i <= 45 else 0
        if i != 20:
            f.write("10:00:%02d:%06.3f,61,0,0,%.4f,0.5,0.5,0.2,7\r\n" % (i // 30, i % 30 * 2, jaw))
P
expect 0 "$B/fapenc" "$T/a.csv" -o "$T/a.fap" --fps 30
says 'livelink, 61 frames at 30 Hz'
says '1 of 61 frames are absent'
says 'Angry'
expect 0 "$B/fapenc" inspect "$T/a.fap" --json
python3 - "$T/out" <<'P' || fail "the jaw did not open"
import json, sys
faps = {f["fap"]: f for f in json.load(open(sys.argv[1]))["faps"]}
assert abs(faps[3]["max"] - 1095) < 30, faps[3]
assert 45 not in faps or faps[45]["max"] <= 0
assert 48 not in faps
P

expect 0 "$B/fapenc" "$T/a.csv" -o "$T/b.fap" --fps 30 --neutral 0 --start 0.2 --end 1.5 --json
python3 - "$T/out" <<'P' || fail "--json says something else"
import json, sys
r = json.load(open(sys.argv[1]))
assert r["take"]["format"] == "livelink" and r["frames"] == 40, r
smile = [c for c in r["coefficients"] if c["name"] == "MouthSmileLeft"][0]
assert abs(smile["rest"] - 0.5) < 1e-6, smile
P
expect 2 "$B/fapenc" "$T/a.csv" -o "$T/b.fap" --neutral 61
says 'frames 0 to 60'

# And back.
expect 0 "$B/fapenc" "$T/a.fap" --bank builtin -o "$T/back.csv"
says '61 frames at 30 Hz'
python3 - "$T/a.csv" "$T/back.csv" <<'P' || fail "the coefficients did not come back"
import csv, sys
a, b = (list(csv.DictReader(open(n))) for n in sys.argv[1:])
assert len(b[0]) == 63 and len(b) == 61, (len(b[0]), len(b))
a.insert(20, None)
worst = max(abs(float(x[k]) - float(y[k])) for x, y in zip(a, b) if x for k in ("JawOpen", "EyeBlinkLeft", "MouthSmileLeft", "BrowInnerUp"))
assert worst < 0.2, worst
P
expect 0 "$B/fapenc" "$T/back.csv" -o "$T/again.fba" --quant 1
says 'kbit/s'

# Pictures without times: no rate is made up, and --take-rate is one.
sed 's/^10:00:0[0-9]:\([0-9.]*\),/\1,/; s/^Timecode/image/' "$T/a.csv" >"$T/frames.csv"
expect 2 "$B/fapenc" "$T/frames.csv" -o "$T/c.fap"
says 'take-rate'
expect 0 "$B/fapenc" "$T/frames.csv" --take-rate 30 -o "$T/c.fap"
says 'image'

printf 'AU01_r,AU02_r,AU03_r,AU08_r\n1,2,3,4\n' >"$T/three.csv"
expect 1 "$B/fapenc" "$T/three.csv" -o "$T/d.fap"
says 'OpenFace 3'

for take in livelink/alex_rom_3.csv livelink/MySlate_164_iPhone_cal.csv livelink/dao.gesichter openface/facsvatar_jt.csv; do
    [ -e "$FAP_SHARED/data/takes/$take" ] || skip "no test data: real takes are not tried"
    expect 0 "$B/fapenc" "$FAP_SHARED/data/takes/$take" -o "$T/real.fba"
done
