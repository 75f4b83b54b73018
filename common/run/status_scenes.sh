#!/usr/bin/env bash
# status_scenes.sh - `make status` without a scene: how the run of each scene goes, or how its last one ended.
set -euo pipefail
shopt -s nullglob
. common/run/run_record.sh
found=
for S in out/*/; do
    S=${S%/}
    [ -e "$S/log/run.txt" ] || continue
    found=yes
    say_run "${S##*/}"
done
[ -n "$found" ] || echo "No run has begun. make PHOTOS=DIR SCENE=NAME makes a scene."
