# A page of docs/ has its words, and a command makes its tables, by processor seconds:
# `. tests/bench/renew.sh`.

# renew PAGE FROM [TO]: the standard input takes the place of the lines behind the one
# that begins with FROM, up to the line TO, or to the end of the page. Fails, and leaves
# the page, if FROM is not there.
renew() {
    awk -v from="$2" -v to="${3:-}" '
        NR == FNR { made = made $0 "\n"; next }
        to != "" && $0 == to { skip = 0 }
        !skip
        index($0, from) == 1 { printf "%s", made; found = skip = 1 }
        END { exit !found }' - "$1" >"$1.new" && mv "$1.new" "$1"
}

# processor_seconds: of the children that a shell's `times` tells of.
processor_seconds() {
    sed 's/[ms]/ /g' | awk 'END { print 60 * $1 + $2 + 60 * $3 + $4 }'
}
