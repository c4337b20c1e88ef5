# Runs of phr that are sent signals: `. tests/faults.sh` behind tests/tap.sh. Ranks write
# down their process numbers, and only those are sent signals.

patience=60 # seconds that nothing here may take

# start RANKS ARGUMENTS...: runs phr behind the script; $launched is the launcher.
start() {
    on=$1
    shift
    rm -f "$work/ranks" "$work/out" "$work/launcher"
    : >"$work/err"
    $MPIEXEC -n "$on" \
        sh -c 'echo $$ >>"$0/ranks"; exec 2>>"$0/err" >>"$0/out"; exec "$@"' "$work" \
        "$PHR" "$@" >"$work/launcher" 2>&1 </dev/null &
    launched=$!
}

# wait_for N TEXT: until so many lines of stderr of the ranks have it.
wait_for() {
    ticks=$((patience * 20))
    until [ "$(grep -c "$2" "$work/err")" -ge "$1" ]; do
        ticks=$((ticks - 1))
        [ $ticks -gt 0 ] && kill -0 "$launched" 2>/dev/null || return 1
        sleep 0.05
    done
}

# finish: waits for the end; $status is the exit status, or "hang".
finish() {
    ticks=$((patience * 20))
    while kill -0 "$launched" 2>/dev/null; do
        ticks=$((ticks - 1))
        if [ $ticks -le 0 ]; then
            kill -9 "$launched" $(cat "$work/ranks") 2>/dev/null
            wait "$launched" 2>/dev/null
            status=hang
            return
        fi
        sleep 0.05
    done
    wait "$launched" 2>/dev/null
    status=$?
}

ranks_are_gone() {
    for pid in $(cat "$work/ranks"); do
        kill -0 "$pid" 2>/dev/null && return 1
    done
    return 0
}
