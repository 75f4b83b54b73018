#!/usr/bin/env bash
# help.sh MAKEFILE... - the text of `make help`: targets and variables, from the comments of the makefiles, and the scenes.
#
# A target is "NAME: ... ## TEXT" or a stage's "HELP.NAME := TEXT"; a variable is "## NAME=...: TEXT".
set -euo pipefail
echo "remodel: from a folder of photographs to a 3D pan & scan video, or to a solid model of a room"
echo
echo "targets"
{
    sed -nE 's/^([a-z_%-]+):[^#]*## (.*)/\1\t\2/p' "$@" | sed -n '1p'
    sed -nE 's/^HELP\.([a-z_-]+) *:?= *(.*)/\1\t\2/p' "$@"
    sed -nE 's/^([a-z_%-]+):[^#]*## (.*)/\1\t\2/p' "$@" | sed '1d'
} | awk -F'\t' '{ sub(/%/, "NAME", $1); printf "  %-14s %s\n", $1, $2 }'
echo "variables"
sed -nE 's/^## ([A-Z_]+=[^:]*): (.*)/\1\t\2/p' "$@" | awk -F'\t' '{ printf "  %-28s %s\n", $1, $2 }'
echo "scenes"
found=
for s in scenes/*/scene.mk; do
    [ -e "$s" ] || continue
    found=1
    printf '  %-28s %s\n' "$(basename "$(dirname "$s")")" "$(sed -nE '/^PHOTOS *:?= */{ s///p; q; }' "$s")"
done
[ -n "$found" ] || echo "  none yet: make PHOTOS=DIR SCENE=NAME makes one"
