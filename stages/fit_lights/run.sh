# run.sh - what fitting lamps will take. Sourced by common/run/run_scene.sh.

estimate_fit_lights()
{
    local lamps=()
    [ ! -e "$S/lights.txt" ] || lamps=(--lamps "$S/lights.txt")
    "$bin/fit_lights" --config "$O/slice/fit_lights.cfg" --model "$O/model/model.txt" --plan "$O/model/plan.txt" \
        --axes "$O/model/axes.txt" --views "$O/views" --ids "$O/ids" "${lamps[@]}" --out "$O/lights" --estimate
}
