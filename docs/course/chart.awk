# A chart as SVG, of lines "series x y": a line with marks for each series. An underscore
# in a name shows as a space.
#
#     awk -v title=T -v xlabel=X -v ylabel=Y [-v logx=1] [-v logy=1] \
#         -f docs/course/chart.awk

function place(value, is_log) {
    return is_log ? log(value) / log(10) : value
}

# A step of 1, 2 or 5 times a power of ten, for about five ticks.
function tick_step(range,    step) {
    step = exp(log(10) * int(log(range / 5) / log(10) - (range < 5)))
    while (range / step > 6)
        step *= range / step > 15 ? 5 : 2
    return step
}

function tick_name(at, is_log) {
    if (!is_log)
        return sprintf("%.4g", at)
    return at < -3 || at > 3 ? sprintf("1e%d", at) : sprintf("%.4g", exp(log(10) * at))
}

function text(x, y, anchor, words, more) {
    gsub(/&/, "\\&amp;", words)
    printf "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\"%s>%s</text>\n", x, y,
        anchor, more, words
}

function line(x1, y1, x2, y2, colour) {
    printf "<path d=\"M%.1f %.1fL%.1f %.1f\" stroke=\"%s\"/>\n", x1, y1, x2, y2, colour
}

function across(x) { return 70 + 420 * (x - low_x) / (high_x - low_x) }
function down(y) { return 290 - 240 * (y - low_y) / (high_y - low_y) }

BEGIN {
    n = count = 0
}

NF == 3 && $2 ~ /^[-+.e0-9]+$/ && $3 ~ /^[-+.e0-9]+$/ {
    x[n] = place($2, logx)
    y[n] = place($3, logy)
    if (!($1 in number)) {
        number[$1] = count
        names[count++] = $1
    }
    series[n] = number[$1]
    low_x = n == 0 || x[n] < low_x ? x[n] : low_x
    high_x = n == 0 || x[n] > high_x ? x[n] : high_x
    low_y = n == 0 || y[n] < low_y ? y[n] : low_y
    high_y = n == 0 || y[n] > high_y ? y[n] : high_y
    n++
}

END {
    split("#0060a8 #d04020 #208040 #805090 #a08000 #606060", colours, " ")
    step_x = logx ? 1 : tick_step(high_x - low_x)
    step_y = logy ? 1 : tick_step(high_y - low_y)
    low_y = step_y * int(low_y / step_y - (low_y < 0))
    high_y = step_y * int(high_y / step_y + 0.999 * (high_y > 0))
    print "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 640 340\"" \
        " font-family=\"sans-serif\" font-size=\"13\">"
    print "<rect width=\"640\" height=\"340\" fill=\"white\"/>"
    text(280, 28, "middle", title, " font-size=\"15\"")
    for (at = low_y; at <= high_y + step_y / 1000; at += step_y) {
        line(70, down(at), 490, down(at), "#dddddd")
        text(64, down(at) + 4, "end", tick_name(at, logy))
    }
    for (at = step_x * int(low_x / step_x); at <= high_x + step_x / 1000; at += step_x)
        if (at >= low_x - step_x / 1000) {
            line(across(at), 290, across(at), 50, "#dddddd")
            text(across(at), 306, "middle", tick_name(at, logx))
        }
    text(280, 330, "middle", xlabel)
    text(20, 170, "middle", ylabel, " transform=\"rotate(-90 20 170)\"")
    for (s = 0; s < count; s++) {
        path = ""
        for (i = 0; i < n; i++)
            if (series[i] == s) {
                path = path sprintf("%s%.1f %.1f", path == "" ? "M" : "L", across(x[i]),
                    down(y[i]))
                printf "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3\" fill=\"%s\"/>\n",
                    across(x[i]), down(y[i]), colours[s + 1]
            }
        printf "<path d=\"%s\" fill=\"none\" stroke=\"%s\" stroke-width=\"2\"/>\n", path,
            colours[s + 1]
        name = names[s]
        gsub(/_/, " ", name)
        text(500, 66 + 20 * s, "start", name, " fill=\"" colours[s + 1] "\"")
    }
    print "</svg>"
}
