# run.sh - photographs a described scene, before its photos can be read. Sourced by common/run/run_scene.sh.

check_simulate()
{
    [ "$goal" = edited ] || return 0
    local edit
    [ -n "$REMODEL_EDIT$REMODEL_EDITS" ] || usage "make edited wants EDIT=E, where $folder/scene-E.txt describes the edited scene, EDITS=\"A B\" or EDITS=all."
    for edit in $REMODEL_EDIT $REMODEL_EDITS; do
        [ "$edit" = all ] || [ -e "$folder/scene-$edit.txt" ] || usage "EDITS: there is no $folder/scene-$edit.txt"
    done
}

# tell_time TARGET: before pictures are made, how long each kind of them takes
tell_time()
{
    graph -q "$1" >/dev/null 2>&1 || "$bin/simulate" --threads "$cores" --config "$S/slice/simulate.cfg" --scene "$folder" --out "$S/simulated" --estimate 2>/dev/null
}

prepare_simulate()
{
    [ -e "$folder/scene.txt" ] || return 0
    if [ "$dry" = n ] || [ "$goal" = why ]; then
        [ -e "$S/simulated/photos.mk" ] || { echo "# nothing is known before the scene is simulated: make SCENE=$scene"; exit 0; }
        return 0
    fi
    slices "$S" simulate
    one "$S/simulated/photos.mk"
    case $goal in
    edited)
        one edited-texts
        tell_time edited
        farm simulate edited
        echo "truth  $S/simulated/truth/edited-*"
        exit 0 ;;
    truth)
        tell_time truth
        farm simulate truth
        echo "truth  $S/simulated/truth"
        exit 0 ;;
    esac
    tell_time simulated
    farm simulate simulated
}
