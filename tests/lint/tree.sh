# the rules of the tree: which folder includes which, headers, format, scripts
. tests/lib.sh

sources() { git ls-files --cached --others --exclude-standard -- "$@" | while read -r f; do [ ! -e "$f" ] || echo "$f"; done; }
# without a process for each file: most are inputs of fuzz targets
scripts()
{
    local f first
    sources '*.sh' tests .ci common/run | sort -u | while read -r f; do
        first=
        case $f in *.sh) ;; *) IFS= read -r -n 20 first <"$f" || true; [[ $first == '#!'*bash* ]] || continue ;; esac
        echo "$f"
    done
}

# A header that its own source includes before all others has been compiled alone by the build.
every_header_compiles_alone()
{
    local flags
    flags=$(pkg-config --cflags OpenEXR)
    sources 'common/*.c' 'common/*.cc' 'stages/*.c' 'stages/*.cc' | xargs -d '\n' awk '
        FNR == 1 { own = FILENAME; sub(/\.[a-z]*$/, ".h", own) }
        /^#include/ { if ($2 == "\"" own "\"") print own; nextfile }' | sort >"$scratch/first"
    sources 'common/*.h' 'stages/*.h' | sort | comm -23 - "$scratch/first" | xargs -P "$(nproc)" -I{} bash -c '
        echo "#include \"{}\"" | gcc -std=c11 -D_GNU_SOURCE -Wall -Wextra -Wno-psabi -Werror -I. $1 -fsyntax-only -xc - || echo {} >>"$0"' "$scratch/alone" "$flags"
    [ ! -e "$scratch/alone" ] || fail "these headers do not compile alone: $(tr '\n' ' ' <"$scratch/alone")"
}

# check_includes FILE...: those that break the order of common/folders.txt, or of stages/NAME/folders.txt, one a line
check_includes()
{
    awk -v common="${FOLDERS:-common/folders.txt}" '
        # the folders that each folder may include, itself among them, into below[place, folder]
        function read_order(place, file,    line, part) {
            while ((getline line <file) > 0) {
                if (line ~ /^#/ || line !~ /:/) continue
                split(line, part, /: */); below[place, part[1]] = " " part[1] " " part[2] " "
            }
            close(file); known[place] = 1
        }
        BEGIN { read_order("common", common) }
        FNR == 1 {
            n = split(FILENAME, at, "/"); stage = at[1] == "stages"; place = stage ? at[1] "/" at[2] : "common"
            own = stage ? (n > 3 ? at[3] : "") : at[2]; order = stage ? place "/folders.txt" : common
            if (stage && n > 3 && !(place in known)) read_order(place, order)
            if (own != "" && !((place, own) in below)) { print FILENAME ": " place "/" own " is not in " order; nextfile }
        }
        match($0, /^[ \t]*#[ \t]*include[ \t]*"[^"]*"/) {
            split(substr($0, RSTART, RLENGTH), quoted, "\""); m = split(quoted[2], to, "/")
            if (to[1] == "common") ok = (("common", to[2]) in below) && (stage || index(below["common", own], " " to[2] " "))
            else ok = stage && to[1] "/" to[2] == place && (own == "" || m > 3 && index(below[place, own], " " to[3] " "))
            if (!ok) print FILENAME ":" FNR ": includes " quoted[2]
        }' "$@"
}

folders_include_only_folders_below()
{
    local bad
    bad=$(sources 'common/*.[ch]' 'common/*.cc' 'stages/*.[ch]' 'stages/*.cc' | xargs -d '\n' bash -c "$(declare -f check_includes)"'; check_includes "$@"' -)
    [ -z "$bad" ] || { echo "$bad"; fail "includes against common/folders.txt or the folders.txt of a stage: $(wc -l <<<"$bad")"; }
}

folders_are_permitted_only_what_they_include()
{
    local below to unused=
    while IFS=' ' read -r own below; do
        for to in $below; do
            grep -qs "^#include \"common/$to/" "common/${own%:}"/* || unused+="${own%:} may include $to, "
        done
    done < <(grep -E '^[a-z]+:' common/folders.txt)
    [ -z "$unused" ] || fail "common/folders.txt permits what nobody includes: ${unused%, }"
}

the_check_of_includes_finds_what_is_wrong()
{
    mkdir -p "$scratch/tree/common/base" "$scratch/tree/common/film" "$scratch/tree/common/odd" "$scratch/tree/stages/a/low" "$scratch/tree/stages/a/high" "$scratch/tree/stages/a/new"
    cd "$scratch/tree" || exit 1
    echo '#include "common/film/shot.h"' >common/base/up.c
    echo '#include "err.h"' >common/base/bare.cc
    echo '#include "common/base/err.h"' >common/odd/unlisted.c
    echo '#include "stages/b/b.h"' >stages/a/other.c
    printf '#include "common/film/shot.h"\n#include "stages/a/own.h"\n#include "stages/a/high/good.h"\n#include <stdio.h>\n' >stages/a/good.c
    printf 'low:\nhigh: low\n' >stages/a/folders.txt
    printf '#include "common/film/shot.h"\n#include "stages/a/low/low.h"\n#include "stages/a/high/own.h"\n' >stages/a/high/good.h
    printf '#include "stages/a/high/good.h"\n#include "stages/a/own.h"\n#include "stages/b/low/b.h"\n' >stages/a/low/up.c
    echo '#include "stages/a/low/low.h"' >stages/a/new/unlisted.c
    echo '#include "common/base/err.h"' >common/film/good.h
    cp "$root/common/folders.txt" .
    FOLDERS=folders.txt check_includes common/*/* stages/*/*.c stages/*/*/* >found
    diff - found <<'TEXT'
common/base/bare.cc:1: includes err.h
common/base/up.c:1: includes common/film/shot.h
common/odd/unlisted.c: common/odd is not in folders.txt
stages/a/other.c:1: includes stages/b/b.h
stages/a/low/up.c:1: includes stages/a/high/good.h
stages/a/low/up.c:2: includes stages/a/own.h
stages/a/low/up.c:3: includes stages/b/low/b.h
stages/a/new/unlisted.c: stages/a/new is not in stages/a/folders.txt
TEXT
}

# calls FILE: "CALLER CALLED" of object files, a call a line, from what nm -A prints
calls()
{
    awk '{ file = $1; sub(/:.*/, "", file); symbol = $NF; type = $(NF - 1) }
        type ~ /^[TDRBC]$/ { at[symbol] = file }
        type == "U" { from[++n] = file; to[n] = symbol }
        END { for (i = 1; i <= n; i++) if ((to[i] in at) && at[to[i]] != from[i]) print from[i], at[to[i]] }' "$@"
}

