#!/usr/bin/env bash
# look.sh BIN S O SCENE_FOLDER - records of the photos, in S/photos, their sizes and their masks, in S/stamp.
set -euo pipefail
bin=$1 folder=$2 scene=$4
. common/run/keep.sh

exclude=()
if [ -n "${REMODEL_EXCLUDE-}" ]; then # names with blanks are quoted
    while IFS= read -r -d '' n; do exclude+=(--exclude "$n"); done < <(xargs printf '%s\0' <<<"$REMODEL_EXCLUDE")
fi
split=()
[ -z "${REMODEL_SPLIT-}" ] || split=(--split "$REMODEL_SPLIT" --cuts "$folder/split")
photos=() # a folder, or clips; names with blanks are quoted
if [ -e "$REMODEL_PHOTOS" ]; then photos=(--photos "$REMODEL_PHOTOS")
else while IFS= read -r -d '' n; do photos+=(--photos "$n"); done < <(xargs printf '%s\0' <<<"$REMODEL_PHOTOS"); fi
single=() # with its depth, one photo is enough
[ -z "${REMODEL_DEPTH-}" ] || single=(--single)
mode=silent
[ -e "$folder/photos/list.txt" ] || mode=live
common/run/run_stage.sh "$mode" import_photos all "$folder" "$bin/import_photos" --config "$folder/slice/import_photos.cfg" \
    "${photos[@]}" --scene "$scene" "${exclude[@]}" "${split[@]}" "${single[@]}" --depth "$folder/photo_depth" --frames "$folder/frames" --out "$folder/photos"
[ "$mode" = live ] || grep -h warning: "$folder/log/import_photos.all.log" >&2 || true
find "$folder/photos" -maxdepth 1 -name '*.txt' ! -name list.txt ! -name brackets.txt -print0 | LC_ALL=C sort -z | xargs -0 awk '
    FNR == 1 { name = FILENAME; sub(/.*\//, "", name); printf "%s%s ", (NR > 1 ? "\n" : ""), name }
    /^(size|orientation) / { printf "%s ", $0 }
    END { if (NR) print "" }' | keep "$folder/stamp/photo_sizes.txt"

# a photo's mask; a view of several exposures has the masks of all of them
if [ -d "$scene/masks" ]; then
    known=$(cd "$folder/photos" && awk '
        FNR == 1 { id = FILENAME; sub(/.*\//, "", id); sub(/\.txt$/, "", id); member = FILENAME ~ /^members\//; if (!member) print id, id }
        member && /^file / { sub(/^file /, ""); id_from_file[$0] = id }
        !member && /^bracket / { sub(/^bracket /, ""); sub(/ [^ ]+ [^ ]+$/, ""); if ($0 in id_from_file) print id_from_file[$0], id }
    ' $([ ! -d members ] || [ ! -e brackets.txt ] || echo members/*.txt) $(cut -d' ' -f1 list.txt | sed 's/$/.txt/'))
    sums "$scene/masks" "$folder/photos/list.txt" png | awk -v known="${known//$'\n'/ }" -v where="$scene/masks" -v list="$folder/photos/list.txt" '
        BEGIN { n = split(known, w); for (i = 1; i < n; i += 2) of[w[i]] = w[i + 1] }
        $1 in of { print of[$1], $2, $3, $4; next }
        { print "warning: " where "/" $4 " masks nothing: no photo has the id " $1 "; " list " has them." >"/dev/stderr" }'
fi | stamps "$folder/stamp/mask"
