# remodel.sh - pictures of remodelled rooms and of new views: error against what is true.
#
# On the described scene BENCH_SCENE (loft), with the photographs and the truth that `make bench-vdta` keeps in
# out/bench/vdta/SCALE, which that bench makes first if they are not there (long). Added to the truth: the witnesses, and
# each edit from four photos and the witnesses at 64 samples. Rows, each timed:
#   edit E          the views of these photos after edit E of scenes/SCENE/edits; psnr: over what the edit reveals, after one
#                   gain for each face (edited.E.revealed_psnr); revealed_things_psnr: the part of it that is furniture
#                   in truth, such as what stands behind a removed wall, or a thing that was moved
#   with clutter    the witnesses, which stand between the photos' places; psnr: novel.psnr
#   shell alone     the same without furniture
#   render_views    the same from the photos' layers alone
# And if BENCH_APARTMENT (../shared/data/apartment) is there, its four views that nobody photographed, three rows like the
# last. BENCH_SCALE is the size of the photos (1), BENCH_EDIT_SAMPLES the samples of edits (64).
BENCH_HELDOUT='' . "${BENCHES:-tests/bench}/vdta.sh"
title="Remodelled rooms and new views: PSNR against time"
note="Upper left is better. Edits: what they reveal, after one gain for each face."
baseline="render_views"
label= # the key has them; beside the points they overlap
x_label="Core-seconds per megapixel"
timed="core_s_per_mp"
edit_samples=${BENCH_EDIT_SAMPLES:-64}
apartment=${BENCH_APARTMENT:-$data/apartment}
room=$kept/project/out/room+draft
edits() { find "$described/edits" -name '*.txt' -printf '%f\n' | sed 's/\.txt$//' | LC_ALL=C sort; }
# edits whose scene is described, too
described_edits() { local e; for e in $(edits); do [ ! -e "$described/scene-$e.txt" ] || echo "$e"; done; }

prepare()
{
    local e v
    for v in render_model bake_outdoors render_views; do [ -x "$B/bin/$v" ] || missing "there is no program $B/bin/$v."; done
    prepare_room
    made SCENE=room textures outdoors
    for v in $(witnesses); do shown "" "$v"; done
    for e in $(described_edits); do for v in $shell_photos $(witnesses); do shown "$e" "$v"; done; done
    # the frame of the truth's cameras
    true_cameras "$room" "$kept/project/out/room" "$kept/room/truth" "$kept/cameras"
    [ ! -d "$apartment/photos" ] || prepare_apartment
}

# the truth of a camera, after an edit or of the room as it is
shown() # EDIT CAMERA
{
    local to=$kept/room/truth/${1:+edited-$1}
    [ -n "$1" ] || to=$kept/room/truth/novel
    # its faces, of which some are furniture
    [ -z "$1" ] || [ -e "$to/faces.txt" ] || simulated --scene "$described" --out "$kept/room" --edit "$1" --common
    [ -e "$to/hdr/$2.exr" ] || simulated --scene "$described" --out "$kept/room" ${1:+--edit "$1"} --photo "$2" --set "samples=$edit_samples" --set "truth_samples=$edit_samples"
}
true_cameras() # PRODUCTS SHARED TRUTH TO
{
    [ ! -e "$4/novel" ] || return 0
    mkdir -p "$work/cameras"; ln -sfn "$(realpath "$1")"/{views,model} "$work/cameras/"
    quietly "$B/bin/evaluate" --folder "$work/cameras" --shared "$2" --truth "$3" --out "$work/cameras/metrics.tsv"
    mkdir -p "$4"; cp -r "$work/cameras/evaluate/cameras/." "$4/"
}
prepare_apartment()
{
    mkdir -p "$kept/project/scenes"
    ln -srfn scenes/apartment "$kept/project/scenes/apartment"
    made SCENE=apartment PHOTOS="$(realpath "$apartment/photos")" textures outdoors
    true_cameras "$kept/project/out/apartment+draft" "$kept/project/out/apartment" "$apartment/truth" "$kept/apartment-cameras"
}