no_files_call_each_other_in_a_circle()
{
    find "$B/obj/common" "$B/obj/stages" -name '*.o' | sed "s|^$B/obj/||; s|o\$|c|" | while read -r f; do
        [ ! -e "$f" ] || echo "$B/obj/${f%c}o"
    done | xargs nm -A >"$scratch/symbols"
    calls "$scratch/symbols" | sort -u >"$scratch/calls"
    [ -s "$scratch/calls" ] || fail "no file calls another one"
    tsort "$scratch/calls" >"$scratch/order" 2>"$scratch/circles" || { cat "$scratch/circles"; fail "files call each other in a circle"; }
}

the_check_of_circles_finds_one()
{
    printf '%s\n' 'a.o:0000 T f' 'a.o: U g' 'b.o:0000 T g' 'b.o: U f' >"$scratch/ring"
    calls "$scratch/ring" | diff - <(printf 'a.o b.o\nb.o a.o\n')
    ! calls "$scratch/ring" | tsort >/dev/null 2>&1 || fail "a circle of two was not found"
}

# check_names: of lines "FILE FUNCTION", those whose function does not begin with a word of the file's path, in the singular or the
# plural. Apart: vec.h has mat3_ and quat_ too, and a transform is called a_from_b.
check_names()
{
    awk '
        $2 ~ /_from_/ || $2 == "main" || $2 ~ /^_Z/ { next }
        {
            split($2, name, "_"); first = name[1]; path = $1; sub(/\.[a-z]*$/, "", path)
            n = split(path, word, /[\/_]/); ok = path == "common/math/vec" && first ~ /^(mat3|quat)$/
            for (i = 2; i <= n; i++) if (first == word[i] || first == word[i] "s" || first "s" == word[i]) ok = 1
            if (!ok) print $1 ": " $2 "() begins with no word of its path"
        }'
}

functions_begin_with_a_word_of_their_file()
{
    local bad
    sources 'common/*.c' 'common/*.cc' 'stages/*.c' 'stages/*.cc' | while read -r f; do [ ! -e "$B/obj/${f%.*}.o" ] || echo "$B/obj/${f%.*}.o"; done >"$scratch/objects"
    [ -s "$scratch/objects" ] || fail "$B/obj has no objects; build first"
    bad=$(xargs nm -A -g --defined-only <"$scratch/objects" | sed -nE "s|^$B/obj/(.*)\.o:[0-9a-f]+ T (.*)|\1.c \2|p" | check_names)
    [ -z "$bad" ] || { echo "$bad"; fail "external functions that their names do not lead to: $(wc -l <<<"$bad"); rename them, or move them to a file of that name"; }
}

