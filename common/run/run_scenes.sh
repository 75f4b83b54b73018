#!/usr/bin/env bash
# run_scenes.sh QUALITY SCENES MAKE... - runs the scenes that the project carries, one after the other, and says where to
# look and how to go on. A scene that fails does not keep the others from running.
set -uo pipefail
quality=$1
read -ra scenes <<<"$2"
shift 2
failed=() n=0
for s in "${scenes[@]}"; do
    echo "scene $((++n)) of ${#scenes[@]}: $s, QUALITY=$quality"
    "$@" SCENE="$s" QUALITY="$quality" || failed+=("$s")
done
[ ${#scenes[@]} = 0 ] || echo
common/run/explain.sh no-scene
[ ${#failed[@]} = 0 ] || { echo "Failed: ${failed[*]}; the reasons are above." >&2; exit 2; }
