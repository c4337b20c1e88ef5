# Reads C files and prints figures of them: "what" per 1,000 words of comments; "that",
# and "it", "they" and "them", in the folder of 1,000 words or more that has most; structs
# with more than 16 fields, structs whose name is defined twice; fields of the largest
# struct upstairs and elsewhere, with those of the structs in it; numbers upstairs, with a
# name and without.
#
#   awk -f tests/storeys.awk FILE.[ch]...

# Counts the words of a comment's line.
function read_words(text, count, i, words, word, folder)
{
    gsub(/[^A-Za-z'_]+/, " ", text)
    count = split(text, words, " ")
    for (i = 1; i <= count; i++) {
        all_words++
        word = tolower(words[i])
        whats += word == "what"
        folder = folder_of(FILENAME)
        words_of[folder]++
        thats[folder] += word == "that"
        its[folder] += word ~ /^(it|they|them)$/
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

# The fields of a declaration in a struct.
function fields_of(code)
{
    while (sub(/[([{][^][(){}]*[])}]/, "", code))
        ;
    return gsub(/,/, ",", code) + 1
}

# Keeps the structs that a declaration has in it by value. A vector is one quantity.
function note_members(code, declarators, count, i)
{
    if (code !~ /^ *(const )?struct [a-z_0-9]+ .*;/ || code ~ /\(/)
        return
    sub(/^ *(const )?struct /, "", code)
    count = split(code, declarators, ",")
    for (i = 1; i <= count; i++)
        if (declarators[i] !~ /\*/ && code !~ /^vec3 /)
            members[struct] = members[struct] " " substr(code, 1, index(code, " ") - 1)
}

# Fields of a struct, with those of its members in place of these.
function all_fields(name, total, count, i, inner)
{
    total = own_fields[name]
    count = split(members[name], inner, " ")
    for (i = 1; i <= count; i++)
        if (inner[i] in own_fields)
            total += all_fields(inner[i]) - 1
    return total
}

# True if a text is a number and no name: 8, 1.0 / 16.0, INT64_C(1) << 60.
function is_number(text)
{
    gsub(/U?INT[0-9]+_C/, "", text)
    return text ~ /[0-9]/ && text !~ /(^|[^A-Za-z0-9_.])[A-Za-z_]/
}

# Counts the numbers of a text that have no name, but for those of everyday formulas.
function count_bare(text, token)
{
    gsub(/"[^"]*"/, "", text)
    while (match(text, /[A-Za-z_0-9.]+([ep]-[0-9]+)?/)) {
        token = substr(text, RSTART, RLENGTH)
        text = substr(text, RSTART + RLENGTH)
        sub(/[fuUlL]+$/, "", token)
        if (token ~ /^\.?[0-9]/ && token !~ /^([0-4](\.0)?|0\.5|0\.25)$/)
            bare++
    }
}

# Counts the numbers of a statement: constants and enumerators have a name.
function count_numbers(statement, list, count, i, part, names)
{
    names = statement ~ /(^|[^a-z_])enum( [a-z_]+)? \{/ ||
            statement ~ /(^|[^a-z_])const [a-z_0-9]+ [A-Z][A-Z_0-9]* = /
    count = split(statement, list, ",")
    for (i = 1; i <= count; i++)
        if (names && split(list[i], part, " = ") == 2 && is_number(part[2]))
            named++
        else
            count_bare(list[i])
}

# Adds a line to the statement at hand, and counts the numbers of those that end in it.
function read_statements(code, end)
{
    if (code ~ /^#define [A-Z_0-9]+ /) {
        sub(/^#define [A-Z_0-9]+ +/, "", code)
        count_numbers("const define NAME = " code)
        return
    }
    statement = statement (code ~ /^#/ ? "" : " " code)
    while ((end = index(statement, ";")) > 0) {
        count_numbers(substr(statement, 1, end - 1))
        statement = substr(statement, end + 1)
    }
}

# The most per 1,000 words of a folder's comments, and where that is above 15.
function most_of(counts, folder, most, part, list)
{
    for (folder in words_of) {
        part = 1000 * counts[folder] / words_of[folder]
        if (words_of[folder] < 1000)
            continue
        if (part > most)
            most = part
        if (part > 15)
            list = list " " folder sprintf("(%.1f)", part)
    }
    return sprintf("%.1f", most) list
}

function folder_of(path)
{
    return match(path, /.*\//) ? substr(path, 1, RLENGTH) : ""
}

FNR == 1 { inside = 0; struct = statement = ""; upstairs = FILENAME ~ /beyond\// }

{ code = without_comments($0) }

upstairs { read_statements(code) }

code ~ /^struct [a-z_0-9]+ \{$/ {
    split(code, part, " ")
    struct = part[2]
    declaration = ""
    fields = 0
    place[struct] = upstairs ? "upstairs" : "elsewhere"
    if (defined[struct]++ == 1)
        twice = twice " " struct
    next
}

struct && code ~ /^\}/ {
    if (fields > 16 && struct !~ /options|stats|report/) {
        large++
        larges = larges " " struct "(" fields ")"
    }
    own_fields[struct] = fields
    struct = ""
}

struct {
    if (code ~ /^    \} /)
        code = ""
    declaration = declaration " " code
    if (code ~ /;/) {
        fields += fields_of(declaration)
        note_members(declaration)
        declaration = ""
    }
}

END {
    for (name in own_fields) {
        total = all_fields(name)
        if (total > largest[place[name]])
            largest[place[name]] = total
        if (total > 20)
            list[place[name]] = list[place[name]] " " name "(" total ")"
    }
    printf "what_per_1000_words %.1f\n", all_words ? 1000 * whats / all_words : 0
    print "that_per_1000_words " most_of(thats)
    print "it_they_them_per_1000_words " most_of(its)
    printf "large_structs %d%s\n", large, larges
    printf "structs_twice %d%s\n", split(twice, part, " "), twice
    printf "fields_upstairs %d%s\n", largest["upstairs"], list["upstairs"]
    printf "fields_elsewhere %d%s\n", largest["elsewhere"], list["elsewhere"]
    printf "named_numbers_upstairs %d\n", named
    printf "bare_numbers_upstairs %d\n", bare
}
