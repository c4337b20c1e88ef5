# Values of the statistics of phr by their keys, on one line: those of the top level, and
# "work.KIND" for the work of all ranks and that of the slowest.
#
#     awk -v keys="links rays work.splitting" -f docs/course/stats.awk STATS.json
#
# Lists ("proxies") come with spaces instead of commas.

{
    key = $1
    gsub(/[":]/, "", key)
    indent = match($0, /[^ ]/) - 1
    if (indent == 2 && $2 != "{" && $2 != "[")
        value[key] = substr($0, index($0, ":") + 2)
    if (indent == 4 && /"slowest"/)
        value["work." key] = substr($0, index($0, ":") + 2)
}
END {
    count = split(keys, wanted, " ")
    for (i = 1; i <= count; i++) {
        text = value[wanted[i]]
        if (wanted[i] ~ /^work\./)
            gsub(/[^0-9 ]|"[a-z]*":/, "", text)
        gsub(/[][",]+/, " ", text)
        gsub(/ +/, " ", text)
        sub(/^ /, "", text)
        sub(/ $/, "", text)
        line = line (i > 1 ? " " : "") text
    }
    print line
}
