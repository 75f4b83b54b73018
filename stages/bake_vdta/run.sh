# run.sh - what bakes of viewpoints will take. Sourced by common/run/run_scene.sh.

# of commands, one a line, the photos of those that bake
estimate_bake_vdta()
{
    grep -oE -- ' bake_vdta .* --photo [^ ]+' | sed 's/.* --photo //' >"$work/photos.list"
    "$bin/bake_vdta" --config "$O/slice/bake_vdta.cfg" --views "$O/views" --model "$O/model/model.txt" --axes "$O/model/axes.txt" \
        --ids "$O/ids" --reveal "$O/reveal" --out "$O/vdta" --estimate "$work/photos.list"
}
