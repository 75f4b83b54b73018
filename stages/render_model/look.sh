#!/usr/bin/env bash
# look.sh BIN S O - the cameras that CAMERAS names, and their frame, in O/stamp/cameras.txt.
set -euo pipefail
. common/run/keep.sh
if [ -n "${REMODEL_CAMERAS-}" ]; then
    echo "frame ${REMODEL_CAMERAS_FRAME:-scene}"
    find -L "$REMODEL_CAMERAS" -maxdepth 1 -type f \( -name '*.txt' -o -name '*.json' \) -exec cksum {} + | LC_ALL=C sort
else echo "no cameras"; fi | keep "$3/stamp/cameras.txt"
