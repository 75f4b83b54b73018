# run.sh - relit pictures, and the page that shows them. Sourced by common/run/run_scene.sh.

# of commands, one a line, the pictures of those that relight
estimate_relight()
{
    awk '{ line = "process"; for (i = 1; i < NF; i++) if ($i == "--picture") line = line " " $(i + 1); print line }' >"$work/relit.list"
    "$bin/relight" --config "$O/slice/relight.cfg" --views "$O/views" --out "$O/relight" --estimate "$work/relit.list"
}

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
