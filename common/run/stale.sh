#!/usr/bin/env bash
# stale.sh frames|views FOLDER NAME... -- PREREQUISITE... - of the products FOLDER/NAME.exr those that are missing or not newer, as
# options of their stage: frames by number, "3,4,12"; views by name, "--view a --view b".
set -euo pipefail
kind=$1 folder=$2; shift 2
products=()
while [ "$1" != -- ]; do products+=("$folder/$1.exr"); shift; done
shift
newest=$1
for p in "$@"; do [ ! "$p" -nt "$newest" ] || newest=$p; done
stale=()
for f in "${products[@]}"; do [ -e "$f" ] && [ ! "$newest" -nt "$f" ] || stale+=("$f"); done
[ "${#stale[@]}" -gt 0 ] || stale=("${products[@]}") # make saw a change that time stamps do not tell: all of them
out=
for f in "${stale[@]}"; do
    n=${f##*/}; n=${n%.exr}
    case $kind in
    frames) out+=${out:+,}$((10#$n)) ;;
    views) out+=${out:+ }"--view $n" ;;
    esac
done
echo "$out"
