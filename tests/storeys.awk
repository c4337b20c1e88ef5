# Reads C files and prints figures of them: "what" per 1,000 words of comments, structs
# with more than 16 fields, structs whose name is defined twice, circles of includes in
# a folder.
#
#   awk -f tests/storeys.awk FILE.[ch]...

# Counts the words of a comment's line.
function read_words(text, count, i, words)
{
    gsub(/[^A-Za-z'_]+/, " ", text)
    count = split(text, words, " ")
    for (i = 1; i <= count; i++) {
        all_words++
        whats += tolower(words[i]) == "what"
    }
}

# Takes the comments out of a line; returns the code.
function without_comments(line, code, at)
{
    code = ""
    for (;;) {
        if (inside) {
            at = index(line, "*/")
            read_words(at ? substr(line, 1, at - 1) : line)
            if (!at)
                return code
            inside = 0
        } else {
            at = index(line, "/*")
            if (!at)
                return code line
            code = code substr(line, 1, at - 1)
            inside = 1
        }
        line = substr(line, at + 2)
    }
}

# The fields that a line of a struct declares.
function fields_of(code)
{
    if (code !~ /;/)
        return 0
    while (sub(/[([{][^][(){}]*[])}]/, "", code))
        ;
    return gsub(/,/, ",", code) + 1
}

function folder_of(path)
{
    return match(path, /.*\//) ? substr(path, 1, RLENGTH) : ""
}

function module_of(path)
{
    sub(/\.[ch]$/, "", path)
    return path
}

FNR == 1 { inside = 0; struct = "" }

{ code = without_comments($0) }

code ~ /^struct [a-z_0-9]+ \{$/ {
    split(code, part, " ")
    struct = part[2]
    fields = 0
    if (defined[struct]++ == 1)
        twice = twice " " struct
    next
}

struct && code ~ /^\}/ {
    if (fields > 16 && struct !~ /options|stats|report/) {
        large++
        larges = larges " " struct "(" fields ")"
    }
    struct = ""
}

struct {
    if (code ~ /^    \} /)
        code = ""
    fields += fields_of(code)
}

/^#include "/ {
    split($0, part, "\"")
    from = module_of(FILENAME)
    to = module_of(part[2])
    if (from != to && folder_of(from) == folder_of(to))
        reaches[from, to] = 1
    modules[from]
}

END {
    for (middle in modules)
        for (from in modules)
            if ((from, middle) in reaches)
                for (to in modules)
                    if ((middle, to) in reaches)
                        reaches[from, to] = 1
    for (from in modules)
        if ((from, from) in reaches) {
            circular++
            circle = circle " " from
        }
    printf "what_per_1000_words %.1f\n", all_words ? 1000 * whats / all_words : 0
    printf "large_structs %d%s\n", large, larges
    printf "structs_twice %d%s\n", split(twice, part, " "), twice
    printf "files_in_circles %d%s\n", circular, circle
}
