# Runs on one rank, one on many, and the replay, as a table of seconds: see scaling.sh.

function value(key,    text) { # the number behind "key":
    text = $0
    sub(".*\"" key "\": *", "", text)
    return text + 0
}

BEGIN { # phases that are parts of others
    split("octree spaces tree prepare looks rows products shading viewpoint", names, " ")
    for (i in names) is_part[names[i]] = 1
}
FNR == 1 { # a run on one rank, the run on many, the replay
    what = FILENAME ~ /\.replay$/ ? "replay" : FILENAME ~ /\.many$/ ? "many" : "one"
    turn += what == "one"
}
what == "one" && /^processor/ { processor = $2 }
what == "one" && /"min".*"mean".*"max"/ && !/closure/ {
    split($0, part, "\"")
    now = value("max")
    if (part[2] == "total") share = processor / now # the first phase
    now *= share
    if (turn == 1 || now < seconds[part[2]]) seconds[part[2]] = now
    if (part[2] == "total") rest[turn] = now
    else if (!(part[2] in is_part)) rest[turn] -= now
}
what == "one" && /"passes": [0-9]*,$/ { passes = value("passes") }
what == "one" && /"(triangles|links)": [0-9]*,$/ {
    split($0, part, "\"")
    count[part[2]] = value(part[2])
}
/"phases"/ {
    split($0, part, "\"")
    all[what, part[2]] = value("all")
    slowest[what, part[2]] = value("slowest")
    sent[part[2]] = value("bytes") # in the end of the run on many
}
what == "many" && /"messages_with"/ { gather_messages = value("gather") }
what == "many" && /"exchanges"/ { exchanges = value("exchanges") }
what == "many" && /"messages"/ { messages = value("messages") }
what == "many" && /"broadcast"/ {
    broadcast = value("broadcast")
    whole = value("whole") / ranks
}
what == "replay" {
    dealt[$1] = $2
    most[$1] = $3
    moved[$1] = $4
}

function line(name, how, one, many, most_ranks, kind) {
    printf "| %s | %s | %.4f | %.4f | %.4f |\n", name, how, one, many, most_ranks
    total[1] += one; total[2] += many; total[3] += most_ranks
    if (kind != "serial" && kind != "repeated") return
    undivided += many
    if (many > largest) {
        largest = many
        which = name
    }
}
function same(name, how, key) {
    line(name, how, seconds[key], seconds[key], seconds[key], how)
}
function divided(name, key, kind,    share) {
    share = slowest["many", kind] / all["one", kind]
    uneven[kind] = share * ranks
    line(name, "divided", seconds[key], seconds[key] * share,
         seconds[key] * share * ranks / 1024)
}
function even(name, s) { line(name, "even", s, s / ranks, s / 1024) }
# The slowest of P ranks passes on `n` messages for the bytes.
function sending(name, bytes, n, n_1024, bytes_1024) {
    line(name, "messages", 0, n * message + bytes / bandwidth,
         n_1024 * message + bytes_1024 / bandwidth)
}

END {
    log_ranks = log(ranks) / log(2)
    tree = seconds["tree"] > 0
    printf "\n## %s\n\n", title
    printf "%d triangles, %d links. A message takes %g s, a byte %g ns, ", \
           count["triangles"], count["links"], message, 1e9 / bandwidth
    printf "a record copied %g ns.\n\n", 1e9 * copy
    printf "| seconds | how | 1 rank, run | %d ranks, counts of a run |", ranks
    print " 1,024 ranks |"
    print "|---|---|---|---|---|"
    read = seconds["read"] - seconds["octree"] - seconds["spaces"] - seconds["tree"]
    line("reading", "serial", read, read, read, "serial")
    same("octree", "serial", "octree")
    if (tree) even("rays that tell spaces apart", seconds["spaces"])
    if (tree) same("tree above the roots", "serial", "tree")
    out = 2 * broadcast + (tree ? 16 * count["triangles"] : 0) # and where four rays ended
    sending("broadcast of scene, octree, tree", out, log_ranks, 10, out)
    if (tree) same("homes of roots", "repeated", "linking")
    else divided("linking of all pairs", "linking", "linking")
    # before the first pass all ranks have all light, and later each its own
    first = seconds["prepare"] / passes
    line("bounds before the first pass", "repeated", first, first, first, "repeated")
    even("bounds before the others", seconds["prepare"] - first)
    divided("looks: what is to be split?", "looks", "looks")
    splitting = seconds["refinement"] - seconds["looks"] - seconds["prepare"]
    price = splitting / all["one", "splitting"]
    line("splitting", "replayed", price * all["one", "splitting"],
         price * slowest["many", "splitting"], price * most[1024])
    divided("transfer of light", "solve", "transfer")
    divided("sums through clusters", "sums", "own")
    copies = copy * slowest["many", "patches"]
    line("copies of flux and radiosity", "counted", 0, copies, copies)
    divided("push-pull at home", "push_pull", "own")
    if (tree) divided("rows of the final gather", "rows", "final_gather")
    if (tree) divided("rows times light", "products", "final_gather")
    solved = seconds["final_gather"] - seconds["rows"] - seconds["products"]
    if (tree) even("light solved for by rows", solved)
    same("row sums for the report", "repeated", "row_sums")
    same("blend of leaves for the picture", "repeated", "shading")
    if (seconds["viewpoint"] > 0) same("viewpoint", "repeated", "viewpoint")
    even("rays of the picture",
         seconds["render"] - seconds["shading"] - seconds["viewpoint"])
    same("writing", "serial", "write")
    least = rest[1]
    for (i in rest) least = rest[i] < least ? rest[i] : least
    line("the rest", "repeated", least, least, least, "repeated")
    partners = messages - exchanges * log_ranks
    sending("links that move", sent["splitting"], 0, 0, moved[1024])
    homes = gather_messages * (1023 / (ranks - 1) - 1) # beside those of `ranks` homes
    sending("gather", sent["transfer"], 0, homes, sent["transfer"])
    sending("scatter", sent["own"], 0, 0, sent["own"])
    sending("all leaves to all, once", whole, log_ranks, 10, whole)
    if (tree) sending("vectors of the final gather", sent["final_gather"], 0, 0,
                      sent["final_gather"])
    sending("picture to rank 0", picture, log_ranks, 10, picture)
    sending("messages of all exchanges", 0, messages, exchanges * 10 + partners, 0)
    printf "| all | | %.3f | %.3f | %.3f |\n\n", total[1], total[2], total[3]
    printf "Speed-up: %.1f on %d ranks, %.1f on 1,024. ", total[1] / total[2], ranks,
           total[1] / total[3]
    printf "The largest serial or repeated part: %s, %.3f s.\n", which, largest
    printf "Of serial and repeated ones there are %.3f s: ", undivided
    printf "at most %.0f on any number of ranks.\n", total[1] / undivided
    mean = all["many", "splitting"] / ranks
    printf "A test takes %.1f ns. The slowest of %d ranks splits %.3f times the mean, ", \
           1e9 * price, ranks, slowest["many", "splitting"] / mean
    printf "level by level; the replay says %.3f, and of 1,024 %.1f. ", \
           most[ranks] / (dealt[ranks] / ranks), most[1024] / (dealt[1024] / 1024)
    printf "Of %d: looks %.2f, transfer %.2f, push-pull %.2f", ranks, uneven["looks"], \
           uneven["transfer"], uneven["own"]
    if (tree) printf ", rows of the final gather %.3f", uneven["final_gather"]
    printf ".\n"
}
