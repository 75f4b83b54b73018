# run.sh - what the light of edits will take. Sourced by common/run/run_scene.sh.

# of commands, one a line, each of an edit
estimate_update_vita()
{
    local model=$O/model/model.txt
    "$bin/update_vita" --config "$O/slice/update_vita.cfg" --model "$model" --edited "$model" --map "$O/model/texture.txt" \
        --axes "$O/model/axes.txt" --vita "$O/vita" --out "$O/relight" --estimate "$(grep -c .)"
}
