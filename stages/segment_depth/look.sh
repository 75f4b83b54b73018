#!/usr/bin/env bash
# look.sh BIN S - the depth files of DEPTH, in S/stamp/given, each with the checksum of the file that gives their units. Which view
# a file belongs to is known only when there are views.
set -euo pipefail
folder=$2
. common/run/keep.sh
if [ -n "${REMODEL_DEPTH-}" ]; then
    units=$(cd "$REMODEL_DEPTH" && { [ ! -e depth.txt ] || cksum depth.txt; })
    sums "$REMODEL_DEPTH" "$folder/photos/list.txt" exr png | sed "s|\$| $units|"
fi | stamps "$folder/stamp/given"
