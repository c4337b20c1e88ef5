# The errors of means of objects of doorway.obj: RMS of the relative ones, all but the
# lamp, and that of the far floor.
#
#     ... | awk -v run="NAME EPSILON LINKS" -f docs/course/errors.awk scenes/answers.csv -

NR == FNR {
    split($0, field, ",")
    if (field[1] == "doorway")
        answer[field[2]] = field[3]
    next
}
$1 != "lamp" {
    error = $2 / answer[$1] - 1
    squares += error * error
    objects++
    if ($1 == "floor-far")
        far = error
}
END {
    split(run, part, " ")
    printf "%-8s %6s %7d %5.1f %% %+5.1f %%\n", part[1], part[2], part[3],
        100 * sqrt(squares / objects), 100 * far
}
