#!/usr/bin/env bash
# keep.sh - files that are rewritten only if their text changes, so that what depends on them does not rerun.
#
#   . common/run/keep.sh        for scripts: the functions keep, stamps, sums
#   keep.sh FILE [LINE...]      makes FILE of these lines; without a line, removes FILE; without FILE does nothing

# keep FILE: standard input becomes FILE if it differs; the text before is kept as FILE.old for `make why`
keep()
{
    mkdir -p "$(dirname "$1")"
    cat >"$1.tmp"
    if cmp -s "$1.tmp" "$1"; then rm "$1.tmp"; else
        [ ! -e "$1" ] || cp -f "$1" "$1.old"
        mv "$1.tmp" "$1"
    fi
}

# stamps FOLDER: standard input is lines "NAME TEXT..."; the lines of a name become FOLDER/NAME.txt; a name that is gone says "none"
stamps()
{
    local to=$1 name text f
    declare -A lines=()
    while read -r name text; do lines[$name]+=$text$'\n'; done
    for f in "$to"/*.txt; do
        name=${f##*/}; name=${name%.txt}
        [ ! -e "$f" ] || [ -n "${lines[$name]-}" ] || echo none | keep "$f"
    done
    for name in "${!lines[@]}"; do printf '%s' "${lines[$name]}" | keep "$to/$name.txt"; done
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