the_check_of_names_finds_what_is_wrong()
{
    check_names >"$scratch/names" <<'TEXT'
common/layers/view_mesh.c mesh_make
common/film/moves.c move_name
common/film/shot.c film_length
common/math/vec.c quat_slerp
common/film/shot.c world_from_shot
stages/relight/light/lamp.c light_sum
common/math/vec.c pose_apply
stages/relight/light/lamp.c lamplight_sum
TEXT
    diff - "$scratch/names" <<'TEXT'
common/math/vec.c: pose_apply() begins with no word of its path
stages/relight/light/lamp.c: lamplight_sum() begins with no word of its path
TEXT
}

# a file is called by its name alone, in messages of compilers and between people
files_have_names_of_their_own()
{
    local twice
    # the rules of each stage are in its rules.c
    twice=$(sources 'common/*.c' 'stages/*.c' 'common/*.h' 'stages/*.h' | sed 's|.*/||; /^rules\.c$/d' | sort | uniq -d | tr '\n' ' ')
    [ -z "$twice" ] || fail "several files are called ${twice}; each needs a name that says what it has"
}

formatted()
{
    command -v clang-format >/dev/null || skip "clang-format is not installed"
    clang-format --version | matches 'version 14\.' || skip "the sources are formatted by clang-format 14 (Debian 12); others do it otherwise"
    sources '*.[ch]' | xargs -P "$(nproc)" -n 100 clang-format --dry-run -Werror --style=file
}

