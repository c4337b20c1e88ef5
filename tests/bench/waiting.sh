#!/bin/sh
# How much more ranks than cores cost: the Cornell box on 2 and on 8 ranks, in turn, five
# times, and the ratio of the medians. Waiting ranks that do not yield make it 10 and
# more.
#
#   sh tests/bench/waiting.sh [few many]

cd "$(dirname "$0")/../.." || exit 2
few=${1:-2}
many=${2:-8}

seconds() {
    ${MPIEXEC:-mpiexec} -n "$1" ./phr scenes/cornell.obj --quiet \
        --stats build/waiting.json || exit 1
    sed -n 's/.*"total".*"max": \([0-9.]*\).*/\1/p' build/waiting.json
}

rm -f build/waiting.few build/waiting.many
for turn in 1 2 3 4 5; do
    seconds "$few" >>build/waiting.few
    seconds "$many" >>build/waiting.many
done
a=$(sort -n build/waiting.few | sed -n 3p)
b=$(sort -n build/waiting.many | sed -n 3p)
awk "BEGIN { printf \"%s ranks %.2f s, %s ranks %.2f s: ratio %.2f\\n\",
    $few, $a, $many, $b, $b / $a }"
