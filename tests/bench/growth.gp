# docs/growth.csv as docs/growth.svg: read without colour, by marks and labels.
set datafile separator ","
set terminal svg size 760,520 font "Helvetica,13" background "white" noenhanced
set output "docs/growth.svg"
set logscale xy
set xlabel "triangles k"
set ylabel "links"
set y2label "seconds on two cores"
set logscale y2
set format y "%.0e"
set xtics (6350, 18500, 32000, 100000, 300000, 1000000)
set ytics nomirror
set y2tics nomirror
set key left top reverse Left samplen 3
set grid
set xrange [5500:1200000]
at(epsilon, n) = stringcolumn(1) eq "room" && column(2) == epsilon ? column(n) : NaN
plot 300*sqrt(x) with lines lt 0 lw 2 title "as the square root of k", \
     "docs/growth.csv" using 3:(at(1e-3, 5)) skip 1 \
         with linespoints pt 9 lw 2 lc "black" title "links, epsilon 1e-3", \
     "" using 3:(at(1e-4, 5)) skip 1 \
         with linespoints pt 8 lw 2 lc "gray40" title "links, epsilon 1e-4", \
     "" using 3:(at(1e-3, 12)) skip 1 axes x1y2 \
         with linespoints pt 7 lw 2 lc "black" dt 2 title "seconds, epsilon 1e-3", \
     "" using 3:(at(1e-4, 12)) skip 1 axes x1y2 \
         with linespoints pt 6 lw 2 lc "gray40" dt 2 title "seconds, epsilon 1e-4"
