# The lines of tests/panel/table, each in one, with the values of docs/oracle/cases.csv,
# which is read first, for cases:ID.
BEGIN { FS = "," }
FILENAME ~ /csv$/ { right["cases:" $1] = $3; next }
/^#/ { next }
{ line = line $0 }
sub(/\\$/, "", line) { next }
line ~ /\|/ {
    gsub(/ +/, " ", line)
    while (match(line, /cases:[^ |]+/))
        line = substr(line, 1, RSTART - 1) right[substr(line, RSTART, RLENGTH)] \
            substr(line, RSTART + RLENGTH)
    print line
}
{ line = "" }
