# run.sh - COLMAP once more, on request. Sourced by common/run/run_scene.sh.

run_resfm()
{
    one -W "$S/photos/list.txt" sfm
    echo "make $again goes on from the new camera poses."
}

# names the photos and masks that are not what SfM saw
report_changed_photos()
{
    local changed
    [ -e "$S/sfm/photos.txt" ] && [ -z "${REMODEL_SFM-}" ] || return 0
    changed=$(awk 'FNR == 1 { f = FILENAME; sub(/.*\//, "", f); sub(/\.txt$/, "", f) }
        FILENAME ~ /sfm\/photos\.txt$/ { saw[$1] = $2; next }
        $1 == "hash" && f in saw && saw[f] != $2 { print f }' "$S/sfm/photos.txt" "$S"/photos/*.txt | tr '\n' ' ')
    [ ! -e "scenes/$scene/masks" ] ||
        changed+=$(find "scenes/$scene/masks" -name '*.png' -newer "$S/sfm/models.txt" -printf 'masks/%P ' | tr ' ' '\n' | LC_ALL=C sort | tr '\n' ' ')
    [ -z "${changed// /}" ] ||
        echo "Changed since the camera poses were found: ${changed# }- the poses are kept; make resfm $again finds them anew."
}

dry_sfm() { [ "$goal" != resfm ] || { first=(-W "$S/photos/list.txt"); goal=sfm; }; }
