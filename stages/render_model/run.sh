# run.sh - pictures and films of the remodelled rooms. Sourced by common/run/run_scene.sh.

check_render_model()
{
    [ -z "${REMODEL_CAMERAS-}" ] || [ -n "$given" ] || [ -e "$REMODEL_CAMERAS/images.txt" ] ||
        usage "CAMERAS=$REMODEL_CAMERAS has no images.txt. Give a folder with cameras.txt and images.txt, COLMAP's text format."
    case ${REMODEL_CAMERAS_FRAME:-scene} in
    scene | model) ;;
    truth) [ -d "${REMODEL_TRUTH-}" ] || usage "CAMERAS_FRAME=truth wants TRUTH=DIR, whose images.txt has the photos in the same frame." ;;
    *) usage "CAMERAS_FRAME=$REMODEL_CAMERAS_FRAME: wanted scene, model or truth." ;;
    esac
    case $goal in remodel | tour) ;; *) return 0 ;; esac
    [ -z "$REMODEL_EDIT" ] || [ -e "$folder/edits/$REMODEL_EDIT.txt" ] || usage "EDIT=$REMODEL_EDIT: there is no $folder/edits/$REMODEL_EDIT.txt."
}

# of commands, one a line, the pictures of those that draw
estimate_render_model()
{
    awk '{ line = "process"; for (i = 1; i < NF; i++) if ($i == "--view") line = line " " $(i + 1); print line }' >"$work/drawn.list"
    "$bin/render_model" --config "$O/slice/render_model.cfg" --model x --axes x --vdta x --vita x --views "$O/views" --out "$O/remodel" \
        --estimate "$work/drawn.list"
}

run_remodel()
{
    farm render_model remodel
    if [ -n "${REMODEL_CAMERAS-}" ]; then echo "pictures  $O/model/cameras, $O/remodel/*/cameras"; else
        one remodel-page
        echo "page   $O/remodel/index.html"
    fi
}

run_tour()
{
    farm_frames render_model tour-frames
    one tour
}
