#!/usr/bin/env bash
# look.sh TRUTH_STAMP RENDERED_STAMP FOLDER - names, sizes and times of the truth's files, and of the rendered pictures in FOLDER.
set -euo pipefail
. common/run/keep.sh
files() { find -L "$1" -type f -printf '%P %s %T@\n' | LC_ALL=C sort; }
if [ -n "${REMODEL_TRUTH-}" ]; then files "$REMODEL_TRUTH"; else echo "no truth"; fi | keep "$1"
if [ -n "${REMODEL_TRUTH-}" ] && [ -d "$3" ]; then files "$3"; else echo "no pictures"; fi | keep "$2"
