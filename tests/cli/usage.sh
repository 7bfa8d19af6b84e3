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
