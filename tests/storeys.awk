# Reads C files and prints figures of them: structs whose name is defined twice; numbers
# upstairs, with a name and without.
#
#   awk -f tests/storeys.awk FILE.[ch]...

# Takes the comments out of a line; returns the code.
function without_comments(line, code, at)
{
    code = ""
    for (;;) {
        if (inside) {
            at = index(line, "*/")
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

FNR == 1 { inside = 0; statement = "" }

{ code = without_comments($0) }

FILENAME ~ /beyond\// { read_statements(code) }

code ~ /^struct [a-z_0-9]+ \{$/ {
    split(code, part, " ")
    if (defined[part[2]]++ == 1)
        twice = twice " " part[2]
}

END {
    printf "structs_twice %d%s\n", split(twice, part, " "), twice
    printf "named_numbers_upstairs %d\n", named
    printf "bare_numbers_upstairs %d\n", bare
}
