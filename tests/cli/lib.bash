# SPDX-License-Identifier: BSD-2-Clause
# What the command-line tests share: $B, a temporary folder $T, and words for what is expected.
set -eu
B=${B:-build/release}
T=$(mktemp -d)
trap 'rm -rf "$T"' EXIT
FAP_SHARED=${FAP_SHARED:-../shared}

fail() { echo "FAIL: $*"; exit 1; }
skip() { echo "$*"; exit 77; }

# expect STATUS COMMAND...: runs it, keeps its words in $T/out and $T/err.
expect() {
    local want=$1 got=0
    shift
    "$@" >"$T/out" 2>"$T/err" || got=$?
    [ "$got" -eq "$want" ] || fail "$* gave exit $got, not $want: $(tail -n 5 "$T/err")"
}

# says PATTERN: one of the streams of the last command has it.
says() { grep -qE -- "$1" "$T/out" "$T/err" || fail "nothing says '$1': $(head -n 5 "$T/out" "$T/err")"; }
