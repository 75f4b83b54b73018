#!/usr/bin/env bash
# look.sh STAMP - names, sizes and times of the truth's files, into STAMP.
set -euo pipefail
. common/run/keep.sh
if [ -n "${REMODEL_TRUTH-}" ]; then
    find -L "$REMODEL_TRUTH" -type f -printf '%P %s %T@\n' | LC_ALL=C sort
else
    echo "no truth"
fi | keep "$1"
