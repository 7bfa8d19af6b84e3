# SPDX-License-Identifier: BSD-2-Clause
# The default face as it was built, and banks that are damaged.
. tests/cli/lib.bash
bank=build/default.fbank
[ -e "$bank" ] || fail "$bank was not built"

expect 0 "$B/fapbank" info "$bank"
for number in '84' '14' '6' '11'; do says "\\b$number\\b"; done
expect 0 "$B/fapbank" info "$bank" --json
for size in 0 7 64 5000; do
    head -c "$size" "$bank" >"$T/cut.fbank"
    expect 1 "$B/fapbank" info "$T/cut.fbank"
done
cp "$bank" "$T/bad.fbank"
printf '\377\377\377\377' | dd of="$T/bad.fbank" bs=1 seek=3000 conv=notrunc status=none
expect 1 "$B/fapbank" info "$T/bad.fbank"
