# SPDX-License-Identifier: BSD-2-Clause
# fapbank pick: places of a scan are shown with a real mouse in a window of an X server without a screen.
. tests/cli/lib.bash
"$B/fapbank" build builtin -o "$T/face.fbank" -q
cat >"$T/box.obj" <<'O'
v -100 -130 0
v 100 -130 0
v 100 130 0
v -100 130 0
v 0 0 60
f 1 2 5
f 2 3 5
f 3 4 5
f 4 1 5
O

# Without a display: said, and what to do instead.
expect 3 env -u DISPLAY -u WAYLAND_DISPLAY "$B/fapbank" pick "$T/box.obj" --bank builtin -o "$T/points.csv"
grep -q 'built without' "$T/err" && skip "$(cat "$T/err")"
says '--landmarks'
[ ! -e "$T/points.csv" ] || fail "a failure left an output"
expect 2 "$B/fapbank" pick "$T/box.obj"
expect 2 "$B/fapbank" pick -o "$T/points.csv"
expect 1 "$B/fapbank" pick "$T/none.obj" -o "$T/points.csv"
expect 0 "$B/fapbank" pick --help
says 'Backspace'
for tool in Xvfb xdotool import; do
    command -v $tool >/dev/null || skip "no $tool here (xvfb, xdotool, imagemagick)"
done
Xvfb -displayfd 3 -screen 0 1280x1024x24 -nolisten tcp >"$T/xvfb" 2>&1 3>"$T/display" &
server=$!
trap 'kill $server 2>/dev/null || true; rm -rf "$T"' EXIT
for _ in $(seq 100); do [ -s "$T/display" ] && break; sleep 0.1; done
[ -s "$T/display" ] || fail "no X server: $(cat "$T/xvfb")"
DISPLAY=:$(cat "$T/display")
export DISPLAY

start() {
    "$B/fapbank" pick "$T/box.obj" --bank builtin "$@" >"$T/out" 2>"$T/err" &
    picker=$!
    window=$(timeout 60 xdotool search --sync --onlyvisible --name 'where the face is' | head -n 1)
    [ -n "$window" ] || fail "no window: $(cat "$T/err")"
    timeout 10 xdotool windowfocus --sync "$window"
    sleep 0.5
}
click() { xdotool mousemove --window "$window" "$1" "$2" click 1; sleep 0.2; }
key() { xdotool key "$1"; sleep 0.2; }
stop() {
    local got=0
    for _ in $(seq 5); do       # a key may be lost where no window manager holds the focus
        xdotool key "$1" 2>/dev/null || true
        for _ in $(seq 20); do kill -0 $picker 2>/dev/null || break 2; sleep 0.1; done
    done
    wait $picker || got=$?
    [ "$got" -eq "$2" ] || fail "exit $got, not $2: $(cat "$T/err")"
}

# The pyramid's tip is in the middle of each picture that sees it: 420 x 580 pixels each, 62 down. A click beside the scan is none.
start -o "$T/points.csv"
click 630 352       # 3.7, from the front: the tip
click 425 70        # 3.11: nothing there
click 700 352       # 3.11
key space           # 3.8 is left out
click 560 352       # 3.12, which was a mistake
key BackSpace
click 630 450       # 3.12
import -window "$window" "$T/asked.png"
click 630 252       # 3.1: the fourth; now all the others follow
import -window "$window" "$T/followed.png"
cmp -s "$T/asked.png" "$T/followed.png" && fail "the window does not change"
stop Return 0
[ "$(cut -d, -f1 "$T/points.csv" | tr '\n' ' ')" = "name 3.7 3.11 3.12 3.1 " ] || fail "$(cat "$T/points.csv")"
awk -F, '$1 == "3.7" && ($2 ^ 2 + $3 ^ 2 > 1 || $4 < 59) { exit 1 }
         $1 == "3.11" && ($2 < 25 || $2 > 40 || $4 > 50) { exit 1 }
         $1 == "3.12" && ($3 > -30 || $4 > 55) { exit 1 }' "$T/points.csv" || fail "elsewhere: $(cat "$T/points.csv")"

# Going on, with the feature points that follow; turned by a quarter, the front is what was the side.
start -o "$T/more.csv" --landmarks "$T/points.csv" --minor
stop Return 0
[ "$(wc -l <"$T/more.csv")" -gt 12 ] || fail "nothing follows: $(cat "$T/more.csv")"
start -o "$T/turned.csv"
key Right
click 630 352
stop Return 0
[ "$(wc -l <"$T/turned.csv")" -eq 2 ] || fail "$(cat "$T/turned.csv")"
# Twice nearer to the tip: what is 70 pixels beside it is less than half as far off as before.
start -o "$T/near.csv"
xdotool mousemove --window "$window" 630 352
sleep 0.3
key equal
key equal
click 700 352
stop Return 0
awk -F, '$1 == "3.7" && ($2 < 8 || $2 > 20) { exit 1 }' "$T/near.csv" || fail "not nearer: $(cat "$T/near.csv")"
start -o "$T/given_up.csv"
stop Escape 1
[ ! -e "$T/given_up.csv" ] || fail "giving up leaves a table"
