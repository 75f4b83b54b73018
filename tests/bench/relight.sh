# relight.sh - pictures of edits in the light that they make: error against what is true, by the target of the gathers.
#
# On the described scene BENCH_SCENE (loft), with the photographs and the truth that `make bench-vdta` keeps in
# out/bench/vdta/SCALE, which that bench makes first if they are not there (long). Added to the truth: lighting reference
# images; and of each edit of scenes/SCENE/edits that has a scene-E.txt (loft: six edits, two objects) and of the unedited
# room, pictures of the four photos and of their irradiance, at 64 and 256 samples. update_vita runs once for each edit.
#
# A row relights the views of the four photos after one edit, with one target_error of relight, the relative error of the
# ratio of light at which a gather ends. unlit_psnr, psnr (relit_psnr), gain and ratio_error50 are those of
# docs/evaluation.md, over pixels that show the same surface before and after and whose light changes by more than 5 %;
# _model: on surfaces of the model, without furniture; revealed_psnr: what the edit reveals. core_s: CPU time for 800 x 600
# pixels. update_s: seconds of update_vita before, with BENCH_THREADS (1) threads.
#
# BENCH_EDITS names edits, BENCH_TARGETS ("0.1 0.05 0.02 0.01") targets, BENCH_PHOTOS photos. BENCH_SCALE is the size of the
# photos (1), BENCH_EDIT_SAMPLES (64) and BENCH_LIGHT_SAMPLES (256) the samples of pictures and of irradiance.
BENCH_HELDOUT='' . "${BENCHES:-tests/bench}/vdta.sh"
title="Edits in the light that they make: PSNR against time"
note="Upper left is better. Over surfaces that stay and whose light the edit changes."
baseline=
match=
repeats=1 # pictures repeat exactly
timed="core_s update_s"
x=core_s x_label="Core-seconds for 800 x 600 pixels" y=psnr y_label="PSNR (dB)"
line=series label=target panel=kind
edit_samples=${BENCH_EDIT_SAMPLES:-64}
light_samples=${BENCH_LIGHT_SAMPLES:-256}
targets=${BENCH_TARGETS:-0.1 0.05 0.02 0.01}
room=$kept/project/out/room+draft
edits() { local e; for e in ${BENCH_EDITS:-$(find "$described/edits" -name '*.txt' -printf '%f\n' | sed 's/\.txt$//' | LC_ALL=C sort)}; do [ ! -e "$described/scene-$e.txt" ] || echo "$e"; done; }
photos() { echo "${BENCH_PHOTOS:-$shell_photos}"; }

prepare()
{
    local e v
    for v in render_model bake_outdoors fit_lights update_vita relight; do [ -x "$B/bin/$v" ] || missing "the program $B/bin/$v is missing."; done
    prepare_room
    prepare_light
    made SCENE=room textures outdoors
    [ ! -e "$described/lights.txt" ] || made SCENE=room lights
    for v in $(photos); do lit "" "$v"; done
    for e in $(edits); do
        for v in $(photos); do shown "$e" "$v"; lit "$e" "$v"; done
        prepare_edit "$e"
    done
}

# lamps that are marked in the photos, and lighting reference images
prepare_light()
{
    local to=$kept/project/scenes/room v
    [ ! -e "$described/lights.txt" ] || scaled "$described/lights.txt" >"$to/lights.txt"
    grep -q '^reference ' "$described/cameras.txt" || return 0
    for v in $(awk '$1 == "reference" { print $2 }' "$described/cameras.txt"); do
        [ -e "$kept/room/lri/${v}_e0.jpg" ] || simulated --scene "$described" --out "$kept/room" --photo "$v" --set "samples=$edit_samples"
    done
    printf 'LRI := %s\nLRI_SFM := %s\n' "$kept/room/lri" "$kept/room/truth/lri" >>"$to/scene.mk"
    made SCENE=room lri
}
# the truth of a photo after an edit, and its irradiance; without an edit, of the room as it is
shown() # EDIT PHOTO
{
    [ -e "$kept/room/truth/edited-$1/hdr/$2.exr" ] ||
        simulated --scene "$described" --out "$kept/room" --edit "$1" --photo "$2" --set "samples=$edit_samples" --set "truth_samples=$edit_samples"
}
lit() # EDIT PHOTO
{
    [ -e "$kept/room/truth/${1:+edited-$1/}irradiance/$2.exr" ] ||
        simulated --scene "$described" --out "$kept/room" ${1:+--edit "$1"} --photo "$2" --kind irradiance --set "samples=$light_samples" --set "truth_samples=$light_samples"
}

