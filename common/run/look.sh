#!/usr/bin/env bash
# look.sh - what every run looks at afresh; a file is rewritten only if its text changed, so that nothing else reruns.
#
#   look.sh slices BIN FOLDER 'STAGE...' CONFIG...   each stage's effective parameters -> FOLDER/STAGE.cfg
#   look.sh photos BIN S SCENE_FOLDER                the photos' records, their sizes, what SfM starts from, masks, depth that was given
#   look.sh lri BIN S                                records of the lighting reference images, and what tells their cameras
#   look.sh morph BIN O 'ID ID'                      which photos a morph goes between
#   look.sh evaluation BIN O HOLDOUT HOLDOUT_VIEWS   what is held out, and the files of the truth
set -euo pipefail
what=$1 bin=$2 folder=$3; shift 3

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

if [ "$what" = slices ]; then
    stages=$1; shift
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
        echo "$text" | keep "$folder/$s.cfg"
    done
    exit 0
fi

if [ "$what" = lri ]; then
    common/run/run_stage.sh silent import_photos lri "$folder" "$bin/import_photos" --config "$folder/slice/import_photos.cfg" \
        --photos "$REMODEL_LRI" --scene "$REMODEL_LRI" --like "$folder/photos" --out "$folder/lri/photos"
    grep -h warning: "$folder/log/import_photos.lri.log" >&2 || true
    { [ -z "${REMODEL_LRI_SFM-}" ] || (cd "$REMODEL_LRI_SFM" && cksum cameras.txt images.txt); } | keep "$folder/stamp/lri.txt"
    exit 0
fi
if [ "$what" = morph ]; then
    if [ -n "$1" ]; then echo "$1" | keep "$folder/stamp/morph.txt"; else rm -f "$folder/stamp/morph.txt"; fi
    exit 0
fi
if [ "$what" = evaluation ]; then
    [ -z "$1$2" ] || printf 'every %s\nviews %s\n' "$1" "$2" | keep "$folder/stamp/holdout.txt"
    if [ -n "${REMODEL_TRUTH-}" ]; then
        find -L "$REMODEL_TRUTH" -type f -printf '%P %s %T@\n' | LC_ALL=C sort
    else
        echo "no truth"
    fi | keep "$folder/stamp/truth.txt"
    exit 0
fi

scene=$1
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
