# SPDX-License-Identifier: BSD-2-Clause
# GPIO lines and a real window: fapplay-lines is fapplay with lines that are files (tests/gpio/files.c).
. tests/cli/lib.bash
play=$PWD/$B/fapplay-lines
stream=$T/take.fap
chip=$T/chip
export SDL_AUDIODRIVER=dummy

"$play" --help >/dev/null
env -u DISPLAY -u WAYLAND_DISPLAY "$play" tests/golden/blink/stream.fap --bank builtin 2>&1 | grep -q 'without GLFW' &&
    skip "no GLFW in this build"
for tool in Xvfb xdotool; do
    command -v $tool >/dev/null || skip "no $tool here (xvfb, xdotool)"
done
expect 0 "$B/fapenc" tests/assets/demo_take.c3d --markers tests/assets/demo_markers.csv --fps 25 -o "$stream"

export DISPLAY=:$((1100 + RANDOM % 900))
Xvfb "$DISPLAY" -screen 0 1280x1024x24 -nolisten tcp >"$T/xvfb" 2>&1 &
server=$!
trap 'kill $server 2>/dev/null || true; rm -rf "$T"' EXIT
for _ in $(seq 100); do xdotool getdisplaygeometry >/dev/null 2>&1 && break; sleep 0.1; done

# start ARGUMENTS...: returns when lines are listened to.
start() {
    rm -rf "$chip"
    mkdir "$chip"
    mkfifo "$chip/1" "$chip/5" "$chip/6" "$chip/7"
    (cd "$T" && exec "$play" "$stream" --bank builtin --blend qp --size 480x360 --json --trigger "$chip:1" --tally "$chip:T" \
        --frame-sync "$chip:S" --end-pulse "$chip:E:30ms" --button "$chip:5=pause" --button "$chip:6=expression:joy" \
        --button "$chip:7=next" "$@" >"$T/out" 2>"$T/err") &
    player=$!
    until_true grep -q 'waiting for' "$T/err" || fail "does not wait: $(cat "$T/err")"
}
until_true() {
    for _ in $(seq 300); do "$@" && return; sleep 0.05; done
    return 1
}
edge() { printf 1 >"$chip/$1"; }
told() { tr -d ' ' <"$chip/log" | grep "$1" | tr '\n' ' '; }
last() { [ "$(grep "^$1" "$chip/log" | tail -n 1)" = "$1 $2" ]; }
ended() { ! kill -0 $player 2>/dev/null; }
stop() {        # stop STATUS
    local got=0
    until_true ended || fail "does not end"
    wait $player || got=$?
    [ "$got" -eq "$1" ] || fail "exit $got, not $1: $(cat "$T/err")"
    for line in T S E; do last $line 0 || fail "$line stays high: $(cat "$chip/log")"; done
}
# Keys pressed while a server without a window manager moves the focus may be lost: again until it ends.
quit() {
    for _ in $(seq 20); do
        timeout 20 xdotool search --sync --name 'take.fap - fapplay' windowfocus --sync || true
        xdotool key q
        for _ in $(seq 20); do ended && break 2; sleep 0.05; done
    done
    stop 0
}
value() { sed -n "s/^ *\"$1\": \(.*[^,]\),*$/\1/p" "$T/out" | tail -n 1; }
is() { [ "$(value "$1")" = "$2" ] || fail "$1 is $(value "$1"), not $2"; }

# Nothing before the edge; then tally, frames, and at the end the pulse, once.
start
sleep 0.3
[ "$(grep -c 1 "$chip/log" || true)" = 0 ] || fail "sets lines before the edge: $(cat "$chip/log")"
edge 1
until_true last T 1 || fail "the edge starts nothing"
until_true grep -q '^E 1' "$chip/log" || fail "no end: $(tail -n 3 "$chip/log")"
quit
[ "$(told T)" = 'T0 T1 T0 ' ] || fail "the tally: $(told T)"
[ "$(told E)" = 'E0 E1 E0 ' ] || fail "the end pulse: $(told E)"
told S | grep -qE 'S1 S1|S0 S0' && fail "the frame sync does not toggle"
toggles=$(told S | wc -w)
shown=$(value shown_frames)
# the opening; the still picture before the edge; an odd number is put low at the end
[ $((toggles - 1)) -ge $((shown - 1)) ] && [ $((toggles - 1)) -le "$shown" ] || fail "$shown pictures, $toggles toggles"
value trigger_ms | grep -q . || fail "no trigger_ms"

# Buttons: pause, a face, from the beginning.
start --loop
edge 1
until_true last T 1 || fail "the edge starts nothing"
edge 5
until_true last T 0 || fail "the button does not pause"
[ "$(told E)" = 'E0 ' ] || fail "a pause is no end: $(told E)"
edge 6
edge 7
until_true last T 1 || fail "next does not play"
edge 5
until_true last T 0 || fail "the button does not pause again"
quit
is playing false
is expression '"joy"'

# However it ends, lines go low. (What a script puts in the background ignores INT: tests/gpio/cases has that.)
# HUP stays ignored where it was, behind nohup for example.
signals=TERM
[ -n "$(trap -p HUP)" ] || signals="TERM HUP"
for signal in $signals; do
    start --loop
    edge 1
    until_true last T 1 || fail "the edge starts nothing"
    kill -$signal $player
    stop $((128 + $(kill -l $signal)))
done

# A trigger that stays away.
start --trigger "$chip:1:timeout=200ms"
stop 1
grep -q 'no rising edge within 0.2 s' "$T/err" || fail "says: $(cat "$T/err")"
