#!/usr/bin/env bash
# look.sh BIN S - the depth files of DEPTH, or of the model in SFM, in S/stamp/given, each with the checksum of the file that gives their units. Which view
# a file belongs to is known only when there are views.
set -euo pipefail
folder=$2
. common/run/keep.sh
depth=${REMODEL_DEPTH-}
[ -n "$depth" ] || [ ! -d "$folder/sfm_depth" ] || depth=$folder/sfm_depth
if [ -n "$depth" ]; then
    units=$(cd "$depth" && { [ ! -e depth.txt ] || cksum depth.txt; })
    sums "$depth" "$folder/photos/list.txt" exr png | sed "s|\$| $units|"
fi | stamps "$folder/stamp/given"
