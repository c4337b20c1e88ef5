# A table of instructions of phr's own functions, of the runs of repeated.sh, which sets
# `runs` to its RUNS and `work` to the folder of its files. Functions that wait for
# messages are left out.

# Reads the callgrind file of a run: all[run, who], each[run, who, function].
function read_counts(run, who,    line, own, name, file, counts, part) {
    file = work "/" run "." who
    while ((getline line <file) > 0) {
        if (line ~ /^ob=/)
            own = line ~ /\/phr$/
        else if (line ~ /^fn=/) {
            name = substr(line, 4)
            sub(/['.].*/, "", name) # of a recursion, or a part made by the compiler
            counts = own && name !~ /^(wait_for|leave_processor|comm_wait)/
        } else if (line ~ /^calls=/) # the next line has what the called function took
            getline line <file
        else if (counts && line ~ /^[0-9]/) {
            split(line, part, " ")
            all[run, who] += part[2]
            each[run, who, name] += part[2]
            functions[name]
        }
    }
    close(file)
}

# The part of the counted tests that the busiest rank has.
function read_report(run,    line, part, most, sum, name) {
    while ((getline line <(work "/" run ".report")) > 0) {
        if (line ~ /"triangles": [0-9]*,$/) {
            split(line, part, /[:,]/)
            triangles[run] = part[2] + 0
        }
        if (line ~ /"(linking|splitting|final_gather)": \{"phases"/) {
            split(line, part, /[:,]/)
            sum += part[5]
            most += part[7]
        }
    }
    return most / sum
}

# The functions with most of `part`, in per cent of one rank alone.
function print_most(run, part, words,    k, name, best, text, told) {
    for (k = 0; k < 6; k++) {
        best = ""
        for (name in functions)
            if (!(name in told) && (best == "" || part[run, name] > part[run, best]))
                best = name
        told[best]
        text = text sprintf("%s`%s` %.2g", k ? ", " : "", best,
                            100 * part[run, best] / all[run, "alone"])
    }
    printf "%s: %s.\n", words, text
}

function row(words, format, value,    r) {
    printf "| %s |", words
    for (r = 1; r <= count; r++) printf " " format " |", value[r]
    printf "\n"
}

BEGIN {
    count = split(runs, entry, " ")
    for (r = 1; r <= count; r++) {
        split(entry[r], part, ":")
        run = name_of[r] = part[1]
        p = ranks[r] = part[3]
        options[r] = part[4]
        gsub(",", " ", options[r])
        read_counts(run, "alone")
        read_counts(run, "first")
        read_counts(run, "middle")
        tests[r] = 1 / read_report(run)
        alone[r] = all[run, "alone"] / 1e6
        first[r] = all[run, "first"] / 1e6
        middle[r] = all[run, "middle"] / 1e6
        together[r] = (first[r] + (p - 1) * middle[r]) / alone[r]
        serial[r] = (first[r] - middle[r]) / alone[r]
        alike[r] = (together[r] - 1) / (p - 1)
        most[r] = 1 / (serial[r] + alike[r])
        first_part[r] = alone[r] / first[r]
        middle_part[r] = alone[r] / middle[r]
        alike[r] *= 100
        serial[r] *= 100
        for (name in functions) {
            a = each[run, "alone", name]
            f = each[run, "first", name]
            m = each[run, "middle", name]
            only[run, name] = f - m
            again[run, name] = (f + (p - 1) * m - a) / (p - 1)
        }
    }
    printf "| |"
    for (r = 1; r <= count; r++)
        printf " %d triangles, `%s` |", triangles[name_of[r]], options[r]
    printf "\n|---|"
    for (r = 1; r <= count; r++) printf "---|"
    printf "\n"
    row("ranks", "%d", ranks)
    row("one rank alone, millions of instructions", "%.0f", alone)
    row("rank 0, of one alone", "1/%.3g", first_part)
    row("a rank in the middle", "1/%.3g", middle_part)
    row("for comparison, the busiest rank by counted tests", "1/%.3g", tests)
    row("all ranks, if the others are like that in the middle", "%.3g", together)
    row("by rank 0 alone, % of one alone", "%.2g", serial)
    row("again by each rank, or only where there are ranks, %", "%.2g", alike)
    row("ceiling: the most speed-up on any number of ranks", "%.2g", most)
    for (r = 1; r <= count; r++) {
        print ""
        print_most(name_of[r], again, "Most of what each rank does again, %, " \
                   triangles[name_of[r]] " triangles")
        print_most(name_of[r], only, "Most of what rank 0 does alone")
    }
}
