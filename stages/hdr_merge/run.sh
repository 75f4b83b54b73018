# run.sh - merges exposures before anything sees the photos. Sourced by common/run/run_scene.sh.

# after the photos have been read
look_hdr_merge()
{
    [ "$goal" = lri ] || return 0
    [ -n "${REMODEL_LRI-}" ] && [ -d "$REMODEL_LRI" ] ||
        usage "make lri wants LRI=DIR, the folder of the lighting reference images${REMODEL_LRI:+; $REMODEL_LRI is not a folder}."
    [ -z "${REMODEL_LRI_SFM-}" ] || [ -d "$REMODEL_LRI_SFM" ] ||
        usage "LRI_SFM=$REMODEL_LRI_SFM is not a folder. Give the folder that holds cameras.txt and images.txt of the lighting reference images (for LRI_FRAME=corners cameras.txt only)."
    case ${REMODEL_LRI_FRAME:-photos} in
        photos | scene | model) ;;
        corners)
            [ -e "$folder/lri.txt" ] ||
                usage "LRI_FRAME=corners wants $folder/lri.txt, with lines \"corner IMAGE OPENING left|right bottom|top X Y\" (docs/formats.md, S/lri)."
            [ -e "$folder/model.txt" ] ||
                usage "LRI_FRAME=corners wants $folder/model.txt, the script of the model that has these corners (docs/model-script.md)."
            ;;
        *) usage "LRI_FRAME=$REMODEL_LRI_FRAME: wanted photos, scene or model, the frame of the poses in LRI_SFM, or corners, for images whose pose is found from marks in $folder/lri.txt." ;;
    esac
    [ "${REMODEL_LRI_FRAME-}" = corners ] || [ ! -e "$folder/lri.txt" ] ||
        echo "warning: $folder/lri.txt is not read; set LRI_FRAME=corners to place the images by its marks." >&2
    stages/hdr_merge/look_lri.sh "$bin" "$S"
}

# the response curve comes before the merges are planned
find_response()
{
    [ -e "$S/photos/brackets.txt" ] || return 0
    # a curve that was deleted is found anew
    [ -e "$S/hdr/response.txt" ] || rm -f "$S/stamp/response.txt"
    one response
}

run_hdr()
{
    [ -e "$S/photos/brackets.txt" ] || return 0
    find_response
    farm hdr_merge hdr
}

run_lri()
{
    find_response
    farm hdr_merge lri
    echo "light  $S/lri"
}