generated_files_are_current()
{
    local stages
    stages=$(make -s --no-print-directory list-stages)
    common/run/generate.sh "$B/bin" "$stages" "$scratch/generated"
    for s in $stages; do
        "$B/bin/$s" --print-config | sed 's/[[:space:]]*$//' >"$scratch/compiled"
        "$B/bin/$s" --print-config --config configs/default.cfg | sed 's/[[:space:]]*$//' >"$scratch/default"
        diff "$scratch/compiled" "$scratch/default" || fail "configs/default.cfg differs from the defaults of $s; run make generated"
    done
    (cd "$scratch/generated" && find . -type f) | while read -r f; do
        diff "$f" "$scratch/generated/$f" || fail "$f is not what the stages say; run make generated"
    done
    for f in docs/man/*.1; do [ -e "$scratch/generated/$f" ] || fail "$f is of no stage; remove it"; done
}

# grep -q and head leave early, and the command that writes into the pipe then dies of SIGPIPE: under pipefail a test fails by chance
no_pipe_ends_before_its_input_does()
{
    local bad
    bad=$(scripts | grep -v '^tests/lint/' |
        xargs grep -nE '(^|[^|])\|[[:space:]]*((LC_ALL=C )?grep [^|]*(-[a-zA-Z]*q|-m ?[0-9]|--quiet|--max-count)|head )' | grep -vE '^[^:]+:[0-9]+:[[:space:]]*#' || true)
    [ -z "$bad" ] || { echo "$bad"; fail "a pipe ends in grep -q, grep -m or head; use matches (tests/lib.sh), or sed -n 1p"; }
}

# grep, and the =~ of bash, take \t between brackets for a backslash and the letter t: write [[:space:]], or [[:blank:]]
# check_brackets FILE...: lines with a letter after a backslash between brackets of these
check_brackets()
{
    grep -HnE '(grep|=~)[^|]*\[[^][]*\\[a-zA-Z][^][]*\]' "$@" |
        grep -vE '^[^:]+:[0-9]+:[[:space:]]*#' || true
}

no_bracket_of_grep_holds_a_letter_for_a_blank()
{
    local bad
    bad=$({ scripts | grep -v '^tests/lint/'; sources '*.mk' Makefile; } | xargs -d '\n' bash -c "$(declare -f check_brackets)"'; check_brackets "$@"' -)
    [ -z "$bad" ] || { echo "$bad"; fail "a letter after a backslash in the brackets of a grep; write [[:space:]] for a blank"; }
}

the_check_of_brackets_finds_what_is_wrong()
{
    printf '%s\n' "grep -E '^wall [^ \t]+ in '" 'if [[ $line =~ wall[[:space:]]+[^\n] ]]; then' "grep -E '^wall [^[:space:]]+ in '" \
        "sed -E 's/^wall [^ \t]+//'" "awk '/^[ \t]*wall/'" '# grep [^ \t]' >"$scratch/brackets"
    check_brackets "$scratch/brackets" | cut -d: -f2 | diff - <(printf '1\n2\n')
}

scripts_pass_shellcheck()
{
    command -v shellcheck >/dev/null || skip "shellcheck is not installed"
    scripts | xargs -P "$(nproc)" -n 8 shellcheck || fail "shellcheck has findings (.shellcheckrc says what is left out, and why)"
}

documents_are_at_most_120_columns_wide()
{
    local bad
    bad=$(sources '*.md' | xargs awk '{ line = $0; gsub(/\]\([^)]*\)/, "]", line) } FNR == 1 { code = 0 } /^```/ { code = !code }
        length(line) > 120 && !/^\|/ && !code { print FILENAME ":" FNR ": " length(line) " columns" }')
    [ -z "$bad" ] || { echo "$bad"; fail "lines of documents over 120 columns (rows of tables may be longer)"; }
}

# Shell scripts and parts of the Makefile are not held to it yet.
code_is_at_most_120_columns_wide()
{
    local bad
    bad=$(sources '*.[ch]' '*.cc' '*.def' 'common/*.awk' |
        xargs awk 'length > 120 { print FILENAME ":" FNR ": " length " columns" }')
    [ -z "$bad" ] || { echo "$bad"; fail "lines of code over 120 columns"; }
}

# what "Where to change what" of the architecture document names must exist: files, and functions in the code
the_architecture_names_what_exists()
{
    local missing
    sed -n '/^## Where to change what/,$p' docs/architecture.md >"$scratch/ways"
    missing=$(grep -oE '`(common|stages|tests|docs)/[A-Za-z_0-9./]+`' "$scratch/ways" | tr -d '`' | sort -u |
        while read -r f; do [ -e "$f" ] || echo "$f"; done
        grep -oE '`[a-z_0-9]+\(\)`' "$scratch/ways" | tr -d '`()' | sort -u |
            while read -r f; do grep -rqw "$f" common stages || echo "$f()"; done)
    [ -s "$scratch/ways" ] && [ -z "$missing" ] || fail "docs/architecture.md names what does not exist: ${missing//$'\n'/, }"
}

vectors_of_a_processor_are_in_one_header()
{
    local bad
    bad=$(sources '*.[ch]' '*.cc' | grep -v '^common/math/lanes.h$' | xargs grep -nE 'immintrin|\b_mm(256)?_|\b__m(128|256)|__builtin_ia32|_cvtsh_ss|_cvtss_sh' || true)
    [ -z "$bad" ] || { echo "$bad"; fail "instructions of a processor outside of common/math/lanes.h"; }
}

cited_sources_are_in_the_list()
{
    local missing
    missing=$(sources 'common/*' 'stages/*' | xargs grep -ohE '\[[A-Z][A-Za-z-]+ (19|20)[0-9]{2}[a-z]?' | sort -u | cut -c2- |
        while read -r key; do grep -qF "[$key]" docs/references.md || echo "$key"; done)
    [ -z "$missing" ] || fail "docs/references.md does not have: ${missing//$'\n'/, }"
}

run every_header_compiles_alone
run folders_include_only_folders_below
run folders_are_permitted_only_what_they_include
run the_check_of_includes_finds_what_is_wrong
run no_files_call_each_other_in_a_circle
run the_check_of_circles_finds_one
run functions_begin_with_a_word_of_their_file
run the_check_of_names_finds_what_is_wrong
run files_have_names_of_their_own
run formatted
run generated_files_are_current
run no_pipe_ends_before_its_input_does
run no_bracket_of_grep_holds_a_letter_for_a_blank
run the_check_of_brackets_finds_what_is_wrong
run scripts_pass_shellcheck
# A variable that people give on the command line keeps that value, whatever a file of make assigns to it.
variables_of_people_are_not_assigned()
{
    local v bad=
    for v in $(grep -hoE '^## [A-Z_]+=' Makefile common/make/*.mk stages/*/stage.mk | sed 's/^## //; s/=//' | sort -u); do
        bad+=$(grep -nE "^ *$v *:?= " Makefile common/make/*.mk stages/*/stage.mk || true)
    done
    [ -z "$bad" ] || { echo "$bad"; fail "a variable of make that people give is assigned; name the inner one otherwise"; }
}

run variables_of_people_are_not_assigned
run documents_are_at_most_120_columns_wide
run code_is_at_most_120_columns_wide
run the_architecture_names_what_exists
run vectors_of_a_processor_are_in_one_header
run cited_sources_are_in_the_list
