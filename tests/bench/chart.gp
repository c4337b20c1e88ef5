# Draws the errors of docs/chart.csv against seconds: OUT-leaf.svg and OUT-shown.svg, one
# panel for each scene.
#
#   gnuplot -e "csv='docs/chart.csv'; out='docs/chart'" tests/bench/chart.gp

set datafile separator ","
SCENES = system("awk -F, 'NR > 1 && !known[$1]++ { print $1 }' ".csv)
PANELS = words(SCENES)
COLUMNS = PANELS < 3 ? PANELS : 3
ROWS = (PANELS + COLUMNS - 1) / COLUMNS
VARIANTS = "paper mended links paths gather"
NAMES = "'the paper' 'the paper, mended' 'links alone' 'path tracer, %s' ". \
    "'phr: links and final gather'"

thousands(n) = n < 1000 ? sprintf("%d", n) : sprintf("%d,%03d", n / 1000, n % 1000)
title_of(scene) = scene eq "cornell" ? "Cornell box, 38 triangles" : \
    scene eq "shadow" ? "direct light, exact truth" : \
    scene[1:4] eq "room" ? "room, ".thousands(int(scene[5:*]))." triangles" : scene

set style line 1 lc rgb "#a00000" lw 1.6 dt (7,3) pt 5 ps 0.5
set style line 2 lc rgb "#d07800" lw 1.6 dt (9,3,2,3) pt 4 ps 0.6
set style line 3 lc rgb "#0062a0" lw 1.6 dt (4,2) pt 9 ps 0.65
set style line 4 lc rgb "#777777" lw 1.8 dt (1,2) pt 13 ps 0.75
set style line 5 lc rgb "black" lw 2.4 dt 1 pt 7 ps 0.55

set logscale xy
set grid lc rgb "#dddddd" lt 1 lw 0.6
set border lw 0.8
set tics nomirror scale 0.5
set xrange [*:*]
set yrange [0.2:100]
set format x "%g"
set xtics (0.0001, 0.001, 0.01, 0.1, 1, 10, 100, 1000)
set ytics (0.2, 0.5, 1, 2, 5, 10, 20, 50, 100)
unset key

# Pixels.
LEFT = 62.0; WIDE = 262.0; GAP = 44.0; TOP = 30.0; HIGH = 240.0; BELOW = 62.0
KEY_ROWS = word("5 3 2", COLUMNS) + 0
KEY = 14 + 20.0 * KEY_ROWS
WIDTH = LEFT + COLUMNS * WIDE + (COLUMNS - 1) * GAP + 16
HEIGHT = ROWS * (TOP + HIGH + BELOW) + KEY
set terminal svg size WIDTH,HEIGHT font "Helvetica,13" background "white" noenhanced

# The value of a point that is on the line asked for; nothing for any other.
only(scene, variant, value) = strcol(1) eq scene && strcol(2) eq variant ? value : NaN

do for [chart in "leaf shown"] {
    from = chart eq "leaf" ? 9 : 12
    set output out."-".chart.".svg"
    set multiplot
    do for [panel = 1:PANELS] {
        scene = word(SCENES, panel)
        place = (panel - 1) % COLUMNS
        x = LEFT + place * (WIDE + GAP)
        y = (panel - 1) / COLUMNS * (TOP + HIGH + BELOW) + TOP
        set lmargin at screen x / WIDTH
        set rmargin at screen (x + WIDE) / WIDTH
        set tmargin at screen 1 - y / HEIGHT
        set bmargin at screen 1 - (y + HIGH) / HEIGHT
        set title title_of(scene) offset 0,-0.6
        set xlabel "seconds, one core" offset 0,0.4
        unset ylabel
        if (place == 0) { set ylabel chart." error, % (RMS)" offset 0.8,0 }
        plot for [k = 1:words(VARIANTS)] csv every ::1 using \
            (only(scene, word(VARIANTS, k), $4)): \
            (only(scene, word(VARIANTS, k), 100 * column(from))) with linespoints ls k
    }
    # The key: a panel without anything else.
    set lmargin at screen 0.02
    set rmargin at screen 0.98
    set tmargin at screen KEY / HEIGHT
    set bmargin at screen 0.0
    unset title; unset xlabel; unset ylabel; unset tics; unset border; unset grid
    set key at screen 0.5, screen 0.5 * KEY / HEIGHT center center maxrows KEY_ROWS \
        reverse Left samplen 3 width -7
    set xrange [1:10]
    set yrange [1:10]
    plot for [k = words(VARIANTS):1:-1] NaN with linespoints ls k title \
        sprintf(word(NAMES, k), chart eq "leaf" ? "same leaves" : "as many points")
    unset key
    set xrange [*:*]
    set yrange [0.2:100]
    set xtics (0.0001, 0.001, 0.01, 0.1, 1, 10, 100, 1000) nomirror scale 0.5
    set ytics (0.2, 0.5, 1, 2, 5, 10, 20, 50, 100) nomirror scale 0.5
    set border 31 lw 0.8
    set grid lc rgb "#dddddd" lt 1 lw 0.6
    unset multiplot
}
