# SPDX-License-Identifier: BSD-2-Clause
# Every real .fap file is read, and what is written reads back as the same bytes.
. tests/cli/lib.bash
[ -d "$FAP_SHARED/data/fap" ] || skip "$FAP_SHARED/data/fap is not there"

for file in "$FAP_SHARED"/data/fap/*.fap; do
    expect 0 "$B/fapenc" "$file" -o "$T/once.fap"
    expect 0 "$B/fapenc" "$T/once.fap" -o "$T/twice.fap"
    cmp -s "$T/once.fap" "$T/twice.fap" || fail "$file changes on its second way through"
done
