# SPDX-License-Identifier: BSD-2-Clause
# A tool that is stopped leaves no temporary and the output as it was. (Ctrl-C is ignored in a script's background
# jobs, and what is ignored stays so: TERM and HUP stand for it.)
. tests/cli/lib.bash
stream=tests/assets/moments.fap

# is_ignored SIGNAL: by whoever started the tests (nohup ignores HUP); a tool leaves it so.
is_ignored() {
    local mask
    mask=$(sed -n 's/^SigIgn:[[:space:]]*//p' /proc/$$/status)
    [ $((0x$mask >> ($(kill -l "$1") - 1) & 1)) -eq 1 ]
}

for signal in TERM HUP; do
    is_ignored $signal && continue
    echo old >"$T/points.csv"
    "$B/fapplay" $stream --bank builtin --blend zhu --generations 100000 --fps 1000 -o "$T/points.csv" 2>"$T/err" &
    pid=$!
    for _ in $(seq 200); do
        ls "$T"/points.csv.* >/dev/null 2>&1 && break
        sleep 0.02
    done
    ls "$T"/points.csv.* >/dev/null 2>&1 || fail "no temporary to be seen"
    kill -$signal $pid
    status=0
    wait $pid 2>/dev/null || status=$?
    [ "$status" -eq $((128 + $(kill -l $signal))) ] || fail "$signal ends fapplay with $status"
    [ "$(ls "$T")" = "$(printf 'err\npoints.csv')" ] || fail "$signal leaves $(ls "$T" | tr '\n' ' ')"
    [ "$(cat "$T/points.csv")" = old ] || fail "$signal changes the output"
done
