# Runs of some rooms, by their reports: SIZE.one.TURN on one rank and SIZE.two.TURN on
# two, each behind a line with its processor seconds; SIZE.one.linking, that made the
# links; SIZE.most.linking, that made them on many ranks, of the first room alone;
# SIZE.loading.RANKS, that loads them and ends; SIZE.BALANCE.RANKS. Prints phr's Tables 1
# and 2, and writes to the file `figure` lines "series ranks speed-up"; see tables.sh.
# Variables are lists of words: rooms SIZE:EPSILON, turns, and `on`, numbers of ranks.

function value(key,    text) { # the number behind "key":
    text = $0
    sub(".*\"" key "\": *", "", text)
    return text + 0
}

# Two digits, and no 0 before the point.
function two(x,    places, text) {
    if (x == 0)
        return "0"
    text = sprintf("%.1e", x)
    places = 1 - substr(text, index(text, "e") + 1)
    if (places < 0)
        return sprintf("%.0f", int(x * 10 ^ places + 0.5) / 10 ^ places)
    text = sprintf("%." places "f", x)
    sub(/^0\./, ".", text)
    return text
}

# 6348 as 6,348.
function grouped(n,    text) {
    text = sprintf("%d", n)
    while (match(text, /[0-9][0-9][0-9][0-9]($|,)/))
        text = substr(text, 1, RSTART) "," substr(text, RSTART + 1)
    return text
}

BEGIN {
    BYTES_PER_LINK = 32
    COPY = 2e-8 # s a link or a patch is packed or unpacked
    TODAY = 2e-6; TODAY_BYTES = 1e10 # s a message, bytes a second
    ETHERNET = 1e-4; ETHERNET_BYTES = 1e7
    KINDS = split("test look light patch route", KIND)
    COLUMNS = split("refinement idle migration gather push-pull scatter", COLUMN)
    room_count = split(rooms, room)
    turn_count = split(turns, turn)
    rows = split(on, ranks)
}

