# the rules of the tree: which folder includes which, headers, format, scripts
. tests/lib.sh

sources() { git ls-files --cached --others --exclude-standard -- "$@" | while read -r f; do [ ! -e "$f" ] || echo "$f"; done; }
scripts() { sources '*.sh' tests .ci common/run | sort -u | while read -r f; do case $f in *.sh) echo "$f" ;; *) [[ $(head -c 20 "$f" | tr -d '\0') != '#!'*bash* ]] || echo "$f" ;; esac; done; }

every_header_compiles_alone()
{
    sources 'common/*.h' 'stages/*.h' | xargs -P "$(nproc)" -I{} bash -c '
        echo "#include \"{}\"" | gcc -std=c11 -D_GNU_SOURCE -Wall -Wextra -Wno-psabi -Werror -I. $(pkg-config --cflags OpenEXR) -fsyntax-only -xc - || echo {} >>"$0"' "$scratch/alone"
    [ ! -e "$scratch/alone" ] || fail "these headers do not compile alone: $(tr '\n' ' ' <"$scratch/alone")"
}

# check_includes FILE...: those that break the order of common/folders.txt, one a line
check_includes()
{
    awk -v folders="${FOLDERS:-common/folders.txt}" '
        BEGIN {
            while ((getline line <folders) > 0) {
                if (line ~ /^#/ || line !~ /:/) continue
                split(line, part, /: */); below[part[1]] = " " part[1] " " part[2] " "
            } }
        FNR == 1 { n = split(FILENAME, at, "/"); stage = at[1] == "stages"; own = at[2] }
        FNR == 1 && !stage && !(own in below) { print FILENAME ": common/" own " is not in " folders; nextfile }
        match($0, /^[ \t]*#[ \t]*include[ \t]*"[^"]*"/) {
            split(substr($0, RSTART, RLENGTH), quoted, "\""); split(quoted[2], to, "/")
            ok = to[1] == "common" && (to[2] in below) && (stage || index(below[own], " " to[2] " ")) || stage && to[1] == "stages" && to[2] == own
            if (!ok) print FILENAME ":" FNR ": includes " quoted[2]
        }' "$@"
}

folders_include_only_folders_below()
{
    local bad
    bad=$(sources 'common/*.[ch]' 'common/*.cc' 'stages/*.[ch]' 'stages/*.cc' | xargs -d '\n' bash -c "$(declare -f check_includes)"'; check_includes "$@"' -)
    [ -z "$bad" ] || { echo "$bad"; fail "includes against common/folders.txt: $(wc -l <<<"$bad")"; }
}

the_check_of_includes_finds_what_is_wrong()
{
    mkdir -p "$scratch/tree/common/base" "$scratch/tree/common/film" "$scratch/tree/common/odd" "$scratch/tree/stages/a"
    cd "$scratch/tree" || exit 1
    echo '#include "common/film/shot.h"' >common/base/up.c
    echo '#include "err.h"' >common/base/bare.cc
    echo '#include "common/base/err.h"' >common/odd/unlisted.c
    echo '#include "stages/b/b.h"' >stages/a/other.c
    printf '#include "common/film/shot.h"\n#include "stages/a/own.h"\n#include <stdio.h>\n' >stages/a/good.c
    echo '#include "common/base/err.h"' >common/film/good.h
    cp "$root/common/folders.txt" .
    FOLDERS=folders.txt check_includes common/*/* stages/*/* >found
    diff - found <<'TEXT'
common/base/bare.cc:1: includes err.h
common/base/up.c:1: includes common/film/shot.h
common/odd/unlisted.c: common/odd is not in folders.txt
stages/a/other.c:1: includes stages/b/b.h
TEXT
}

formatted()
{
    command -v clang-format >/dev/null || skip "clang-format is not installed"
    sources '*.[ch]' | xargs clang-format --dry-run -Werror --style=file
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
run the_check_of_includes_finds_what_is_wrong
run formatted
run generated_files_are_current
run no_pipe_ends_before_its_input_does
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
run the_architecture_names_what_exists
run vectors_of_a_processor_are_in_one_header
run cited_sources_are_in_the_list
