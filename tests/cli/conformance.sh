# SPDX-License-Identifier: BSD-2-Clause
# The conformance runner fails when a stream says anything else than what is expected of it.
. tests/cli/lib.bash

refuses() {     # refuses SED-EXPRESSION: planes.expect changed by it
    sed "$1" tests/conformance/fba/planes.expect >"$T/planes.expect"
    expect 1 "$B/conformance" "$T/planes.syntax"
    says 'FAIL: .*planes.syntax'
}

cp tests/conformance/fba/planes.syntax "$T"
cp tests/conformance/fba/planes.expect "$T"
expect 0 "$B/conformance" "$T/planes.syntax"
says '3 passed, 0 failed'
refuses 's/48=17000/48=17001/'
refuses 's/^frame 1 33333/frame 1 33334/'
refuses 's/48=17000/48~17000/'
refuses 's/quant=1/quant=2/'
refuses '/^FAP_E_END/d'
refuses '$a frame 7 233333 48=0'
sed 's/fap_quant 5 1/fap_quant 5 32/' tests/conformance/fba/planes.syntax >"$T/planes.syntax"
expect 1 "$B/conformance" "$T/planes.syntax"
says 'name, bits and value do not fit'