FNR == 1 { # room and run: "SIZE one", "SIZE greedy 8"
    n = split(FILENAME, part, /[\/.]/)
    run = part[n - 2] " " part[n - 1]
    timed = run " " part[n]
    if (part[n - 1] !~ /^(one|two)$/ || part[n] == "linking") run = timed
}
/^processor/ { processor = $2 }
/"min".*"mean".*"max"/ && !/closure/ {
    split($0, part, "\"")
    if (part[2] == "total") share = processor / value("max") # the first phase
    if (run ~ /two$/) share = 1
    seconds[timed, part[2]] = share * value("max")
}
/"phases"/ {
    split($0, part, "\"")
    all[run, part[2]] = value("all")
    slowest[run, part[2]] = value("slowest")
    sent[run, part[2]] = value("bytes")
}
/"messages_with"/ {
    messages[run, "gather"] = value("gather")
    messages[run, "scatter"] = value("scatter") + value("whole")
}
/"bytes": {"migration"/ { moved[run] = value("migration") }
/"(triangles|links|exchanges|messages)": [0-9]*,$/ {
    split($0, part, "\"")
    count[run, part[2]] = value(part[2])
}

# The price of a kind of work in a turn, s.
function price_of(size, kind, t,    one) {
    one = size " one"
    if (kind == "look") return seconds[one " " t, "looks"] / all[one, "looks"]
    if (kind == "light") return seconds[one " " t, "solve"] / all[one, "transfer"]
    if (kind == "patch") return seconds[one " " t, "push_pull"] / all[one, "own"]
    if (kind == "route")
        return seconds[size " two " t, "routes"] / slowest[size " two", "looks"]
    return (seconds[one " " t, "refinement"] - seconds[one " " t, "looks"] - \
            seconds[one " " t, "prepare"]) / all[one, "splitting"]
}

# The median of x[1], ..., x[n], which are sorted; `least` and `most` are the ends.
function median_of(x, n,    i, k, now) {
    for (i = 2; i <= n; i++) {
        now = x[i]
        for (k = i - 1; k >= 1 && x[k] > now; k--) x[k + 1] = x[k]
        x[k + 1] = now
    }
    least = x[1]
    most = x[n]
    return (x[int((n + 1) / 2)] + x[int(n / 2) + 1]) / 2
}

# The seconds of work of Algorithm 1 and light, by the prices of a turn.
function work(run, size, t, of,    s) {
    s = of[run, "splitting"] * price[size, "test", t]
    s += of[run, "looks"] * price[size, "look", t]
    return s + of[run, "transfer"] * price[size, "light", t]
}

# Messages but those of steps 5 and 7.
function other_messages(run) {
    return count[run, "messages"] - messages[run, "gather"] - messages[run, "scatter"]
}

# Fills `column` and `linking` with the seconds of a run on P ranks, by the prices of a
# turn and of a network. Returns the sum of the columns.
function fill(size, balance, p, t, message, bandwidth,
              run, loaded, one, links, copies, k, sum) {
    run = size " " (p == 1 ? "one" : balance " " p)
    loaded = size " loading " p
    one = size " one linking"
    copies = COPY * slowest[run, "patches"] / 2
    column["refinement"] = work(run, size, t, all) / p
    column["idle"] = work(run, size, t, slowest) - column["refinement"]
    links = (moved[run] - moved[loaded]) / BYTES_PER_LINK / p
    column["migration"] = p == 1 ? 0 : links * (2 * COPY + BYTES_PER_LINK / bandwidth) + \
        (other_messages(run) - other_messages(loaded)) * message
    column["gather"] = copies + seconds[size " one " t, "gather"] + \
        messages[run, "gather"] * message + sent[run, "transfer"] / bandwidth
    column["push-pull"] = slowest[run, "own"] * price[size, "patch", t]
    column["scatter"] = copies + seconds[size " one " t, "scatter"] + \
        (p > 1) * slowest[run, "looks"] * price[size, "route", t] + \
        messages[run, "scatter"] * message + sent[run, "own"] / bandwidth
    linking = seconds[one, "linking"] / p
    if (p > 1) {
        links = moved[loaded] / BYTES_PER_LINK / p
        linking = linking * uneven + links * (2 * COPY + BYTES_PER_LINK / bandwidth) + \
            count[one, "exchanges"] * log(p) / log(2) * message
    }
    for (k = 1; k <= COLUMNS; k++) sum += column[COLUMN[k]]
    return sum
}

function today(size, balance, p, t) {
    return fill(size, balance, p, t, TODAY, TODAY_BYTES)
}

# The speed-up on P ranks.
function gain(size, p, t, with_linking,    one) {
    one = today(size, "greedy", 1, t) + with_linking * linking
    return one / (today(size, "greedy", p, t) + with_linking * linking)
}

# "LEAST to MOST" of the speed-ups by the prices of single turns.
function range(size, p, with_linking,    t, x) {
    for (t = 1; t <= turn_count; t++) x[t] = gain(size, p, turn[t], with_linking)
    median_of(x, turn_count)
    return two(least) " to " two(most)
}

# The prices, and in turn "median" their medians.
function print_prices(    i, k, t, x, text) {
    printf "| room | epsilon | links at first | in the end |"
    printf " a test, ns | a look | light over a link | a patch | a route |"
    print " linking, once |\n|---|---|---|---|---|---|---|---|---|---|"
    for (i = 1; i <= room_count; i++) {
        text = ""
        for (k = 1; k <= KINDS; k++) {
            for (t = 1; t <= turn_count; t++)
                x[t] = price[size[i], KIND[k], turn[t]] = \
                    price_of(size[i], KIND[k], turn[t])
            price[size[i], KIND[k], "median"] = median_of(x, turn_count)
            text = text sprintf(" %s (%s to %s) |", two(1e9 * median_of(x, turn_count)),
                                two(1e9 * least), two(1e9 * most))
        }
        printf "| %s | %s | %s M | %s M |%s %s s |\n", grouped(triangles[i]), epsilon[i],
               two(count[size[i] " one linking", "links"] / 1e6),
               two(count[size[i] " one", "links"] / 1e6), text,
               two(seconds[size[i] " one linking", "linking"])
    }
}

# The medians of what has no price: steps 5 and 7 of one rank.
function find_medians(    i, k, t, x, step) {
    split("gather scatter", step)
    for (i = 1; i <= room_count; i++)
        for (k = 1; k <= 2; k++) {
            for (t = 1; t <= turn_count; t++)
                x[t] = seconds[size[i] " one " turn[t], step[k]]
            seconds[size[i] " one median", step[k]] = median_of(x, turn_count)
        }
}

function print_table_1(    i, r, p, now) {
    printf "| ranks |"
    for (i = 1; i <= room_count; i++)
        printf " %s | | with linking |", grouped(triangles[i])
    printf "\n|---|"
    for (i = 1; i <= 3 * room_count; i++) printf "---|"
    for (r = 1; r <= rows; r++) {
        p = ranks[r]
        printf "\n| %d |", p
        for (i = 1; i <= room_count; i++) {
            now = gain(size[i], p, "median", 0)
            printf " %s | %s |", two(today(size[i], "greedy", p, "median")), two(now)
            printf " %s |", two(gain(size[i], p, "median", 1))
            print "phr,_" grouped(triangles[i]), p, now >figure
        }
    }
    printf "\n| %d, by turn |", p
    for (i = 1; i <= room_count; i++)
        printf " | %s | %s |", range(size[i], p, 0), range(size[i], p, 1)
    printf "\n| %d, Ethernet |", p
    for (i = 1; i <= room_count; i++) {
        now = fill(size[i], "greedy", p, "median", ETHERNET, ETHERNET_BYTES)
        printf " %s |", two(now)
        printf " %s | |", two(today(size[i], "greedy", 1, "median") / now)
    }
    printf "\n"
}

function print_table_2(    i, k, r, idle) {
    printf "| room | ranks |"
    for (k = 1; k <= COLUMNS; k++) printf " %s |", COLUMN[k]
    print " idle, none |\n|---|---|---|---|---|---|---|---|---|"
    for (i = 1; i <= room_count; i++)
        for (r = 1; r <= rows; r++) {
            today(size[i], "none", ranks[r], "median")
            idle = column["idle"]
            today(size[i], "greedy", ranks[r], "median")
            printf "| %s | %d |", r == 1 ? grouped(triangles[i]) : "", ranks[r]
            for (k = 1; k <= COLUMNS; k++) printf " %s |", two(column[COLUMN[k]])
            printf " %s |\n", two(idle)
        }
}

END {
    for (i = 1; i <= room_count; i++) {
        split(room[i], part, ":")
        size[i] = part[1]
        epsilon[i] = part[2]
        triangles[i] = count[part[1] " one", "triangles"]
    }
    run = size[1] " most linking"
    uneven = ranks[rows] * slowest[run, "linking"] / all[run, "linking"]
    print "\nPrices: the median of runs, the lowest and the highest.\n"
    print_prices()
    find_medians()
    printf "\nLinking of the first room on %d ranks takes the slowest %.3f times the",
           ranks[rows], uneven
    print " mean; others are taken to be alike."
    print "\nTable 1: seconds and speed-up without linking; speed-up with it. By turn:"
    print "the least and the most, by the prices of each turn.\n"
    print_table_1()
    print "\nTable 2, seconds:\n"
    print_table_2()
}