views_of() { local p f; for p in $(photos); do for f in "$room/views/$p.exr" "$room/views/$p"@*.exr; do [ ! -e "$f" ] || { f=${f##*/}; echo "$1" "${f%.exr}"; }; done; done; }
# what update_vita and relight read of an edit, one word a line
change_args() # EDIT
{
    local lights=$room/lights/lights.txt
    printf '%s\n' --model "$room/model/model.txt" --edited "$room/remodel/$1/model.txt" --map "$room/remodel/$1/texture.txt" --axes "$room/model/axes.txt" \
        --vita "$room/vita" --outdoors "$room/outdoors/outdoors.exr" --objects "$room/remodel/$1/objects.txt" --scene "$described" --things "$room/things"
    [ ! -e "$lights" ] || printf '%s\n' --lights "$lights"
    [ ! -d "$kept/project/out/room/lri" ] || printf '%s\n' --references "$kept/project/out/room/lri"
}
# the views before they are relit, and the light of the edit, with its time
prepare_edit() # EDIT
{
    local change views
    mapfile -t change < <(change_args "$1")
    mapfile -t views < <(views_of --view | tr ' ' '\n')
    quietly "$B/bin/render_model" --views "$room/views" --depth "$room/depth/model" --things "$room/things" --vdta "$room/vdta" --vita "$room/vita" --ids "$room/ids" --outdoors "$room/outdoors/outdoors.exr" \
        --axes "$room/model/axes.txt" --model "$room/remodel/$1/model.txt" --base "$room/model/model.txt" --map "$room/remodel/$1/texture.txt" \
        "${views[@]}" --set radiance=all --out "$fast/unlit/edited-$1"
    measured "$B/bin/update_vita" --threads "$threads" "${change[@]}" --out "$fast/light/$1" >"$fast/update-$1" || { tail -n 5 "$work/err" >&2; missing "update_vita failed."; }
}

settings()
{
    local e t kind
    printf 'series\tscene\tkind\ttarget\n'
    for e in $(edits | grep -v '^object') $(edits | grep '^object'); do
        case $e in object*) kind=objects ;; *) kind=rooms ;; esac
        for t in $targets; do printf '%s\t%s\t%s\t%s\n' "$e" "$scene" "$kind" "$t"; done
    done
}

sample() # EDIT SCENE KIND TARGET
{
    local change pictures
    mapfile -t change < <(change_args "$1")
    mapfile -t pictures < <(views_of --picture | tr ' ' '\n')
    rm -rf "$fast/row"; mkdir -p "$fast/row/rendered"
    ln -s "$(realpath "$room")"/{views,model,ids,remodel} "$fast/row/"
    measured "$B/bin/relight" --threads "$threads" "${change[@]}" --relit "$fast/light/$1" --views "$room/views" --ids "$room/ids" --depth "$room/depth/model" \
        --pictures "$fast/unlit/edited-$1" "${pictures[@]}" --set "target_error=$4" --out "$fast/row/rendered/relit-$1" >"$fast/time" || return
    ln -s "$fast/unlit/edited-$1" "$fast/row/rendered/edited-$1"
    "$B/bin/evaluate" --folder "$fast/row" --shared "$kept/project/out/room" --truth "$kept/room/truth" --rendered "$fast/row/rendered" --out "$fast/row/metrics.tsv" 2>"$work/err" || return
    grep -E '^(seconds|peak_mib) ' "$fast/time"
    awk '$1 == "seconds" { print "update_s", $2 }' "$fast/update-$1"
    local pixels; pixels=$(awk '$1 == "size" { n += $2 * $3 } END { print n / (800 * 600) }' "$fast/row/rendered/relit-$1"/*.txt)
    awk -F'\t' -v of="edited.$1." -v pictures="$pixels" '
        FNR == NR { split($0, t, " "); time[t[1]] = t[2]; next }
        index($1, of) != 1 { next }
        { name = substr($1, length(of) + 1) }
        name == "unlit_psnr" { printf "unlit_psnr %.5g\n", $2 }
        name ~ /^relit_(psnr|gain|ratio_error50|revealed_psnr)(_model)?$/ { printf "%s %.5g\n", substr(name, 7), $2 }
        END { printf "core_s %.4g\n", time["cpu_seconds"] / pictures }' "$fast/time" "$fast/row/metrics.tsv"
}
