# run.sh - what atlases of all faces will take. Sourced by common/run/run_scene.sh.

# of commands, one a line, all of them bake an atlas
estimate_bake_vita()
{
    "$bin/bake_vita" --config "$O/slice/bake_vita.cfg" --model "$O/model/model.txt" --axes "$O/model/axes.txt" --views "$O/views" \
        --ids "$O/ids" --out "$O/vita" --estimate "$(grep -c .)"
}
