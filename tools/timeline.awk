# Draws the work of each rank, level by level of refinement, as SVG:
#
#     awk -f tools/timeline.awk A.json [B.json ...] >timeline.svg
#
# The files are those of --stats. Each has a panel, a row a rank; time runs to the right,
# in box and triangle tests, the unit of work; all ranks begin a level together. In a row
# the upper bar is the work done, one shade a pass, the lower one the work that was
# predicted, scaled so that all of it is as much as all work done. What stays white up to
# the next level is idle. Linking of all pairs (pass 0), which is even, is left out.

# The numbers of "key": [1, 2, 3], into list[1..]; returns how many.
function numbers(line, list) {
    sub(/.*\[/, "", line)
    sub(/\].*/, "", line)
    return split(line, list, /, */)
}

# The number behind "key": in a line.
function value(line, key) {
    sub(".*\"" key "\": *", "", line)
    return line + 0
}

function text(x, y, anchor, words) {
    printf "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\">%s</text>\n", x, y, anchor,
        words
}

function bar(x, y, width, height, colour) {
    if (width >= 0.2)
        printf "<path fill=\"%s\" d=\"M%.1f %.1fh%.1fv%.1fh-%.1f\"/>\n",
            colour, x, y, width, height, width
}

FNR == 1 {
    panels++
    name[panels] = FILENAME
    sub(/.*\//, "", name[panels])
    sub(/\.json$/, "", name[panels])
}
/^    \{"pass": / {
    number = value($0, "pass")
    if (number > 0)
        pass[panels, level = ++levels[panels]] = number
}
number == 0 {
    next
}
/^     "predicted": / {
    ranks[panels] = numbers($0, list)
    for (r in list) {
        predicted[panels, level, r] = list[r]
        all_predicted[panels] += list[r]
    }
}
/^     "done": / {
    numbers($0, list)
    most = 0
    for (r in list) {
        done[panels, level, r] = list[r]
        all_done[panels] += list[r]
        if (list[r] + 0 > most)
            most = list[r] + 0
    }
    slowest[panels, level] = most
    total[panels] += most
    if (total[panels] > longest)
        longest = total[panels]
}

function panel(p, top,    level, r, x, y, scale, shade) {
    scale = WIDTH / longest
    text(LEFT, top + 14, "start", name[p] ": " total[p] " tests, " \
        sprintf("%.2f", total[p] * ranks[p] / all_done[p]) " of the mean")
    for (r = 1; r <= ranks[p]; r++)
        text(LEFT - 6, top + HEAD + ROW * (r - 0.5) + 4, "end", r - 1)
    x = LEFT
    for (level = 1; level <= levels[p]; level++) {
        shade = pass[p, level] % 2 ? "#3b6fb6" : "#6fa8dc"
        for (r = 1; r <= ranks[p]; r++) {
            y = top + HEAD + ROW * (r - 1)
            bar(x, y + 2, scale * done[p, level, r], 0.5 * ROW - 2, shade)
            if (all_predicted[p] > 0)
                bar(x, y + 0.5 * ROW, scale * predicted[p, level, r] * \
                    all_done[p] / all_predicted[p], 0.3 * ROW - 2, "#e0a030")
        }
        x += scale * slowest[p, level]
        if (scale * slowest[p, level] >= 1)
            bar(x, top + HEAD, 0.4, ROW * ranks[p], "#888")
    }
}

END {
    if (!(longest > 0)) {
        print "timeline: no levels of refinement in these files" >"/dev/stderr"
        exit 1
    }
    WIDTH = 720
    LEFT = 40
    ROW = 16
    HEAD = 20
    GAP = 14
    for (p = 1; p <= panels; p++)
        height += HEAD + ROW * ranks[p] + GAP
    printf "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" " \
        "font-family=\"sans-serif\" font-size=\"12\">\n", LEFT + WIDTH + 20, height + 24
    print "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>"
    for (p = 1; p <= panels; p++) {
        panel(p, top)
        top += HEAD + ROW * ranks[p] + GAP
    }
    text(LEFT, top + 12, "start", "blue: work done, pass by pass; orange: as " \
        "predicted; white: idle; a row is a rank")
    print "</svg>"
}
