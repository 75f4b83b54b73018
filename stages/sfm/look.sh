#!/usr/bin/env bash
# look.sh BIN S - what SfM starts from, in S/stamp/sfm_source.txt: COLMAP by its version, or the files of the model in SFM. Whether
# that model's points serve the photos, or the photos are matched to find others, in S/stamp/sfm_points.txt. Links to the depth maps
# that the model names are in S/sfm_depth, which is missing if there are none.
set -euo pipefail
bin=$1 folder=$2
. common/run/keep.sh
{
    if [ -n "${REMODEL_SFM-}" ]; then
        (cd "$REMODEL_SFM" && find . -type f \( -name '*.txt' -o -name '*.bin' -o -name '*.out' -o -iname '*.lst' -o -name '*.json' -o -iname '*.xml' -o -iname '*.csv' \) -print0 | LC_ALL=C sort -z | xargs -0r cksum)
    else
        colmap help 2>/dev/null | sed -n 1p
    fi
    [ -z "${REMODEL_SPLIT-}" ] || grep '^grid ' "$folder/split/split.txt"
} | keep "$folder/stamp/sfm_source.txt"
[ -n "${REMODEL_SFM-}" ] || { rm -rf "$folder/sfm_depth"; exit 0; }
# a large model takes seconds to read, so it is judged again only if it, the photos or the program changed
judged=$(cat "$folder/stamp/sfm_source.txt" "$folder/photos/list.txt" "$bin/sfm" | cksum)
[ "$(sed -n 2p "$folder/stamp/sfm_points.txt" 2>/dev/null)" != "$judged" ] || exit 0
# what is wrong with the model is said when it is imported, before which no photo needs to be matched
words=$("$bin/sfm" --records "$folder/photos" --model "$REMODEL_SFM" --judge --depth "$folder/sfm_depth" 2>/dev/null) || words=enough
keep_text "$folder/stamp/sfm_points.txt" "$words"$'\n'"$judged"$'\n'
