# docs/growth.csv as docs/growth.svg: read without colour, by marks and labels.
set datafile separator ","
set terminal svg size 760,520 font "Helvetica,13" background "white" noenhanced
set output "docs/growth.svg"
set logscale xy
set xlabel "triangles k"
set ylabel "pairs, links"
set y2label "seconds on two cores"
set logscale y2
set format y "%.0e"
set xtics (1000, 2000, 4000, 8000, 16000, 32000)
set ytics nomirror
set y2tics nomirror
set key left top reverse Left samplen 3
set grid
set xrange [900:36000]
plot x*x/2 with lines lt 0 lw 2 title "all pairs", \
     x*x/6 with lines lt 0 lw 1 title "a third of them", \
     "docs/growth.csv" using 1:3 skip 1 with linespoints pt 9 lw 2 lc "gray40" title "links in the end", \
     "" using 1:5 skip 1 axes x1y2 with linespoints pt 6 lw 2 lc "black" dt 2 title "seconds, reading to picture"
