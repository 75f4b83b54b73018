#!/usr/bin/env bash
# look.sh BIN S - what SfM starts from, in S/stamp/sfm_source.txt: COLMAP by its version, or the files of the model in SFM.
set -euo pipefail
folder=$2
. common/run/keep.sh
{
    if [ -n "${REMODEL_SFM-}" ]; then
        (cd "$REMODEL_SFM" && find . -type f \( -name '*.txt' -o -name '*.bin' -o -name '*.out' \) -print0 | LC_ALL=C sort -z | xargs -0r cksum)
    else
        colmap help 2>/dev/null | sed -n 1p
    fi
    [ -z "${REMODEL_SPLIT-}" ] || grep '^grid ' "$folder/split/split.txt"
} | keep "$folder/stamp/sfm_source.txt"
