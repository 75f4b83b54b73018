#!/usr/bin/env bash
# keep.sh - files that are rewritten only if their text changes, so that what depends on them does not rerun.
#
#   . common/run/keep.sh        for scripts: the functions keep_text, keep, stamps, sums
#   keep.sh FILE [LINE...]      makes FILE of these lines; without a line, removes FILE; without FILE does nothing

# keep_text FILE TEXT: FILE gets this text if it differs; the text before is kept as FILE.old for `make why`. Without a process
# where nothing changes: a run looks at a hundred such files
keep_text()
{
    local before=
    if [ -f "$1" ]; then
        IFS= read -r -d '' before <"$1" || true
        [ "$before" != "$2" ] || return 0
        cp -f "$1" "$1.old"
    fi
    [ -d "${1%/*}" ] || mkdir -p "${1%/*}"
    printf '%s' "$2" >"$1.tmp"
    mv "$1.tmp" "$1"
}
# keep FILE: the same with standard input
keep()
{
    local text
    text=$(cat; echo .)
    keep_text "$1" "${text%.}"
}

# stamps FOLDER: standard input is lines "NAME TEXT..."; the lines of a name become FOLDER/NAME.txt; a name that is gone says "none"
stamps()
{
    local to=$1 name text f
    declare -A lines=()
    while read -r name text; do lines[$name]+=$text$'\n'; done
    for f in "$to"/*.txt; do
        name=${f##*/}; name=${name%.txt}
        [ ! -e "$f" ] || [ -n "${lines[$name]-}" ] || keep_text "$f" $'none\n'
    done
    for name in "${!lines[@]}"; do keep_text "$to/$name.txt" "${lines[$name]}"; done
}
# sums FOLDER LIST ENDING...: "NAME CKSUM SIZE FILE" of the files in FOLDER, NAME without the ending; LIST names the file of valid ids
sums()
{
    local where=$1 list=$2 ending f; shift 2
    for ending in "$@"; do
        for f in "$where"/*."$ending"; do
            [ -f "$f" ] || continue
            f=${f##*/}
            if [[ ${f%.*} =~ ^[A-Za-z0-9_@-]+$ ]]; then echo "${f%.*} $(cd "$where" && cksum "$f")"; else
                echo "warning: $where/$f is ignored: its name must be a photo's id from $list." >&2; fi
        done
    done
}

if [ "${BASH_SOURCE[0]}" = "$0" ]; then
    set -euo pipefail
    [ $# -gt 0 ] || exit 0
    file=$1; shift
    if [ $# -gt 0 ]; then printf '%s\n' "$@" | keep "$file"; else rm -f "$file"; fi
fi
