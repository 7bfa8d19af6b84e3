# SPDX-License-Identifier: BSD-2-Clause
# The window in a real X server without a screen: real keys and a real mouse, checked by the report and by pictures.
. tests/cli/lib.bash
here=$PWD
stream=$T/take.fap
face="--bank builtin --blend qp"
export SDL_AUDIODRIVER=dummy
expect 0 "$B/fapenc" tests/assets/demo_take.c3d --markers tests/assets/demo_markers.csv --fps 25 -o "$stream"

# Without a display: said, and what to do instead.
expect 3 env -u DISPLAY -u WAYLAND_DISPLAY "$B/fapplay" "$stream" $face
says '-o NAME'
grep -q 'without GLFW' "$T/err" && skip "no GLFW in this build"
for tool in Xvfb xdotool import; do
    command -v $tool >/dev/null || skip "no $tool here (xvfb, xdotool, imagemagick)"
done

# The server takes a number that is free and says it.
Xvfb -displayfd 3 -screen 0 1280x1024x24 -nolisten tcp >"$T/xvfb" 2>&1 3>"$T/display" &
server=$!
trap 'kill $server 2>/dev/null || true; rm -rf "$T"' EXIT
for _ in $(seq 100); do [ -s "$T/display" ] && break; sleep 0.1; done
[ -s "$T/display" ] || fail "no X server: $(cat "$T/xvfb")"
DISPLAY=:$(cat "$T/display")
export DISPLAY

# start ARGUMENTS...: a window of 720 x 594, whose face has 720 x 500 when there are panels.
start() {
    (cd "$T" && exec "$here/$B/fapplay" "$stream" $face --size 720x594 --json "$@" >"$T/out" 2>"$T/err") &
    player=$!
    window=$(timeout 30 xdotool search --sync --name 'take.fap - fapplay' | head -n 1)
    [ -n "$window" ] || fail "no window: $(cat "$T/err")"
    timeout 10 xdotool windowfocus --sync "$window"
    sleep 0.5
}
keys() { for key in "$@"; do xdotool key "$key"; sleep 0.1; done; }
shot() { sleep 0.4; import -window "$window" "$T/$1.png"; }
# stop STATUS: q ends it, and nothing else has.
stop() {
    local got=0
    kill -0 $player 2>/dev/null || fail "the window is gone: $(cat "$T/err")"
    for press in $(seq 5); do       # a key may be lost where no window manager holds the focus
        xdotool key q
        for _ in $(seq 20); do kill -0 $player 2>/dev/null || break 2; sleep 0.1; done
    done
    kill -9 $player 2>/dev/null && fail "q does not end it"
    wait $player || got=$?
    [ "$got" -eq "${1:-0}" ] || fail "exit $got: $(cat "$T/err")"
}
same() { cmp -s "$T/$1.png" "$T/$2.png" || fail "$1 and $2 differ"; }
differ() { cmp -s "$T/$1.png" "$T/$2.png" && fail "$1 and $2 are the same" || true; }
value() { sed -n "s/^ *\"$1\": \(.*[^,]\),*$/\1/p" "$T/out" | tail -n 1; }
is() { [ "$(value "$1")" = "$2" ] || fail "$1 is $(value "$1"), not $2"; }
# between NAME LEAST MOST
between() { awk -v v="$(value "$1")" "BEGIN { exit !(v >= $2 && v <= $3) }" || fail "$1 is $(value "$1"), not $2 to $3"; }

# Keys that step, seek and set.
start --paused
keys Right Right Right Left Up l p f b 2
stop
is frame 2
is playing false
is speed 1.5
is loop true
is points true
is bars true
is blend '"ga"'
is camera '"left"'
is late_frames 0

start --paused
keys End Left Left Prior
stop
is frame 147
is speed 1

# What is seen: every switch changes the picture, and back; the face is the one of a picture without a window.
start --paused
keys Right Right Right Right Right Right Right Right Right Right
xdotool mousemove --window "$window" 360 200
shot plain
keys w; shot wire; keys w
keys p; shot points; keys p
keys f; shot bars; keys f
keys question; shot help; keys question
keys h; shot bare; keys h
keys F1; shot joy; keys F1
keys 4; shot turned; keys r
shot again
for other in wire points bars help bare joy turned; do differ plain $other; done
same plain again
keys s s
sleep 0.5
stop
is screenshots 2
is screenshot '"take-00010-2.png"'
for name in take-00010 take-00010-2; do
    size=$(identify -format %wx%h "$T/$name.png")
    [ "$size" = 720x500 ] || fail "a picture has $size"
