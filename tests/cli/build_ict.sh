# SPDX-License-Identifier: BSD-2-Clause
# ICT-FaceKit's model as a bank: under ARKit's names, both sides joined where ARKit has one shape.
. tests/cli/lib.bash

I=$FAP_SHARED/data/faces/ict
[ -f "$I/generic_neutral_mesh.obj" ] || skip "no $I"
expect 0 "$B/fapbank" build "ict:$I" -o "$T/ict.fbank"
says 'ICT-FaceKit, 26719 vertices, 84 key models'
expect 0 "$B/fapbank" info "$T/ict.fbank"
says 'points +84 of 84'
says 'unit +mouthSmileLeft'
says 'unit +browInnerUp '
says 'viseme +aa +[1-9]'
says 'teeth_lower [1-9]'
grep -q 'unit *mouthSmile_L\|unit *cheekPuff_\|unit *PupilDilate' "$T/out" && fail "a shape kept its own name"

mkdir "$T/broken"
expect 1 "$B/fapbank" build "ict:$T/broken" -o "$T/no.fbank"
says 'generic_neutral_mesh.obj'
cp "$I/generic_neutral_mesh.obj" "$T/broken"
expect 1 "$B/fapbank" build "ict:$T/broken" -o "$T/no.fbank"
says 'no shape'
mkdir "$T/broken/expressions"
echo '99999 1 1 1' >"$T/broken/expressions/jawOpen.target"
expect 1 "$B/fapbank" build "ict:$T/broken" -o "$T/no.fbank"
says 'jawOpen.target'
[ ! -e "$T/no.fbank" ] || fail "a broken model left a bank"
