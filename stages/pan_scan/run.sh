# run.sh - the move in 2D, on request; once it was made, later runs keep it as new as the rest. Sourced by
# common/run/run_scene.sh.

run_pan_scan()
{
    local films=("${effects[@]}") effect
    if [ "$goal" != pan_scan ]; then
        effects=()
        for effect in "${films[@]}"; do [ ! -e "$O/parallax/$effect/pan_scan/video.mp4" ] || effects+=("$effect"); done
    fi
    if [ "${#effects[@]}" -gt 0 ]; then
        farm_frames pan_scan pan_frames
        one pan_scan
    fi
    effects=("${films[@]}")
}
