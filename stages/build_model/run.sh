# run.sh - the solid model, its edits, and their edges on the photographs. Sourced by common/run/run_scene.sh.

check_build_model()
{
    case $goal in
    model | ids | vdta | vita | textures | outdoors | remodel | tour-path | tour | exports) ;;
    all | report) case " $REMODEL_PRODUCTS " in *" model "* | *" textures "* | *" remodel "*) ;; *) return 0 ;; esac ;;
    *) return 0 ;;
    esac
    [ ! -e "$folder/model.txt" ] || return 0
    # a new scene is kept, so that make suggest SCENE=NAME finds it
    [ "$dry" = n ] || [ -e "$folder/scene.mk" ] || [ ! -d "${REMODEL_PHOTOS-}" ] || common/run/new_scene.sh "$folder" "$goal"
    usage "make $goal wants $folder/model.txt, the script of the model (docs/model-script.md). make suggest $again writes a first one, $O/model/suggested.txt, for you to correct and copy there."
}

run_model()
{
    one model
    farm build_model overlays
    farm build_model edit-overlays # copies of these where a photo shows no difference
}
