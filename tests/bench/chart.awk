# The tables of docs/accuracy.md out of docs/chart.csv.
#
# Seconds for a leaf error: interpolated on the curve in logarithms; one that zigzags is
# read where it comes down for good. The path tracer's are for the leaves of phr's runs:
# its error falls as one over the square root of its seconds, so a run of t seconds with
# an error of x would take t (x / e)^2 for the error e that phr has at those leaves, and
# that curve is read as the others are. Where phr does not get there, it is read at phr's
# finest run.
#
# Slopes: of the decade of seconds that ends with a run, interpolated on the curve.

BEGIN { FS = "," }

NR > 1 {
    if (!($1 in known)) {
        known[$1] = 1
        scenes[++scene_count] = $1
    }
    key = $1 SUBSEP $2
    k = ++count[key]
    seconds[key, k] = $4; error[key, k] = $9
    samples[key] += $7; rays[key] += $8; time[key] += $4
    place[$1, $2, $3] = k
    if ($2 == "paths")
        match_error($1, $3, $9, $4)
}

# The path tracer's seconds for the error of the gather with the same setting.
function match_error(scene, setting, error_now, seconds_now,    g, key, k) {
    g = place[scene, "gather", setting]
    if (!g)
        return
    key = scene SUBSEP "matched"
    k = ++count[key]
    error[key, k] = error[scene SUBSEP "gather", g]
    seconds[key, k] = seconds_now * (error_now / error[key, k]) ^ 2
}

# Where the curve comes down to the error for good: seconds; 0 if it never does.
function needed(key, wanted,    k, share) {
    k = count[key]
    if (k == 0 || error[key, k] > wanted)
        return 0
    while (k > 1 && error[key, k - 1] <= wanted)
        k--
    if (k == 1)
        return seconds[key, 1]
    share = log(wanted / error[key, k - 1]) / log(error[key, k] / error[key, k - 1])
    return seconds[key, k - 1] * (seconds[key, k] / seconds[key, k - 1]) ^ share
}

# For the path tracer.
function traced(scene, wanted,    key, k) {
    key = scene SUBSEP "matched"
    k = count[key]
    if (k == 0)
        return 0
    if (error[key, k] > wanted)
        return seconds[key, k] * (error[key, k] / wanted) ^ 2
    return needed(key, wanted)
}

# The error at this many seconds, between two runs or beyond the last.
function error_at(key, t,    k, share) {
    for (k = 2; k < count[key] && seconds[key, k] < t; k++)
        ;
    share = log(t / seconds[key, k - 1]) / log(seconds[key, k] / seconds[key, k - 1])
    return error[key, k - 1] * (error[key, k] / error[key, k - 1]) ^ share
}

# d log error / d log seconds, over the decade of seconds before a run.
function slope(key, k) {
    return log(error[key, k] / error_at(key, seconds[key, k] / 10)) / log(10)
}

# That of the steepest decade, and of the last.
function slopes(key,    k, least, last) {
    for (k = 2; k <= count[key]; k++)
        if (seconds[key, k] >= 10 * seconds[key, 1] && error[key, k] > 0) {
            last = slope(key, k)
            least = last < least ? last : least
        }
    return last ? sprintf("%.2f, %.2f", least, last) : "-"
}

# Two digits; a dash for an error not reached.
function show(x,    unit) {
    if (!(x > 0))
        return "-"
    for (unit = 1; x >= 100 * unit; unit *= 10)
        ;
    return x < 10 ? sprintf("%.2g", x) : sprintf("%.0f", unit * int(x / unit + 0.5))
}

function ratio(a, b) {
    return a > 0 && b > 0 ? show(a / b) : "-"
}

function row(scene, wanted,    gather, paths) {
    gather = needed(scene SUBSEP "gather", wanted); paths = traced(scene, wanted)
    printf "| %s | %g %% | %s | %s | %s | %s | %s | %s |\n", scene, 100 * wanted,
        show(needed(scene SUBSEP "paper", wanted)),
        show(needed(scene SUBSEP "mended", wanted)),
        show(needed(scene SUBSEP "links", wanted)),
        show(gather), show(paths), ratio(paths, gather)
}

# Million rays a second.
function rate(key) {
    return time[key] > 0 ? 1e-6 * rays[key] / time[key] : 0
}

# By the octree and by Embree.
function rates(key) {
    return show(rate(key "octree")) " | " show(rate(key "embree")) " | " \
        ratio(rate(key "octree"), rate(key "embree"))
}

function second_row(scene,    paths) {
    paths = scene SUBSEP "paths"
    printf "| %s | %s | %s | %s | %s | %s | %s | %s | %s |\n", scene,
        slopes(scene SUBSEP "links"), slopes(scene SUBSEP "gather"), slopes(paths),
        show(samples[paths] * 1e-6), ratio(rays[paths], samples[paths]),
        show(rate(paths)), rates(paths " "), rates(scene SUBSEP)
}

END {
    print "| scene | leaf error | s, paper | s, mended | s, links alone | s, phr |" \
        " s, path tracer | ratio |"
    print "|---|---|---|---|---|---|---|---|"
    for (i = 1; i <= scene_count; i++) {
        row(scenes[i], 0.05)
        row(scenes[i], 0.02)
        row(scenes[i], 0.01)
    }
    print ""
    print "| scene | slopes, links alone | phr | path tracer | million paths " \
        "| rays a path | million rays/s | paths, octree | Embree | ratio " \
        "| first hits, octree | Embree | ratio |"
    print "|---|---|---|---|---|---|---|---|---|---|---|---|---|"
    for (i = 1; i <= scene_count; i++)
        second_row(scenes[i])
}
