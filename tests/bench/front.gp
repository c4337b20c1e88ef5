# Draws docs/front.csv: errors of pictures against seconds, a panel for each scene, a
# colour for each number of rays; blocks filled, pixels open. Called as chart.gp is; makes
# OUT.svg.
set datafile separator ","
SCENES = system("awk -F, 'NR > 1 && !known[$1]++ { print $1 }' ".csv)
RAYS = system("awk -F, 'NR > 1 { print $2 }' ".csv." | sort -nu")
COLUMNS = (words(SCENES) + 1) / 2
set terminal svg size 440 * COLUMNS,640 font "Helvetica,13" background "white" noenhanced
set output out.".svg"
set logscale xy
set grid lc rgb "#dddddd" lt 1 lw 0.6
set tics nomirror scale 0.5
set format "%g"
set key bottom left samplen 1 spacing 0.9
set xlabel "seconds, one core" offset 0,0.4
set ylabel "error, % (RMS)" offset 0.8,0
set linetype 5 lc rgb "black"
only(scene, rays, value) = strcol(1) eq scene && column(2) == rays ? value : NaN
set multiplot layout 2,COLUMNS
do for [scene in SCENES] {
    set title scene offset 0,-0.6
    plot for [k = 1:words(RAYS)] csv every ::1 using \
        (only(scene, word(RAYS, k) + 0, $4)):(only(scene, word(RAYS, k) + 0, $6)) \
        with points pt 7 lc k title word(RAYS, k)." rays", \
        for [k = 1:words(RAYS)] csv every ::1 using \
        (only(scene, word(RAYS, k) + 0, $4)):(only(scene, word(RAYS, k) + 0, $5)) \
        with points pt 6 lc k notitle
}
unset multiplot