settings()
{
    local e s
    printf 'series\tscene\n'
    for s in render_views 'shell alone' 'with clutter'; do printf '%s\t%s\n' "$s" "$scene"; done
    for e in $(described_edits); do printf 'edit %s\t%s\n' "$e" "$scene"; done
    [ -d "$apartment/photos" ] || return 0
    for s in render_views 'shell alone' 'with clutter'; do printf '%s\tapartment\n' "$s"; done
}

views_of() { local p f; for p in $shell_photos; do for f in "$room/views/$p"*.exr; do f=${f##*/}; echo --view "${f%.exr}"; done; done; }

sample() # SERIES SCENE
{
    local from=$room shared=$kept/project/out/room truth=$kept/room/truth cameras=$kept/cameras/novel where=novel of=novel psnr=psnr args=() drawn=()
    if [ "$2" = apartment ]; then
        from=$kept/project/out/apartment+draft shared=$kept/project/out/apartment truth=$apartment/truth cameras=$kept/apartment-cameras/novel
    fi
    rm -rf "$fast/row"; mkdir -p "$fast/row"
    ln -s "$(realpath "$from")"/{views,model,ids} "$fast/row/"
    args=(--views "$from/views" --depth "$from/depth" --threads "$threads")
    [ "$1" = render_views ] || args[3]=$from/depth/model
    drawn=(--model "$from/model/model.txt" --axes "$from/model/axes.txt" --vdta "$from/vdta" --vita "$from/vita" --ids "$from/ids" --outdoors "$from/outdoors/outdoors.exr")
    case $1 in
    render_views) measured "$B/bin/render_views" "${args[@]}" --cameras "$cameras" --out "$fast/row/rendered/novel" >"$fast/time" || return ;;
    'shell alone') measured "$B/bin/render_model" "${args[@]}" "${drawn[@]}" --cameras "$cameras" --set clutter=none --out "$fast/row/rendered/novel" >"$fast/time" || return ;;
    'with clutter') measured "$B/bin/render_model" "${args[@]}" "${drawn[@]}" --cameras "$cameras" --out "$fast/row/rendered/novel" >"$fast/time" || return ;;
    *)
        local e=${1#edit }
        where=edited-$e of=edited.$e psnr=revealed_psnr
        drawn[1]=$from/remodel/$e/model.txt
        # shellcheck disable=SC2046 # options
        measured "$B/bin/render_model" "${args[@]}" "${drawn[@]}" --base "$from/model/model.txt" --map "$from/remodel/$e/texture.txt" --things "$from/things" $(views_of) \
            --set radiance=yes --out "$fast/row/rendered/$where" >"$fast/time" || return ;;
    esac
    [ "$where" != novel ] || cp "$cameras"/*.txt "$fast/row/rendered/novel/"
    "$B/bin/evaluate" --folder "$fast/row" --shared "$shared" --truth "$truth" --rendered "$fast/row/rendered" --out "$fast/row/metrics.tsv" 2>"$work/err" || return
    grep -E '^(seconds|peak_mib) ' "$fast/time"
    local pixels; pixels=$(awk '$1 == "size" { n += $2 * $3 } END { print n / 1e6 }' "$fast/row/rendered/$where"/*.txt)
    [ "$1" != render_views ] || pixels=$(awk '!/^#/ && NF > 3 { size[$1] = $3 * $4 } END { for (k in size) n += size[k]; print n / 1e6 }' "$cameras/cameras.txt")
    awk -F'\t' -v of="$of." -v psnr="$psnr" -v mp="$pixels" '
        FNR == NR { split($0, t, " "); time[t[1]] = t[2]; next }
        index($1, of) != 1 { next }
        { name = substr($1, length(of) + 1) }
        name ~ /^(ssim|revealed|revealed_things|revealed_things_psnr|pictures)$/ { printf "%s %.5g\n", name, $2 }
        name == psnr { printf "psnr %.5g\ncore_s_per_mp %.4g\n", $2, time["cpu_seconds"] / mp }' "$fast/time" "$fast/row/metrics.tsv"
}
