#!/usr/bin/env bash
# look_lri.sh BIN S - records of the lighting reference images in S/lri/photos, and in S/stamp/lri.txt what gives their cameras.
set -euo pipefail
bin=$1 folder=$2
. common/run/keep.sh

common/run/run_stage.sh silent import_photos lri "$folder" "$bin/import_photos" --config "$folder/slice/import_photos.cfg" \
    --photos "$REMODEL_LRI" --scene "$REMODEL_LRI" --like "$folder/photos" --out "$folder/lri/photos"
grep -h warning: "$folder/log/import_photos.lri.log" >&2 || true
{
    frame=${REMODEL_LRI_FRAME:-photos}
    # the lens alone is read of images whose pose is marked
    [ -z "${REMODEL_LRI_SFM-}" ] || (cd "$REMODEL_LRI_SFM" && cksum cameras.txt && { [ "$frame" = corners ] || cksum images.txt; })
    [ -z "${REMODEL_LRI_SFM-}" ] && [ "$frame" != corners ] || echo "frame $frame"
} | keep "$folder/stamp/lri.txt"
