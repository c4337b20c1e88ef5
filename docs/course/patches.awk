# Patches as SVG, seen in parallel from a point far away: what faces away is left out, so
# that one looks into a room through its walls. Lines are "ID B" and nine coordinates, as
# leaves and radiosity write them.
#
#     awk -v from="2 -3 2" -v white=W [-v names=1] [-v owners=1] \
#         -f docs/course/patches.awk
#
# `white` is the radiosity that is shown as white; with `names` each patch has its ID and
# nothing else, with `owners` a colour for each B, which is a rank.

function shade(b,    grey) {
    if (names)
        return "#ffffff"
    if (owners)
        return tints[b % 8 + 1]
    grey = b <= 0 ? 0 : b >= white ? 1 : exp(log(b / white) / 2.2)
    return sprintf("#%02x%02x%02x", 255 * grey, 255 * grey, 255 * grey)
}

BEGIN {
    split("#8dd3c7 #fdb462 #bebada #fb8072 #80b1d3 #b3de69 #fccde5 #ffed6f", tints, " ")
    split(from, d, " ")
    size = sqrt(d[1] * d[1] + d[2] * d[2] + d[3] * d[3])
    for (k = 1; k <= 3; k++)
        d[k] /= size
    flat = sqrt(d[1] * d[1] + d[2] * d[2])
    right[1] = flat > 0 ? -d[2] / flat : 1
    right[2] = flat > 0 ? d[1] / flat : 0
    up[1] = -d[3] * right[2]
    up[2] = d[3] * right[1]
    up[3] = d[1] * right[2] - d[2] * right[1]
    n = 0
    low_x = low_y = 1e9
    high_x = high_y = -1e9
    sorted = "sort -n -k 1,1"
}

{
    for (k = 0; k < 3; k++) {
        i = 3 + 3 * k
        x[k] = right[1] * $i + right[2] * $(i + 1)
        y[k] = -(up[1] * $i + up[2] * $(i + 1) + up[3] * $(i + 2))
        z[k] = d[1] * $i + d[2] * $(i + 1) + d[3] * $(i + 2)
    }
    if ((x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]) >= 0)
        next # it faces away (y is downwards here)
    for (k = 0; k < 3; k++) {
        low_x = x[k] < low_x ? x[k] : low_x
        high_x = x[k] > high_x ? x[k] : high_x
        low_y = y[k] < low_y ? y[k] : low_y
        high_y = y[k] > high_y ? y[k] : high_y
    }
    sum = z[0] + z[1] + z[2]
    line[n] = sprintf("%s %s %.5f %.5f %.5f %.5f %.5f %.5f", $1, $2, x[0], y[0],
        x[1], y[1], x[2], y[2])
    depth[n++] = sum
}

END {
    scale = 480 / (high_x - low_x)
    height = scale * (high_y - low_y)
    printf "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 500 %.0f\"" \
        " font-family=\"sans-serif\" text-anchor=\"middle\" stroke-linejoin=\"round\">\n",
        height + 20
    printf "<rect width=\"500\" height=\"%.0f\" fill=\"white\"/>\n", height + 20
    printf "<g stroke=\"%s\" stroke-width=\"%s\">\n", names ? "#606060" : "#7090b0",
        names ? 1 : 0.4
    fflush()
    for (i = 0; i < n; i++) {
        split(line[i], p, " ")
        for (k = 3; k <= 7; k += 2) {
            p[k] = 10 + scale * (p[k] - low_x)
            p[k + 1] = 10 + scale * (p[k + 1] - low_y)
        }
        printf "%.5f <path d=\"M%.1f %.1fL%.1f %.1fL%.1f %.1fZ\" fill=\"%s\"/>\n",
            depth[i], p[3], p[4], p[5], p[6], p[7], p[8], shade(p[2]) | \
            (sorted " | cut -d ' ' -f 2-")
        if (names)
            label[i] = sprintf("<text x=\"%.1f\" y=\"%.1f\" font-size=\"%.1f\">%s</text>",
                (p[3] + p[5] + p[7]) / 3, (p[4] + p[6] + p[8]) / 3 + 3,
                sqrt((p[7] - p[3]) * (p[6] - p[4]) - \
                    (p[5] - p[3]) * (p[8] - p[4])) / 9 + 2,
                p[1])
    }
    close(sorted " | cut -d ' ' -f 2-")
    print "</g>"
    for (i in label)
        print label[i]
    print "</svg>"
}
