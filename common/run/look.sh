#!/usr/bin/env bash
# look.sh slices BIN FOLDER 'STAGE...' CONFIG... - each stage's effective parameters, as FOLDER/STAGE.cfg.
#
# A file is rewritten only if its text changed, so that nothing else reruns.
set -euo pipefail
. common/run/keep.sh
bin=$2 folder=$3 stages=$4; shift 4

known=" $(cd stages && echo */) "
for c in "$@"; do
    awk -v known="${known//\// }" -v file="$c" '
        /^[ \t]*\[/ { s = $0; gsub(/^[ \t]*\[[ \t]*|[ \t]*\].*$/, "", s)
            if (!index(known, " " s " ")) { printf "%s:%d: found the section [%s], which no stage has; wanted one of:%s\n", file, NR, s, known; bad = 1 } }
        END { exit bad }' "$c" >&2 || exit 2
done
options=()
for c in "$@"; do options+=(--config "$c"); done
for s in $stages; do
    text=$("$bin/$s" --print-config "${options[@]}") || exit 2
    keep_text "$folder/$s.cfg" "$text"$'\n'
done
