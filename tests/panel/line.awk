# A line of the panel from the figures of one scene (panel.sh): means over orders, and
# with figures of before a second line; a figure worse by more than it scatters has a !.

BEGIN {
    split("seconds work power said said/2 said/10 leaves mean rms worst median tenth " \
          "held noise claim specks grain block most peak " \
          "within", title)
    columns = 21
    # Worse is: larger (+1), smaller (-1), further from 0 (2), nothing (0); and a part by
    # which a figure may move by chance, where one order tells no more.
    split("+1 +1 0 0 0 0 0 2 +1 +1 +1 +1 -1 0 0 +1 +1 +1 +1 0 -1", way)
    split(".15 .05 0 0 0 0 0 .1 .1 .25 .1 .1 .01 0 0 .5 .1 .1 .25 0 .01", chance)
    # Figures below this are alike, in the units of the column.
    split(".05 .1 0 0 0 0 0 .03 .03 .5 .05 .1 .5 0 0 3 .1 .05 3 0 .5", alike)
}
{
    side = $2
    name = $1
    sides[side] = 1
    # Claims are told over what is true.
    if ($7 != "-" && $12 + 0 > 0) $7 = $7 / $12; else $7 = "-"
    if ($8 != "-" && $14 + 0 > 0) $8 = $8 / $14; else $8 = "-"
    if ($9 != "-" && $15 + 0 > 0) $9 = $9 / $15; else $9 = "-"
    for (k = 1; k <= columns; k++) {
        x = $(k + 3)
        if (x == "-" || NF != columns + 3) continue
        n[side, k]++
        sum[side, k] += x
        squares[side, k] += x * x
    }
}
function mean_of(side, k) { return sum[side, k] / n[side, k] }
function scatter(side, k,   m, v) {
    m = n[side, k]
    if (m < 2) return 0
    v = (squares[side, k] - sum[side, k] ^ 2 / m) / (m - 1)
    return v > 0 ? sqrt(v / m) : 0
}
function size(x, k) { return way[k] == 2 && x < 0 ? -x : x }
function worse(k,   now, was, room) {
    if (!n["after", k] || !n["before", k] || way[k] == 0) return ""
    now = size(mean_of("after", k), k)
    was = size(mean_of("before", k), k)
    room = 2 * sqrt(scatter("after", k) ^ 2 + scatter("before", k) ^ 2)
    room += chance[k] * was + alike[k]
    return (way[k] + 0 < 0 ? was - now : now - was) > room ? "!" : ""
}
function cell(side, k,   text) {
    if (!n[side, k]) return "-"
    text = sprintf("%.3g", mean_of(side, k))
    if (k >= 8 && k <= 9 && n[side, k] > 1)
        text = text "+-" sprintf("%.2g", scatter(side, k))
    return text (side == "after" ? worse(k) : "")
}
END {
    if (head == "yes") {
        printf "%-14s", "scene"
        for (k = 1; k <= columns; k++) printf " %*s", k == 8 || k == 9 ? 13 : 8, title[k]
        print ""
    }
    for (turn = 1; turn <= 2; turn++) {
        side = turn == 1 ? "after" : "before"
        if (!(side in sides)) continue
        printf "%-14s", turn == 1 ? name : "  before"
        for (k = 1; k <= columns; k++)
            printf " %*s", k == 8 || k == 9 ? 13 : 8, cell(side, k)
        print ""
    }
}
