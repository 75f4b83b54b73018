#!/usr/bin/env bash
# look.sh BIN S - the depth files of DEPTH, of the model in SFM, or of a portrait, in S/stamp/given, each with the checksum of the
# file that gives their units. Which view a file belongs to is known only when there are views.
set -euo pipefail
folder=$2
. common/run/keep.sh
depth=${REMODEL_DEPTH-}
[ -n "$depth" ] || [ ! -d "$folder/sfm_depth" ] || depth=$folder/sfm_depth
[ -n "$depth" ] || [ ! -d "$folder/photo_depth" ] || depth=$folder/photo_depth
# maps DIR LIST: "ID CKSUM SIZE FILE" of the depth files in DIR, whose names, extensions too, may differ from the ids in LIST in capitals
maps()
{
    local f stem id
    declare -A ids=()
    while read -r id _; do ids[${id,,}]=$id; done < <(grep -v '^#' "$2")
    (
        cd "$1"
        shopt -s nullglob nocaseglob
        for f in *.exr *.png *.pfm *.tif *.tiff; do
            [ -f "$f" ] || continue
            stem=${f%.*}; id=${stem%@*}
            stem=${ids[${id,,}]-$id}${stem#"$id"}
            if [[ $stem =~ ^[A-Za-z0-9_@-]+$ ]]; then echo "$stem $(cksum "$f")"; else
                echo "warning: $1/$f is ignored: its name must be a photo's id from $2." >&2; fi
        done
    )
}
if [ -f "$depth" ]; then # that of the only photo
    above=$(dirname "$depth"); units=; [ ! -e "$above/depth.txt" ] || units=$(cksum <"$above/depth.txt")
    sed '/^#/d' "$folder/photos/list.txt" | sed -n 1p | while read -r id _; do echo "$id $(cksum <"$depth") ${depth##*/} $units"; done
elif [ -n "$depth" ]; then
    units=$(cd "$depth" && { [ ! -e depth.txt ] || cksum depth.txt; })
    maps "$depth" "$folder/photos/list.txt" | sed "s|\$| $units|"
fi | stamps "$folder/stamp/given"
