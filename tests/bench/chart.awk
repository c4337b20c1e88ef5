# The table of README.md out of docs/chart.csv: links and seconds that the paper's variant and the
# defaults need for the same leaf error, interpolated on the curves in logarithms. A curve that
# zigzags is read where it comes down for good. The errors are that of the finest run of the
# paper's variant, in two digits rounded up, and twice that.

BEGIN { FS = "," }

NR > 1 {
    if (!($1 in known)) {
        known[$1] = 1
        scenes[++scene_count] = $1
    }
    key = $1 SUBSEP $2
    k = ++count[key]
    seconds[key, k] = $4; links[key, k] = $5; error[key, k] = $7
}

# Where the curve comes down to the error for good: the value of `of`; 0 if it never does.
function needed(of, key, wanted,    k, share) {
    k = count[key]
    if (k == 0 || error[key, k] > wanted)
        return 0
    while (k > 1 && error[key, k - 1] <= wanted)
        k--
    if (k == 1)
        return of[key, 1]
    share = log(wanted / error[key, k - 1]) / log(error[key, k] / error[key, k - 1])
    return of[key, k - 1] * (of[key, k] / of[key, k - 1]) ^ share
}

# In two digits, rounded up.
function rounded(x,    unit) {
    for (unit = 1; unit * 10 > x; unit /= 10)
        ;
    return unit * int(x / unit + 1)
}

function ratio(a, b) {
    return a > 0 && b > 0 ? sprintf(a < 10 * b ? "%.1f" : "%.0f", a / b) : "-"
}

# Three digits; a dash for what is not reached.
function show(x,    unit) {
    if (!(x > 0))
        return "-"
    for (unit = 1; x >= 1000 * unit; unit *= 10)
        ;
    return x < 100 ? sprintf("%.2g", x) : sprintf("%.0f", unit * int(x / unit + 0.5))
}

function row(scene, wanted,    paper, all, l, m, s, t) {
    paper = scene SUBSEP "paper"; all = scene SUBSEP "all"
    l = needed(links, paper, wanted); m = needed(links, all, wanted)
    s = needed(seconds, paper, wanted); t = needed(seconds, all, wanted)
    printf "| %s | %.2g %% | %s | %s | %s | %s | %s | %s |\n", scene, 100 * wanted,
        show(l), show(m), ratio(l, m), show(s), show(t), ratio(s, t)
}

END {
    print "| scene | leaf error | links, paper | links, defaults | ratio | s, paper | s, defaults | ratio |"
    print "|---|---|---|---|---|---|---|---|"
    for (i = 1; i <= scene_count; i++) {
        finest = rounded(error[scenes[i], "paper", count[scenes[i], "paper"]])
        row(scenes[i], 2 * finest)
        row(scenes[i], finest)
    }
}
