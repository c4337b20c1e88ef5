# The table of README.md out of docs/chart.csv: links and seconds that the paper's variant and the
# defaults need for the same leaf error, interpolated on the curves in logarithms. The errors are
# the smallest that the paper's variant reaches, in two digits, and twice that.

BEGIN { FS = "," }

NR > 1 {
    if (!($1 in known)) {
        known[$1] = 1
        scenes[++scene_count] = $1
    }
    key = $1 SUBSEP $2
    k = ++count[key]
    seconds[key, k] = $4; links[key, k] = $5; error[key, k] = $7
    if (k == 1 || $7 < least[key])
        least[key] = $7
}

# Where the curve first comes down to the error: the value of `of`; 0 if it never does.
function needed(of, key, wanted,    k, share) {
    for (k = 1; k <= count[key]; k++)
        if (error[key, k] <= wanted) {
            if (k == 1)
                return of[key, 1]
            share = log(wanted / error[key, k - 1]) / log(error[key, k] / error[key, k - 1])
            return of[key, k - 1] * (of[key, k] / of[key, k - 1]) ^ share
        }
    return 0
}

# In two digits, rounded up.
function rounded(x,    unit) {
    unit = 10 ^ int(log(x) / log(10) - 2)
    return unit * int(x / unit + 1)
}

function ratio(a, b) {
    return a > 0 && b > 0 ? sprintf("%.1f", a / b) : "-"
}

function show(x, format) {
    return x > 0 ? sprintf(format, x) : "not reached"
}

function row(scene, wanted,    paper, all, l, m, s, t) {
    paper = scene SUBSEP "paper"; all = scene SUBSEP "all"
    l = needed(links, paper, wanted); m = needed(links, all, wanted)
    s = needed(seconds, paper, wanted); t = needed(seconds, all, wanted)
    printf "| %s | %.2g %% | %s | %s | %s | %s | %s | %s | %s |\n", scene, 100 * wanted,
        show(l, "%.0f"), show(m, "%.0f"), ratio(l, m), show(s, "%.3f"), show(t, "%.3f"),
        ratio(s, t), show(needed(seconds, scene SUBSEP "paths", wanted), "%.1f")
}

END {
    print "| scene | leaf error | links, paper | links, phr | ratio | seconds, paper | seconds, phr | ratio | seconds, paths |"
    print "|---|---|---|---|---|---|---|---|---|"
    for (i = 1; i <= scene_count; i++) {
        smallest = rounded(least[scenes[i], "paper"])
        row(scenes[i], 2 * smallest)
        row(scenes[i], smallest)
    }
}
