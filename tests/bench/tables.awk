# Runs on one rank, each behind a line with its processor seconds, and runs on several,
# balance by balance: phr's Tables 1 and 2 for one network, and to the file `figure` lines
# "series ranks speed-up"; see tables.sh.

function value(key,    text) { # the number behind "key":
    text = $0
    sub(".*\"" key "\": *", "", text)
    return text + 0
}

BEGIN {
    BYTES_PER_LINK = 32
    kinds = split("greedy none default", balance)
}
FNR == 1 {
    n = split(FILENAME, part, ".")
    run = part[n - 1] == "one" ? "one" : part[n - 1] " " part[n]
    turn += run == "one"
    if (run != "one" && part[n - 1] == "greedy") ranks[++rows] = part[n]
}
run == "one" && /^processor/ { processor = $2 }
run == "one" && /"min".*"mean".*"max"/ && !/closure/ {
    split($0, part, "\"")
    now = value("max")
    if (part[2] == "total") share = processor / now # the first phase
    now *= share
    if (turn == 1 || now < seconds[part[2]]) seconds[part[2]] = now
}
/"phases"/ {
    split($0, part, "\"")
    all[run, part[2]] = value("all")
    slowest[run, part[2]] = value("slowest")
    sent[run, part[2]] = value("bytes")
}
/"messages_with"/ {
    with_flux[run] = value("gather")
    with_light[run] = value("scatter")
}
/"(triangles|links|messages)": [0-9]*,$/ {
    split($0, part, "\"")
    count[run, part[2]] = value(part[2])
}
/"bytes": {"migration"/ { moved[run] = value("migration") }

# Fills the columns of a run on P ranks.
function fill(run, p,    k, gather, scatter) {
    gather = with_flux[run] * message
    scatter = with_light[run] * message
    column["refinement"] = (all[run, "splitting"] * test + all[run, "looks"] * look) / p
    column["idle"] = slowest[run, "splitting"] * test + slowest[run, "looks"] * look - \
                     column["refinement"]
    column["migration"] = count[run, "messages"] * message - gather - scatter + \
                          sent[run, "splitting"] / bandwidth
    column["gather"] = gather + sent[run, "transfer"] / bandwidth
    column["push-pull"] = slowest[run, "own"] * own
    column["scatter"] = scatter + sent[run, "own"] / bandwidth
    column["light"] = slowest[run, "transfer"] * transfer
    column["alike"] = alike
    total = 0
    for (k = 1; k <= columns; k++) total += column[name[k]]
    linking = slowest[run, "linking"] * link_test + \
              (moved[run] - BYTES_PER_LINK * links_sent[run]) / p / bandwidth
    splitting = slowest[run, "splitting"] * test
}

# Links that moved before levels: the lists "sent" of "balance".
/"sent": \[/ {
    text = $0
    sub(/.*"sent": \[/, "", text)
    sub(/\].*/, "", text)
    k = split(text, part, ", ")
    for (i = 1; i <= k; i++) links_sent[run] += part[i]
}

END {
    columns = split("refinement idle migration gather push-pull scatter light alike",
                    name)
    test = (seconds["refinement"] - seconds["looks"] - seconds["prepare"]) / \
           all["one", "splitting"]
    look = seconds["looks"] / all["one", "looks"]
    transfer = seconds["solve"] / all["one", "transfer"]
    own = seconds["push_pull"] / all["one", "own"]
    link_test = seconds["linking"] / all["one", "linking"]
    alike = seconds["prepare"] + seconds["routes"] + seconds["sums"] + \
            seconds["gather"] + seconds["scatter"]
    printf "\n## %d triangles, %d links, epsilon %s; network: %s\n\n", \
           count["one", "triangles"], count["one", "links"], epsilon, network
    printf "`build/room %d 1 >room.obj`, `mpiexec -n P ./phr room.obj --paper ", size
    printf "--epsilon %s --balance BALANCE --stats FILE`.\n\n", epsilon
    printf "A test takes %.1f ns, a look %.1f, light over a link %.1f; ", 1e9 * test, \
           1e9 * look, 1e9 * transfer
    printf "a message %g s, a byte %g ns.\n\n", message, 1e9 / bandwidth
    print "Table 1: processor seconds of the slowest rank and the network, and speed-up."
    printf "\n| ranks |"
    head[1] = "splitting"; head[2] = "without linking"; head[3] = "with linking"
    for (h = 1; h <= 3; h++)
        for (b = 1; b <= kinds; b++) printf " %s, %s | |", head[h], balance[b]
    printf "\n|---|"
    for (i = 1; i <= 6 * kinds; i++) printf "---|"
    printf "\n"
    for (i = 1; i <= rows; i++) {
        printf "| %d |", ranks[i]
        for (h = 1; h <= 3; h++)
            for (b = 1; b <= kinds; b++) {
                fill(balance[b] " " ranks[i], ranks[i])
                now = h == 1 ? splitting : h == 2 ? total : total + linking
                if (i == 1) alone[h, b] = now
                printf " %.4f | %.1f |", now, alone[h, b] / now
                if (h == 2 && b == 1)
                    print "phr,_" count["one", "triangles"], ranks[i], \
                          alone[h, b] / now >figure
            }
        printf "\n"
    }
    printf "\nTable 2: seconds.\n\n| ranks |"
    for (k = 1; k <= columns; k++) printf " %s |", name[k]
    printf " linking | idle, none |\n|---|"
    for (k = 1; k <= columns + 2; k++) printf "---|"
    printf "\n"
    for (i = 1; i <= rows; i++) {
        fill("none " ranks[i], ranks[i])
        idle = column["idle"]
        fill("greedy " ranks[i], ranks[i])
        printf "| %d |", ranks[i]
        for (k = 1; k <= columns; k++) printf " %.4f |", column[name[k]]
        printf " %.4f | %.4f |\n", linking, idle
    }
}
