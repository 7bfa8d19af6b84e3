# SPDX-License-Identifier: BSD-2-Clause
# A stream over RTP on loopback: played as it was sent, past garbage and other senders; silence is told.
. tests/cli/lib.bash

port=$((20000 + $$ % 20000 / 2 * 2))
url=rtp://127.0.0.1:$port
number() { grep -o "\"$2\": [-0-9.e]*" "$1" | grep -o '[-0-9.e]*$'; }
is() { awk "BEGIN { exit !($1) }" || fail "$1 is not so: $(cat "$T"/*.json "$T"/*.err)"; }
listen() {
    "$B/fapplay" --listen "$url" --bank builtin --json "$@" >"$T/listen.json" 2>"$T/listen.err" &
    listener=$!
    for _ in $(seq 50); do # until it is bound: 127.0.0.1 is 0100007F there
        grep -qi "0100007F:$(printf %04X "$port") " /proc/net/udp && return
        sleep 0.1
    done
    fail "nobody listens: $(cat "$T/listen.err")"
}

# What is wrong is said.
expect 2 "$B/fapplay" tests/assets/moments.fap --send udp://127.0.0.1:5004
says 'rtp://HOST:PORT'
expect 2 "$B/fapplay" tests/assets/moments.fap --send rtp://127.0.0.1
expect 2 "$B/fapplay" tests/assets/moments.fap --send rtp://127.0.0.1:70000
expect 2 "$B/fapplay" --send "$url"
expect 2 "$B/fapplay" tests/assets/moments.fap --listen "$url"
expect 2 "$B/fapplay" --listen "$url" -o film.mp4
expect 1 "$B/fapplay" none.fap --send "$url"
says 'none.fap'
expect 0 "$B/fapplay" --listen --help
says 'aggregate'

# Two seconds, frame by frame.
listen --seconds 3.5 -o "$T/heard.csv" --csv faps
expect 0 "$B/fapplay" tests/assets/moments.fap --send "$url" --loop --seconds 2 --json
cp "$T/out" "$T/send.json"
wait $listener || fail "the listener gave $?: $(cat "$T/listen.err")"
sent=$(number "$T/send.json" frames)
is "$sent >= 45 && $(number "$T/send.json" packets) == $sent"
is "$(number "$T/listen.json" packets) >= $sent - 3 && $(number "$T/listen.json" lost) == 0"
is "$(number "$T/send.json" kbps_on_wire) < 40"
grep -q 'no signal' "$T/listen.err" || fail "silence was not told"
[ "$(wc -l <"$T/heard.csv")" -gt 40 ] || fail "little was played"

# A description says where, and of what type packets are.
"$B/fapplay" tests/assets/moments.fap --send "$url" --sdp "$T/face.sdp" --seconds 0.1 --quiet
grep -q "m=video $port RTP/AVP 96 97" "$T/face.sdp" || fail "$(cat "$T/face.sdp")"
"$B/fapplay" --listen "$T/face.sdp" --bank builtin --seconds 2 --json >"$T/listen.json" 2>"$T/listen.err" &
listener=$!
sleep 0.5
"$B/fapplay" tests/assets/moments.fap --send "$url" --loop --seconds 1 --redundancy always --quiet
wait $listener || fail "the listener gave $?: $(cat "$T/listen.err")"
is "$(number "$T/listen.json" packets) > 15"
sed 's/MP4V-ES/H264/' "$T/face.sdp" >"$T/other.sdp"
expect 1 "$B/fapplay" --listen "$T/other.sdp"
says 'MP4V-ES'
expect 1 "$B/fapplay" --listen "$T/none.sdp"

# Garbage at full speed, and a stranger who speaks RTP: the stream plays on.
listen --seconds 4 -o null
"$B/fapplay" tests/assets/moments.fap --send "$url" --loop --seconds 3 --aggregate 2 --quiet &
sleep 0.8
python3 - "$port" <<'P'
import os, random, socket, struct, sys, time
s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
random.seed(1)
end = time.time() + 1
n = 0
while time.time() < end and n < 40000:
    n += 1
    data = os.urandom(random.randrange(0, 1500))
    if n % 3 == 0:
        data = struct.pack(">BBHII", 0x80, 0x80 | 96, n & 65535, n * 3600 & 0xffffffff, 7) + data
    s.sendto(data, ("127.0.0.1", int(sys.argv[1])))
P
wait $listener || fail "the listener gave $? under garbage: $(cat "$T/listen.err")"
is "$(number "$T/listen.json" malformed) > 100 && $(number "$T/listen.json" foreign) > 100"
is "$(number "$T/listen.json" frames) > 50"
is "$(number "$T/listen.json" packets) > 20"
