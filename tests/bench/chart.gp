# Draws docs/chart-seconds.svg and docs/chart-links.svg from docs/chart.csv: error against cost, one
# panel for each scene and norm. Run from the top of the source tree; `make chart` does.

csv = "docs/chart.csv"
set datafile separator ","
set terminal svg size 960,720 font "Helvetica,13" background "white" noenhanced

SCENES = "cornell shadow room"
TITLES = "'Cornell box' 'direct light, exact' 'furnished room'"
NORMS = "leaf shown"
VARIANTS = "error polygon cg rows all+rows paths paper all"
NAMES = "'paper + oracle error' 'paper + polygon' 'paper + cg' 'paper + rows' \
    'defaults + rows' 'path tracer' 'paper' 'defaults of phr'"

# One style for each variant: what is alone is thin, hollow marks; the three that matter are thick.
set style line 1 lc rgb "#0062a0" lw 1.5 dt (6,3) pt 4 ps 0.65
set style line 2 lc rgb "#c05000" lw 1.5 dt (2,2) pt 8 ps 0.75
set style line 3 lc rgb "#777777" lw 1.5 dt (8,3,2,3) pt 2 ps 0.6
set style line 4 lc rgb "#b0508a" lw 1.5 dt (1,3) pt 12 ps 0.8
set style line 5 lc rgb "#008a63" lw 1.5 dt (4,2) pt 10 ps 0.75
set style line 6 lc rgb "#666666" lw 2.2 dt (1,2) pt 13 ps 0.8
set style line 7 lc rgb "#a00000" lw 2.4 dt (7,3) pt 5 ps 0.55
set style line 8 lc rgb "black" lw 2.6 dt 1 pt 7 ps 0.55

set logscale xy
set grid lc rgb "#dddddd" lt 1 lw 0.6
set border lw 0.8
set tics nomirror scale 0.5
unset key

# The error, %, of a point that is on the line asked for; nothing for any other. Closure changes
# nothing in an open scene with one reflecting plane.
is_drawn(scene, variant) = scene ne "shadow" || (variant ne "rows" && strstrt(variant, "+") == 0)
chosen(scene, variant, error) = strcol(1) eq scene && strcol(2) eq variant && \
    is_drawn(scene, variant) ? 100 * error : NaN

LEFT = 0.07; WIDE = 0.265; GAP = 0.052
TOP = 0.955; HIGH = 0.345; BELOW = 0.065

do for [chart in "seconds links"] {
    by = chart eq "seconds" ? 4 : 5
    last = words(VARIANTS)
    set output "docs/chart-".chart.".svg"
    set multiplot
    do for [row = 1:2] {
        do for [panel = 1:3] {
            scene = word(SCENES, panel)
            set lmargin at screen LEFT + (panel - 1) * (WIDE + GAP)
            set rmargin at screen LEFT + (panel - 1) * (WIDE + GAP) + WIDE
            set tmargin at screen TOP - (row - 1) * (HIGH + BELOW)
            set bmargin at screen TOP - (row - 1) * (HIGH + BELOW) - HIGH
            if (row == 1) { set title word(TITLES, panel) offset 0,-0.6 } else { unset title }
            if (row == 2) { set xlabel (chart eq "seconds" ? "seconds, one rank" : "links (k: thousand, M: million)") \
                offset 0,0.4 } else { unset xlabel }
            if (panel == 1) { set ylabel word(NORMS, row)." error, % (RMS)" offset 0.8,0 } \
                else { unset ylabel }
            if (chart eq "seconds") { set xrange [(panel == 3 ? 0.1 : 0.004):20]
                set xtics (0.01, 0.1, 1, 10) } \
            else { set xrange [(panel == 3 ? 1e5 : 80):5e6]
                set xtics ("100" 1e2, "1k" 1e3, "10k" 1e4, "100k" 1e5, "1M" 1e6)
                if (panel == 3) { set xtics add ("300k" 3e5, "3M" 3e6) } }
            if (panel == 2) { set yrange [0.1:60]; set ytics (0.1, 0.3, 1, 3, 10, 30) } \
                else { set yrange [0.8:100]; set ytics (1, 2, 5, 10, 20, 50, 100) }
            plot for [k = 1:last] csv every ::1 using by: \
                (chosen(scene, word(VARIANTS, k), column(4 + 3 * row))) \
                with linespoints ls k title word(NAMES, k)
        }
    }
    # The key: a panel without anything else.
    set lmargin at screen 0.02
    set rmargin at screen 0.98
    set tmargin at screen 0.105
    set bmargin at screen 0.0
    unset title; unset xlabel; unset ylabel; unset tics; unset border; unset grid
    set key at screen 0.5, screen 0.055 center center maxrows 3 reverse Left samplen 4.5 spacing 1.1 width -3
    set xrange [1:10]; set yrange [1:10]
    plot for [k = last:1:-1] NaN with linespoints ls k \
        title (chart eq "links" && word(VARIANTS, k) eq "paths" ? "" : word(NAMES, k))
    unset key; set tics nomirror scale 0.5; set border 31 lw 0.8
    set grid lc rgb "#dddddd" lt 1 lw 0.6
    unset multiplot
}
