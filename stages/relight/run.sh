# run.sh - relit pictures, and the page that shows them. Sourced by common/run/run_scene.sh.

run_relight()
{
    farm relight relight
    if [ -n "${REMODEL_CAMERAS-}" ]; then echo "pictures  $O/relight/*/cameras"; return; fi
    echo "pictures  $O/relight/*/*.jpg"
    # plain make writes the page at its end
    if [ "$goal" != relight ] || [ ! -e "$O/remodel/index.html" ]; then return; fi
    one remodel-page
    echo "page   $O/remodel/index.html"
}
