# SPDX-License-Identifier: BSD-2-Clause
# The Khronos validator finds neither errors nor warnings. scripts/gltf_validator puts it where this test looks.
. tests/cli/lib.bash
validator=build/npm/node_modules/gltf-validator
command -v node >/dev/null || skip "no node: the Khronos glTF validator cannot run"
[ -d "$validator" ] || skip "no glTF validator: scripts/gltf_validator fetches it with npm"
expect 0 "$B/fapenc" tests/assets/demo_take.c3d --markers tests/assets/demo_markers.csv --fps 25 -o "$T/demo.fap"

validate() {
    node -e '
        const validator = require(process.argv[1]), fs = require("fs");
        validator.validateBytes(new Uint8Array(fs.readFileSync(process.argv[2]))).then(report => {
            const { numErrors, numWarnings, messages } = report.issues;
            for (const m of messages) if (m.severity < 2) console.log(m.code, m.message, m.pointer);
            process.exit(numErrors + numWarnings ? 1 : 0);
        }, error => { console.log(error); process.exit(1); });' "$PWD/$validator" "$1"
}
faces=builtin
[ -f build/default.fbank ] && faces="builtin build/default.fbank"
for face in $faces; do
    expect 0 "$B/fapplay" "$T/demo.fap" --bank "$face" --quiet --frames 60:90 -o "$T/a.glb"
    expect 0 validate "$T/a.glb"
done
head -c 20000 "$T/a.glb" >"$T/cut.glb"
expect 1 validate "$T/cut.glb"
