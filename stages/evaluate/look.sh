#!/usr/bin/env bash
# look.sh BIN S O - names, sizes and times of the truth's files, in O/stamp/truth.txt, and of rendered pictures to measure, in
# O/stamp/rendered.txt.
set -euo pipefail
own=$3 rendered=${REMODEL_RENDERED:-$3/rendered}
. common/run/keep.sh
files() { find -L "$1" -type f -printf '%P %s %T@\n' | LC_ALL=C sort; }
if [ -n "${REMODEL_TRUTH-}" ]; then files "$REMODEL_TRUTH"; else echo "no truth"; fi | keep "$own/stamp/truth.txt"
if [ -n "${REMODEL_TRUTH-}" ] && [ -d "$rendered" ]; then files "$rendered"; else echo "no pictures"; fi | keep "$own/stamp/rendered.txt"
