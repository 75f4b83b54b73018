#!/usr/bin/env bash
# stale.sh FRAME.exr... -- PREREQUISITE... - the numbers of the frames that are missing or not newer, as "3,4,12".
set -euo pipefail
frames=()
while [ "$1" != -- ]; do frames+=("$1"); shift; done
shift
newest=$1
for p in "$@"; do [ ! "$p" -nt "$newest" ] || newest=$p; done
out=
for f in "${frames[@]}"; do
    if [ ! -e "$f" ] || [ "$newest" -nt "$f" ]; then
        n=${f##*/}; n=${n%.exr}
        out+=${out:+,}$((10#$n))
    fi
done
if [ -z "$out" ]; then # make saw a change that time stamps do not tell: all of them
    for f in "${frames[@]}"; do n=${f##*/}; n=${n%.exr}; out+=${out:+,}$((10#$n)); done
fi
echo "$out"
