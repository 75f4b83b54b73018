#!/usr/bin/env bash
# look.sh BIN S SCENE_FOLDER - records of the photos, their sizes, what SfM starts from, masks, and depth that a user brings.
set -euo pipefail
bin=$1 folder=$2 scene=$3
. common/run/keep.sh

exclude=()
if [ -n "${REMODEL_EXCLUDE-}" ]; then # names with blanks are quoted
    while IFS= read -r -d '' n; do exclude+=(--exclude "$n"); done < <(xargs printf '%s\0' <<<"$REMODEL_EXCLUDE")
fi
split=()
[ -z "${REMODEL_SPLIT-}" ] || split=(--split "$REMODEL_SPLIT" --cuts "$folder/split")
mode=silent
[ -e "$folder/photos/list.txt" ] || mode=live
common/run/run_stage.sh "$mode" import_photos all "$folder" "$bin/import_photos" --config "$folder/slice/import_photos.cfg" \
    --photos "$REMODEL_PHOTOS" --scene "$scene" "${exclude[@]}" "${split[@]}" --out "$folder/photos"
[ "$mode" = live ] || grep -h warning: "$folder/log/import_photos.all.log" >&2 || true
for r in "$folder"/photos/*.txt; do
    [[ ${r##*/} = list.txt || ${r##*/} = brackets.txt ]] || { printf '%s ' "${r##*/}"; grep -E '^(size|orientation) ' "$r" | tr '\n' ' '; echo; }
done | keep "$folder/stamp/photo_sizes.txt"
{
    if [ -n "${REMODEL_SFM-}" ]; then
        (cd "$REMODEL_SFM" && find . -type f \( -name '*.txt' -o -name '*.bin' -o -name '*.out' \) -print0 | LC_ALL=C sort -z | xargs -0r cksum)
    else
        echo "COLMAP"
    fi
    [ -z "${REMODEL_SPLIT-}" ] || grep '^grid ' "$folder/split/split.txt"
} | keep "$folder/stamp/sfm_source.txt"

# stamps WHAT: standard input is lines "NAME TEXT..."; NAME's lines become stamp/WHAT/NAME.txt, and what is named no more says "none"
stamps()
{
    local to=$folder/stamp/$1 name text f
    declare -A lines=()
    while read -r name text; do lines[$name]+=$text$'\n'; done
    for f in "$to"/*.txt; do
        name=${f##*/}; name=${name%.txt}
        [ ! -e "$f" ] || [ -n "${lines[$name]-}" ] || echo none | keep "$f"
    done
    for name in "${!lines[@]}"; do printf '%s' "${lines[$name]}" | keep "$to/$name.txt"; done
}
# sums FOLDER ENDING...: "NAME CKSUM SIZE FILE" of the files there, NAME without the ending
sums()
{
    local where=$1 ending f; shift
    for ending in "$@"; do
        for f in "$where"/*."$ending"; do
            [ -f "$f" ] || continue
            f=${f##*/}
            if [[ ${f%.*} =~ ^[A-Za-z0-9_@-]+$ ]]; then echo "${f%.*} $(cd "$where" && cksum "$f")"; else
                echo "warning: $where/$f is not looked at: its name must be a photo's id, as $folder/photos/list.txt has it." >&2; fi
        done
    done
}

# a photo's mask; of one that stands for several exposures also these photos' masks
if [ -d "$scene/masks" ]; then
    known=$(cd "$folder/photos" && awk '
        FNR == 1 { id = FILENAME; sub(/.*\//, "", id); sub(/\.txt$/, "", id); member = FILENAME ~ /^members\//; if (!member) print id, id }
        member && /^file / { sub(/^file /, ""); id_from_file[$0] = id }
        !member && /^bracket / { sub(/^bracket /, ""); sub(/ [^ ]+ [^ ]+$/, ""); if ($0 in id_from_file) print id_from_file[$0], id }
    ' $([ ! -d members ] || [ ! -e brackets.txt ] || echo members/*.txt) $(cut -d' ' -f1 list.txt | sed 's/$/.txt/'))
    sums "$scene/masks" png | awk -v known="${known//$'\n'/ }" -v where="$scene/masks" -v list="$folder/photos/list.txt" '
        BEGIN { n = split(known, w); for (i = 1; i < n; i += 2) of[w[i]] = w[i + 1] }
        $1 in of { print of[$1], $2, $3, $4; next }
        { print "warning: " where "/" $4 " masks nothing: no photo has the id " $1 "; " list " has them." >"/dev/stderr" }'
fi | stamps mask

# the depth files of DEPTH, each with the file that tells their units; what they are of is known when there are views
if [ -n "${REMODEL_DEPTH-}" ]; then
    units=$(cd "$REMODEL_DEPTH" && { [ ! -e depth.txt ] || cksum depth.txt; })
    sums "$REMODEL_DEPTH" exr png | sed "s|\$| $units|"
fi | stamps given
