#!/usr/bin/env bash
# new_scene.sh FOLDER GOAL - the scene.mk and scene.cfg of a new scene, from what the user gave to make. A scene whose first
# goal is one of rooms is a room: plain make then makes all of its products, and no film.
set -euo pipefail
folder=$1 goal=$2
products=${REMODEL_PRODUCTS:-parallax}
case $goal in
axes | suggest | model | ids | vdta | vita | textures | outdoors | remodel | tour-path | tour | exports | lights | materials | irradiance | relight | relit-tour | lri)
    [ "$products" != parallax ] || products="model textures remodel tour relight" ;;
esac
mkdir -p "$folder"
for_make() { sed -e 's/\$/$$/g' -e 's/#/\\#/g' <<<"$1"; }
{
    echo "# What this scene is made from. Every variable of \`make help\` may stand here; the command line wins."
    echo "PHOTOS := $(for_make "$REMODEL_PHOTOS")"
    for v in $REMODEL_PASSED; do
        given=REMODEL_$v
        case $v in PHOTOS | EXCLUDE | EFFECT*) continue ;; esac
        [ -z "${!given-}" ] || echo "$v := $(for_make "${!given}")"
    done
    echo "# photos to leave out, by id or file name; names with blanks in quotes"
    echo "EXCLUDE := $(for_make "${REMODEL_EXCLUDE-}")"
    echo "PRODUCTS := $products"
} >"$folder/.scene.mk.tmp"
[ -e "$folder/scene.cfg" ] || {
    [ -z "${REMODEL_LENS-}" ] || printf '[sfm]\ncamera_model = %s\n\n' "$REMODEL_LENS"
    echo "# Overrides of configs/default.cfg for this scene alone, a section a stage. For example:"
    echo "#"
    echo "# [sfm]"
    echo "# camera_model = OPENCV"
} >"$folder/scene.cfg"
mv "$folder/.scene.mk.tmp" "$folder/scene.mk"
echo "made $folder/scene.mk and scene.cfg"
