# SPDX-License-Identifier: BSD-2-Clause
# fapenc track --pick: dots are shown with a real mouse in a window of an X server without a screen.
. tests/cli/lib.bash
command -v ffmpeg >/dev/null || skip "no ffmpeg"
"$B/mirror-film" --size 320x240 --dot 5 --samples 2 --seconds 0.3 --mirrors 0 "$T/film"
printf '8.4\n8.3\nruler A\nnowhere\n' >"$T/labels"

# Without a display: said, and what to do instead.
expect 3 env -u DISPLAY -u WAYLAND_DISPLAY "$B/fapenc" track "$T/film.y4m" --pick "$T/dots.csv" --mirrors 0
says '--init'
grep -q 'built without' "$T/err" && skip "no GLFW or cairo in this build"
expect 2 "$B/fapenc" track "$T/film.y4m" --pick "$T/dots.csv" --init "$T/film.csv"
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

# start ARGUMENTS...: a window whose picture is twice as large, 58 pixels down.
start() {
    "$B/fapenc" track "$T/film.y4m" --labels "$T/labels" --mirrors 0 "$@" >"$T/out" 2>"$T/err" &
    picker=$!
    window=$(timeout 30 xdotool search --sync --onlyvisible --name 'where the dots are' | head -n 1)
    [ -n "$window" ] || fail "no window: $(cat "$T/err")"
    timeout 10 xdotool windowfocus --sync "$window"
    sleep 0.5
}
click() { xdotool mousemove --window "$window" "$(at "$1" 2 0)" "$(at "$1" 3 58)" click 1; sleep 0.2; }
# A dot's place in the window: twice the picture's, in whole pixels.
at() { awk -F, -v l="$1" -v c="$2" -v d="$3" '$1 == l { printf "%d", 2 * $c + d + 1 }' "$T/film.csv"; }
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

start --pick "$T/dots.csv" -o "$T/take.trc"
click 8.4
click 8.4       # not where 8.3 is: back, and again
key BackSpace
click 8.3
import -window "$window" "$T/asked.png"
click "ruler A"
key space
import -window "$window" "$T/done.png"
cmp -s "$T/asked.png" "$T/done.png" && fail "the window does not change"
stop Return 0
[ "$(cut -d, -f1 "$T/dots.csv" | tr '\n' ' ')" = "label 8.4 8.3 ruler A " ] || fail "$(cat "$T/dots.csv")"
join -t, <(sort "$T/dots.csv") <(sort "$T/film.csv") | awk -F, '$1 != "label" && ($2 - $4) ^ 2 + ($3 - $5) ^ 2 > 1 { exit 1 }' ||
    fail "clicked elsewhere: $(cat "$T/dots.csv")"
[ "$(sed -n 3p "$T/take.trc" | cut -f 4)" = 3 ] || fail "the take's points: $(sed -n 3p "$T/take.trc")"
[ -n "${KEEP:-}" ] && cp "$T/asked.png" "$KEEP"

# Giving up writes nothing.
start --pick "$T/never.csv"
click 8.4
stop Escape 1
says 'nothing was written'
[ -e "$T/never.csv" ] && fail "written in spite of Escape"
exit 0
