# run.sh - frames of films. Sourced by common/run/run_scene.sh.

# here a film is whole, video included, before the next one begins; a cluster gets all of their frames at once
run_frames()
{
    local films=("${effects[@]}") effect
    if [ "$jobs" = slurm ]; then farm_frames render_views frames; return; fi
    for effect in "${films[@]}"; do
        effects=("$effect")
        farm_frames render_views frames
        [ "$goal" = frames ] || one video
    done
    effects=("${films[@]}")
}
