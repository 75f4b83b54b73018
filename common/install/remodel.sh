#!/usr/bin/env bash
# remodel - runs scenes in the present folder, which becomes a project: it gets links to what is installed, scenes/ and out/.
set -euo pipefail
lib=@LIB@
links=(Makefile common configs stages)

usage()
{
    cat <<'TEXT'
remodel: from a folder of photographs to a 3D pan & scan video, or to a solid model of a room

    remodel SCENE=NAME PHOTOS=DIR      a new scene: its video and a page come under out/NAME
    remodel SCENE=NAME [GOAL]...       goes on, or makes a goal
    remodel help                       all goals and variables
    remodel run STAGE ARGUMENT...      one program of a stage, with --help what it takes
    remodel version

The present folder becomes a project: it gets links to what is installed (Makefile, common, configs, stages) and the folders
scenes and out. Then plain make does the same in it. Read `man remodel`.
TEXT
}
die() { echo "remodel: $*" >&2; exit 2; }

case ${1-} in
'' | -h | --help) usage; exit 0 ;;
version | --version) echo "remodel @VERSION@"; exit 0 ;;
help) exec make -s --no-print-directory -C "$lib" help ;;
run)
    [ $# -ge 2 ] || die "run wants the name of a stage: $(cd "$lib/stages" && echo *)"
    [ -x "$lib/build/bin/$2" ] || die "$2 is not a stage. The stages are: $(cd "$lib/stages" && echo *)"
    exec "$lib/build/bin/${*:2:1}" "${@:3}" ;;
esac
[[ " $*" == *" SCENE="?* ]] || die "give the scene to work on: remodel SCENE=NAME ${*:-PHOTOS=DIR} (remodel --help says more)."
[ "$PWD" != / ] || die "the root folder does not become a project. Make a folder for it and go there."
for l in "${links[@]}"; do
    [ -L "$l" ] || [ ! -e "$l" ] || die "$PWD has a $l of its own, where a project has a link to $lib/$l. Run remodel in another folder$([ ! -e common/base ] || echo '; in its source tree run make')."
done
for l in "${links[@]}"; do [ "$(readlink "$l" || true)" = "$lib/$l" ] || ln -sfn "$lib/$l" "$l"; done
mkdir -p scenes out/build
[ -L out/build/release ] || [ ! -e out/build/release ] || die "out/build/release is a folder, where a project has a link to $lib/build. Move it away."
[ "$(readlink out/build/release || true)" = "$lib/build" ] || ln -sfn "$lib/build" out/build/release
exec make --no-print-directory "$@"
