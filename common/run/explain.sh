#!/usr/bin/env bash
# explain.sh - what the Makefile says to people.
set -euo pipefail
what=$1; shift
case $what in
no-scene)
    cat <<'TEXT'
To make a 3D pan & scan video of your own, give a folder of photos of one scene, taken from places a step apart:

    make PHOTOS=DIR SCENE=NAME      8 to 15 photos; the video and a page come under out/NAME
    make SCENE=NAME                 goes on, or redoes just what is stale
    make help                       all targets and variables
    make check                      the tests
TEXT
    ;;
help)
    echo "remodel: from a folder of photographs to a 3D pan & scan video"
    echo
    echo "targets"
    sed -nE 's/^([a-z%-]+):[^#]*## (.*)/\1\t\2/p' "$1" | awk -F'\t' '{ sub(/%/, "NAME", $1); printf "  %-14s %s\n", $1, $2 }'
    echo "variables"
    sed -nE 's/^## ([^:]*): (.*)/\1\t\2/p' "$1" | awk -F'\t' '{ printf "  %-28s %s\n", $1, $2 }'
    echo "scenes"
    found=
    for s in scenes/*/scene.mk; do
        [ -e "$s" ] || continue
        found=1
        printf '  %-28s %s\n' "$(basename "$(dirname "$s")")" "$(sed -nE 's/^PHOTOS *:?= *//p' "$s" | head -n 1)"
    done
    [ -n "$found" ] || echo "  none yet: make PHOTOS=DIR SCENE=NAME makes one"
    ;;
why) # standard input: make -n --debug=b
    said=$(awk -v S="$1" '
        /^ *File .* does not exist\.$/ { gsub(/^ *File .|. does not exist\.$/, ""); reason[$0] = "it does not exist" }
        /^ *Prerequisite .* is newer than target / {
            split($0, q, /\047/); t = q[4]; p = q[2]
            if (index(reason[t], p) == 0) { reason[t] = reason[t] (reason[t] ? ", " : "") p (p in must ? " will be new" : " is newer") } }
        /^ *Must remake target / { split($0, q, /\047/); t = q[2]; must[t] = 1; order[++n] = t }
        END {
            for (i = 1; i <= n; i++) {
                t = order[i]
                if (index(t, S) != 1 || t in said) continue
                said[t] = 1
                print t ": " (reason[t] ? reason[t] : "it is made together with one that is stale")
            }
        }')
    echo "${said:-Nothing is stale.}"
    for s in $(grep -oE '[^ ]*/slice/[a-z_]*\.cfg is newer' <<<"$said" | cut -d' ' -f1 | sort -u); do
        [ ! -e "$s.old" ] || diff "$s.old" "$s" | sed -nE "s|^< (.*)|$s: was \1|p; s|^> (.*)|$s: is \1|p" || true
    done
    ;;
changed-photos) # photos whose content is not what SfM saw
    S=$1 scene=$2
    [ -e "$S/sfm/photos.txt" ] && [ -z "${REMODEL_SFM-}" ] || exit 0
    changed=$(awk 'FNR == 1 { f = FILENAME; sub(/.*\//, "", f); sub(/\.txt$/, "", f) }
        FILENAME ~ /sfm\/photos\.txt$/ { saw[$1] = $2; next }
        $1 == "hash" && f in saw && saw[f] != $2 { print f }' "$S/sfm/photos.txt" "$S"/photos/*.txt | tr '\n' ' ')
    [ ! -e "scenes/$scene/masks" ] || changed+=$(find "scenes/$scene/masks" -name '*.png' -newer "$S/sfm/models.txt" -printf 'masks/%P ' | tr ' ' '\n' | LC_ALL=C sort | tr '\n' ' ')
    [ -z "${changed// /}" ] || echo "Changed since the camera poses were found: ${changed# }- the poses are kept; make resfm SCENE=$scene finds them anew."
    ;;
given-depth) # which views have a file in DEPTH, and which files there are of no view
    S=$1 O=$2
    [ -n "${REMODEL_DEPTH-}" ] || exit 0
    views=$(sed 's/^VIEWS :=//' "$O/views/views.mk")
    held=$([ ! -e "$O/holdout/views/views.mk" ] || sed 's/^VIEWS :=//' "$O/holdout/views/views.mk")
    of_views=0 of_none=
    for f in "$S"/stamp/given/*.txt; do
        [ -e "$f" ] && ! grep -qx none "$f" || continue
        f=${f##*/}; f=${f%.txt}
        case " $views " in *" $f "*) of_views=$((of_views + 1)); continue ;; esac
        case " $held " in *" $f "*) ;; *) of_none+=" $f" ;; esac
    done
    echo "DEPTH=$REMODEL_DEPTH gives the depth of $of_views of $(wc -w <<<"$views") views."
    [ -z "$of_none" ] || echo "warning: DEPTH=$REMODEL_DEPTH has files of what is no view:$of_none; $O/views/views.mk lists the views." >&2
    ;;
metrics)
    grep '^# skipped' "$1/metrics.tsv" | sed 's/^# /  /' || true
    awk -F'\t' '!/^#/ { printf "  %-36s %12.6g %s\n", $1, $2, $3 == "1" ? "" : $3 }' "$1/metrics.tsv"
    echo "table  $1/metrics.tsv"
    ;;
products)
    for v in "$1"/parallax/*/video.mp4 "$1"/parallax/*/pan_scan/video.mp4; do [ ! -e "$v" ] || echo "video  $v"; done
    [ ! -e "$1/index.html" ] || echo "page   $1/index.html"
    ;;
esac
