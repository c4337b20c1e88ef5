# The lines of docs/scaling.csv for one scene, and on stderr the paper's Tables 1 and 2, from the --stats
# of runs on 1, 2, 4, ... ranks, in this order. -v name=SCENE -v replay=FILE
#
# Counts become seconds by what one of each took on one rank, as the replay (tests/bench/simulate.c) has
# told on stderr: in seconds of the processor, whatever else the machine does. A phase lasts as long as its slowest rank.

BEGIN {
    split("linking looks splitting transfer own patches", KINDS, " ")
    while ((getline line <replay) > 0)
        if (line ~ / ns each$/) {
            sub(/all patches/, "patches", line)
            split(line, word, /[ :]+/)
            sub(/ ns each$/, "", line)
            sub(/.*, /, "", line)
            worth[word[2]] = 1e-9 * line
        }
}

function finish_file(   k, kind, shared, parts, copies, messages, bytes, mega) {
    if (ranks == 1) {
        for (k = 1; k <= 6; k++) {
            once += worth[KINDS[k]] * all[KINDS[k]]
            prices = prices sprintf("%s %s %.3g ns", k > 1 ? "," : "", KINDS[k], 1e9 * worth[KINDS[k]])
        }
        first = seconds["total"]
    }
    for (k = 1; k <= 5; k++) {
        shared += worth[KINDS[k]] * slowest[KINDS[k]]
        parts += worth[KINDS[k]] * all[KINDS[k]] / ranks
    }
    copies = worth["patches"] * slowest["patches"] + 1.5e-9 * migrated / ranks # as in the replay: PACKING
    if (ranks > 1) {
        messages = passed
        bytes = sent["transfer"] + sent["splitting"] + (scattered + migrated) / ranks
    }
    talk = 2e-6 * messages + 1e-10 * bytes
    printf "%s,counted,%d,%.6g,%.2f,%.4f,%.2f,%.2f,%.4f,%.2f,%.3f\n", name, ranks, shared + copies + talk,
        ranks * parts / shared, 1 - parts / shared, once / (shared + copies), once / (shared + copies + talk),
        migrated / 1e6, once / (shared + copies + 1e-4 * messages + 8e-8 * bytes), seconds["total"]
    total = shared + copies + talk
    table1 = table1 sprintf("%5d %10.3f %8.2f %8.2f %8.2f %10.2f %8.2f\n", ranks, total,
        ranks * parts / shared, once / (shared + copies), once / total, seconds["total"], first / seconds["total"])
    table2 = table2 sprintf("%5d %8.1f %8.1f %8.1f %8.1f %8.1f %8.1f %8.1f %8.1f %10.2f\n", ranks,
        share("linking"), share("looks"), share("splitting"), share("transfer"), share("own"),
        100 * copies / total, 100 * (shared - parts) / total, 100 * talk / total, migrated / 1e6)
}
function share(kind) { return 100 * worth[kind] * all[kind] / ranks / total }

/"ranks":/ { ranks = $2 + 0 }
/"seconds":/ { section = "seconds"; next }
/"work":/ { section = "work"; next }
/^  }/ { section = "" }
/"messages":/ { passed = $2 + 0 }
section == "seconds" { gsub(/[",:{}]/, " "); seconds[$1] = $7 }
section == "work" { gsub(/[",:{}]/, " "); phases[$1] = $3; all[$1] = $5; slowest[$1] = $7; sent[$1] = $9 }
/"bytes": {"migration"/ { gsub(/[",:{}]/, " "); migrated = $3; scattered = $7 }
/"peak_rss_bytes"/ { finish_file() }

END {
    printf "%s: seconds for one of each kind:%s\n\n", name, prices >"/dev/stderr"
    printf "ranks  modelled  by work  +copies +messages  measured speed-up\n%s\n", table1 >"/dev/stderr"
    printf "%% of the modelled time\nranks  linking    looks splitting transfer    own   copies     idle messages migrated/MB\n%s\n",
        table2 >"/dev/stderr"
}
