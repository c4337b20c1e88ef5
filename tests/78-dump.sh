# --dump: patches and links as text, and the program that takes IDs apart.
. tests/tap.sh

# dump RANKS WHAT OPTIONS...: $work/RANKS.WHAT
dump() {
    ranks=$1 what=$2
    shift 2
    $MPIEXEC -n "$ranks" "$PHR" scenes/cornell.obj --quiet --epsilon 1e-3 "$@" \
        --dump "$what" >"$work/$ranks.$what"
}

# same WHAT: but for the owners, on 1 and 4 ranks; these are all there.
same() {
    for ranks in 1 4; do
        sed 's/ [0-9]*$//' "$work/$ranks.$1" >"$work/$ranks.$1.unowned"
    done
    cmp "$work/1.$1.unowned" "$work/4.$1.unowned" &&
        [ "$(grep -v '^#' "$work/4.$1" | sed 's/.* //' | sort -u | tr '\n' ' ')" \
            = "0 1 2 3 " ]
}

for options in "" --paper; do
    for what in patches links; do
        dump 1 $what $options --stats "$work/stats"
        dump 4 $what $options --stats "$work/4.stats"
        check "$what ${options:-by default}: the same on 4 ranks, but for owners" \
            same $what
        check "as many as --stats counts" \
            [ "$(grep -vc '^#' "$work/1.$what")" = "$(stat_of "$work/stats" $what)" ]
    done
    # Areas of children add up to their parent's, and so does their power.
    check "children add up to their parents" awk '
        /^#/ { next }
        { area[$1] = $4; power[$1] = $4 * $5; above[$1] = $3 }
        END {
            for (p in area) { sum[above[p]] += area[p]; light[above[p]] += power[p] }
            for (p in area) if (p in sum) {
                pairs++
                if ((sum[p] / area[p] - 1)^2 > 1e-14) exit 1
                if ((light[p] - power[p])^2 > 1e-12 * power[p]^2) exit 1
            }
            exit pairs < 100
        }' "$work/1.patches"
    check "links lead to patches, exchange no more than they have, and see 0 to 1" awk '
        /^#/ { next }
        NR == FNR { area[$1] = $4; next }
        { links++ }
        $1 !~ /^top/ && !($1 in area) || $2 !~ /^top/ && !($2 in area) { wrong++ }
        $1 in area && $3 > area[$1] || $2 in area && $3 > area[$2] { wrong++ }
        $4 < 0 || $4 > 1 { wrong++ }
        END { exit wrong || links < 100 }' "$work/1.patches" "$work/1.links"
done

# Of --paper, which is the last above: a proxy that links lead to has 32 bytes in step 5,
# and no other patch travels.
check "proxies that links lead to go home, and no others" holds "$(awk '
    /"proxies"/ { gsub(/[^0-9 ]/, ""); for (i = 1; i <= NF; i++) proxies += $i }
    /"iterations"/ { iterations = $2 + 0 }
    /"bytes": {"migration"/ { sub(/.*"gather": /, ""); bytes = $0 + 0 }
    END { most = 32 * iterations * proxies
          print bytes " > .5 * " most " && " bytes " <= " most }' "$work/4.stats")"

# Steps end with 41 patches below 0, within the tolerance.
for ranks in 1 4; do
    dump $ranks patches --epsilon 1e-4 --final-gather 0 --form-factor disk \
        --tolerance 0.1
    check "no radiosity is below 0, on $ranks" awk '
        /^#/ { next }
        { count++; wrong += $5 < 0 || $6 < 0 || $7 < 0 }
        END { exit wrong || count < 100 }' "$work/$ranks.patches"
done

build/id 0x1B >"$work/id"
check "0x1B is child 3 of child 2 of root 0" \
    grep -qx 'bits  *0\{27\} \[1\] 10 11' "$work/id"
check "and named so" grep -qx 'patch  *0/23' "$work/id"
check "a name is an ID, too" \
    [ "$(build/id 5/023 | sed -n 's/^number *//p')" = 0x000000050000004B ]
check "and back" [ "$(build/id 0x000000050000004B | sed -n 's/^patch *//p')" = 5/023 ]
for wrong in 0 2 9 x 5/4 -1/ 5/a "" 5/0123012301230123 0x100000000; do
    build/id "$wrong" >/dev/null 2>"$work/err"
    check "'$wrong' is no ID" [ $? -eq 2 ]
done
tap_done
