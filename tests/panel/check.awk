# The starred lines of the panel against their limits, as TAP: check.awk lines figures.
# Of several orders of faces a mean is within four deviations of theirs, and its limit.

function judge(name, good, text) {
    print (good && !broken[name] ? "ok " : "not ok ") ++count " - " name ": " text
    failed += !good || broken[name]
}
function size(x) { return x < 0 ? -x : x }
function mean_of(name) { return sum[name] / n[name] }
function doubt_of(name,   v) {
    v = squares[name] / n[name] - mean_of(name) ^ 2
    return n[name] > 1 && v > 0 ? 4 * sqrt(v / (n[name] - 1)) : 0
}
function doubts(name) { return n[name] > 1 ? " and " doubt_of(name) : "" }
# A word of the limits.
function check(name, word,   what, limit, part, x) {
    what = limit = word
    if (!sub(/=.*/, "", what) || what == "orders") return
    sub(/.*=/, "", limit)
    x = value[name, what]
    if (what == "mean")
        judge(name, !lost[name] && size(mean_of(name)) <= limit + doubt_of(name),
              "mean " mean_of(name) ", limit " limit doubts(name))
    else if (what == "scatter")
        judge(name, !lost[name] && squares[name] / n[name] <= limit ^ 2,
              "orders are off by " sqrt(squares[name] / n[name]) ", limit " limit)
    else if (what == "claimed")
        judge(name, claimed[name] >= limit + 0,
              claimed[name] + 0 " of " n[name] " means within the claim, of " limit)
    else if (x == "-" && what != "power")
        return # there is no truth by paths here
    else if (split(limit, part, /\+-/) == 2)
        judge(name, x != "-" && size(x - part[1]) <= part[2] + 0,
              what " " x ", limit " limit)
    else if (what == "held" || what == "said")
        judge(name, x >= limit + 0, what " " x ", at least " limit)
    else
        judge(name, size(x) <= limit + 0, what " " x ", limit " limit)
}
NR == FNR {
    split($0, field, "|")
    name = field[1]
    gsub(/[* ]/, "", name)
    limits[name] = field[5]
    next
}
{
    if (!n[$1]++) names[++lines] = $1
    broken[$1] = broken[$1] || NF != 24
    lost[$1] = lost[$1] || $11 == "-"
    value[$1, "power"] = $6; value[$1, "rms"] = $12; value[$1, "worst"] = $13
    value[$1, "held"] = $16; value[$1, "specks"] = $19; value[$1, "peak"] = $23
    value[$1, "claim"] = $18; value[$1, "error"] = $7
    value[$1, "said"] = $12 > 0 ? $7 / $12 : "-"
    sum[$1] += $11
    squares[$1] += $11 ^ 2
    claimed[$1] += $18 != "-" && size($11) <= $18
}
END {
    for (i = 1; i <= lines; i++) {
        words = split(limits[names[i]], word, " ")
        for (k = 1; k <= words; k++) check(names[i], word[k])
    }
    print "1.." count
    exit failed > 0
}
