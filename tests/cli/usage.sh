# SPDX-License-Identifier: BSD-2-Clause
# Every tool: help, version, wrong usage, missing files.
. tests/cli/lib.bash
version=$(sed -n 's/.*FAP_VERSION_STRING "\(.*\)"/\1/p' include/fap/version.h)

for tool in fapenc fapplay fapbank; do
    expect 0 "$B/$tool" --help
    says '[Ee]xample'
    expect 0 "$B/$tool" --version
    says "$tool.* $version"
    expect 2 "$B/$tool"
    expect 2 "$B/$tool" --no-such-option
    [ -s "$T/err" ] || fail "$tool refuses an option without a word"
done

expect 1 "$B/fapenc" "$T/no.c3d" -o "$T/x.fap"
says 'no.c3d'
expect 1 "$B/fapplay" "$T/no.fap" -o "$T/x.png"
says 'no.fap'
expect 1 "$B/fapbank" info "$T/no.fbank"
says 'no.fbank'
[ ! -e "$T/x.fap" ] && [ ! -e "$T/x.png" ] || fail "a failed run left an output"

# Lines of GPIO chips: what can be said without one.
stream=tests/golden/blink/stream.fap
for option in --trigger --tally --frame-sync --end-pulse; do
    expect 2 "$B/fapplay" $stream -o null $option gpiochip0
    says 'CHIP:LINE'
    expect 3 "$B/fapplay" $stream -o null $option /dev/nochip:1
    says "$option /dev/nochip:1: (no such GPIO chip|built without)"
done
expect 2 "$B/fapplay" $stream -o null --tally 0:1:pull-up
says "'pull-up'"
expect 2 "$B/fapenc" $stream -o "$T/x.fap" --trigger 0:1:timeout=0
says "'timeout=0'"
expect 3 "$B/fapenc" $stream -o "$T/x.fap" --trigger /dev/nochip:1
says 'no such GPIO chip|built without'
[ ! -e "$T/x.fap" ] || fail "a capture that never started left an output"