done
status=0
"$B/fapplay" "$stream" $face --size 720x500 --frames 10:11 -o "$T/offscreen.png" 2>/dev/null || status=$?
if [ "$status" -eq 0 ]; then
    far=$(compare -metric AE -fuzz 2% "$T/offscreen.png" "$T/take-00010.png" null: 2>&1 || true)
    [ "${far%.*}" -le 180 ] || fail "window and offscreen differ in $far pixels of 360000"
fi

# Without a window on the screen, OpenGL by GLFW draws the same.
status=0
"$B/fapplay" "$stream" $face --size 720x500 --frames 10:11 --gl glfw -o "$T/glfw.png" 2>/dev/null || status=$?
[ "$status" -eq 0 ] || [ "$status" -eq 3 ] || fail "--gl glfw: exit $status"
if [ "$status" -eq 0 ] && [ -f "$T/offscreen.png" ]; then
    far=$(compare -metric AE -fuzz 2% "$T/offscreen.png" "$T/glfw.png" null: 2>&1 || true)
    [ "${far%.*}" -le 180 ] || fail "GLFW and the first that works differ in $far pixels of 360000"
fi

# In a small window the keys are above the controls: the timeline is seen as before.
start --paused --size 640x480
shot small
keys question
shot small-keys
stop
for name in small small-keys; do
    convert "$T/$name.png" -crop 640x46+0+386 +repage "$T/$name-timeline.ppm"
done
differ small small-keys
cmp -s "$T/small-timeline.ppm" "$T/small-keys-timeline.ppm" || fail "the keys cover the timeline"

# Mouse: turns, zooms, seeks.
start --paused
xdotool mousemove --window "$window" 300 200 mousedown 1
xdotool mousemove --window "$window" 350 220
xdotool mousemove --window "$window" 420 240 mouseup 1
xdotool click 4
sleep 0.3
xdotool mousemove --window "$window" 360 517 click 1
sleep 0.3
stop
is camera '"free"'
between yaw_degrees -60 -20
between pitch_degrees 5 30
between distance 0.85 0.95
between frame 80 95

# Another size, and back on the whole screen and off it.
start --paused
xdotool windowsize --sync "$window" 900 694
sleep 0.5
keys s
sleep 0.5
stop
[ "$(identify -format %wx%h "$T/take-00000.png")" = 900x600 ] || fail "resized: $(identify "$T/take-00000.png")"

# Time goes by, pauses and comes round; the sound is the time.
start --audio "$here/tests/assets/demo_take.wav" --loop
sleep 1
keys space
stop
has_sound=1
grep -q 'built without' "$T/out" "$T/err" && has_sound=0
if [ $has_sound -eq 1 ]; then
    is clock '"sound"'
else
    echo "SKIP: this build has no sound, and what is about sound is not tested"
fi
is playing false
between position_s 0.1 6.9
between shown_frames 3 2000
between av_offset_mean_ms 0 250
start
sleep 1
keys equal End
sleep 0.3
stop
is clock '"monotonic"'
is playing false
is frame 174

# What is played is the sound, sample by sample: SDL's disk driver keeps what it is given, silence before the start too.
SDL_AUDIODRIVER=disk SDL_DISKAUDIOFILE=$T/played.raw start --audio "$here/tests/assets/demo_take.wav"
sleep 1
stop
if [ $has_sound -eq 1 ]; then
    is clock '"sound"'
    python3 - "$T/played.raw" "$here/tests/assets/demo_take.wav" <<'END' || fail "what is played is not the sound"
import sys, wave
with wave.open(sys.argv[2]) as w:
    one, want = w.getsampwidth() * w.getnchannels(), w.readframes(w.getnframes())
got = open(sys.argv[1], 'rb').read()
def heard(data):
    start = next((i for i, b in enumerate(data) if b), len(data))
    return data[start - start % one:]
got, want = heard(got), heard(want)
sys.exit(len(got) < 1000 or got[:min(len(got), 16000)] != want[:min(len(got), 16000)])
END
fi

# No device: it plays all the same.
SDL_AUDIODRIVER=none start --audio "$here/tests/assets/demo_take.wav"
sleep 0.7
stop
is clock '"monotonic"'
[ "$(grep -c 'without sound' "$T/err")" -eq 1 ] || fail "not said once: $(cat "$T/err")"
between position_s 0.05 6.9

# Escape closes the help, then the window.
start --paused
keys question Escape
kill -0 $player || fail "escape closed more than the help"
xdotool key Escape
wait $player || fail "escape: exit $?"

expect 1 "$B/fapplay" "$T/none.fap" $face
expect 1 "$B/fapplay" "$stream" $face --audio "$stream"
expect 1 "$B/fapplay" "$stream" $face --audio "$T/none.wav"
says 'none.wav'
