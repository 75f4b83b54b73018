#!/usr/bin/env bash
# keep.sh - files that are rewritten only if their text changes, so that what depends on them does not rerun.
#
#   . common/run/keep.sh        for scripts: the function keep
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

if [ "${BASH_SOURCE[0]}" = "$0" ]; then
    set -euo pipefail
    [ $# -gt 0 ] || exit 0
    file=$1; shift
    if [ $# -gt 0 ]; then printf '%s\n' "$@" | keep "$file"; else rm -f "$file"; fi
fi
