# Draws docs/scaling.svg from docs/scaling.csv: speed-up against ranks, like the paper's Fig. 3, and on to
# 4,096. Run from the top of the source tree; `make scaling` does.

csv = "docs/scaling.csv"
set datafile separator ","
set terminal svg size 960,460 font "Helvetica,13" background "white" noenhanced
set output "docs/scaling.svg"

SCENES = "room6350 room18510 room31933"
NAMES = "6350 18510 31933"
set style line 1 lc rgb "#0062a0" lw 2 pt 4 ps 0.6
set style line 2 lc rgb "#c05000" lw 2 pt 8 ps 0.7
set style line 3 lc rgb "black" lw 2.2 pt 7 ps 0.5
set style line 9 lc rgb "#aaaaaa" lw 1
set grid lc rgb "#dddddd" lt 1 lw 0.6
set border lw 0.8
set tics nomirror scale 0.5
set key left top reverse Left samplen 3 spacing 1.1
set xlabel "ranks" offset 0,0.4
set ylabel "speed-up" offset 1,0

of(scene, mode, value) = strcol(1) eq scene && strcol(2) eq mode ? value : NaN

set multiplot layout 1,2
set title "run: from counted work (lines), with messages (dashed)" offset 0,-0.6
set xrange [0:33]; set yrange [0:33]
plot x with lines ls 9 title "ranks", \
    for [k = 1:3] csv every ::1 using 3:(of(word(SCENES, k), "counted", column(5))) \
        with linespoints ls k title word(NAMES, k)." triangles", \
    for [k = 1:3] csv every ::1 using 3:(of(word(SCENES, k), "counted", column(8))) \
        with linespoints ls k dt (4,3) notitle
set title "replayed: the same"
set logscale xy 2
set xrange [1:4096]; set yrange [1:4096]
set xtics 4; set ytics 4
plot x with lines ls 9 notitle, \
    for [k = 1:3] csv every ::1 using 3:(of(word(SCENES, k), "simulated", column(5))) \
        with linespoints ls k notitle, \
    for [k = 1:3] csv every ::1 using 3:(of(word(SCENES, k), "simulated", column(8))) \
        with linespoints ls k dt (4,3) notitle
unset multiplot
