# The starred lines of the panel against their limits, as TAP: check.awk table figures.

function judge(good, text) {
    print (good ? "ok " : "not ok ") ++count " - " text
    failed += !good
}
NR == FNR {
    if (/^#/ || split($0, field, "|") < 5) next
    name = field[1]
    gsub(/[* ]/, "", name)
    limits[name] = field[5]
    next
}
{
    value["power"] = $6; value["mean"] = $11; value["rms"] = $12; value["worst"] = $13
    value["held"] = $16; value["specks"] = $18; value["peak"] = $22
    words = split(limits[$1], word, " ")
    for (k = 1; k <= words; k++) {
        what = word[k]
        limit = word[k]
        if (!sub(/=.*/, "", what)) continue
        sub(/.*=/, "", limit)
        if (!(what in value) || (value[what] == "-" && what !~ /mean|power/))
            continue # there is no truth by paths here
        x = value[what]
        if (split(limit, part, /\+-/) == 2)
            good = x != "-" && (x - part[1]) ^ 2 <= part[2] ^ 2
        else if (what == "held")
            good = x != "-" && x + 0 >= limit + 0
        else
            good = x != "-" && x ^ 2 <= limit ^ 2
        judge(good && NF == 22,
              $1 ": " what " " x ", " (what == "held" ? "at least " : "limit ") limit)
    }
}
END {
    print "1.." count
    exit failed > 0
}
