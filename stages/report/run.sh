# run.sh - the page of a scene. Sourced by common/run/run_scene.sh.

# The page of the scene and that of its remodelled rooms link to each other: which of them exist, or will after this run
look_report()
{
    local scene_page=no remodel_page=no
    if [ -e "$O/index.html" ]; then scene_page=yes; fi
    if [ -e "$O/remodel/index.html" ]; then remodel_page=yes; fi
    case $goal in all | report)
        scene_page=yes
        case " $REMODEL_PRODUCTS " in *" remodel "*) remodel_page=yes ;; esac ;;
    remodel) if [ -z "${REMODEL_CAMERAS-}" ]; then remodel_page=yes; fi ;;
    esac
    common/run/keep.sh "$O/stamp/scene-page.txt" "$scene_page"
    common/run/keep.sh "$O/stamp/remodel-page.txt" "$remodel_page"
}

end_report() { case $goal in report | video | pan_scan | morph) [ ! -e "$O/index.html" ] || echo "page   $O/index.html" ;; esac; }
