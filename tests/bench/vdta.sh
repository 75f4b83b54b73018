# vdta.sh - texture atlases: error against what is true of the room without its furniture, by core-seconds per megapixel.
#
# The described scene BENCH_SCENE (loft) is photographed at 64 samples, and its shell, the room without furniture, at 256
# from four photos and all witnesses (BENCH_SHELL names others). Every second photo is also taken under another sun. The
# pictures are kept in out/bench/vdta/SCALE and made again only if the description or the code of `simulate` changes; how
# long that takes is said before. BENCH_SCALE (1) is the size of the photos: 0.5 for a quick run.
#
# The chain runs at draft quality, in a project of its own beside the pictures, up to the atlases' inputs. Then each row
# bakes the atlases of all photos, with BENCH_THREADS (1) threads. Rows:
#   reveal=edits    the default: what edits reveal, and what clutter hides
#   reveal=all      all that is in the frame [Colburn 2014]
#   clutter kept    reveal=all, without refusing texels in front of which something stands, as [Colburn 2014]
#   another sun     reveal=all, with half of the photos under another sun; the atlases of the other half
#   single texture  the VITA alone: one texture per face, as texturing tools make it
# BENCH_HELDOUT (apartment, if ../shared/data has it) is a scene of real or described photos with a model: every eighth is
# left out of the bake and predicted from the others, by reveal=all and by the single texture (heldout_psnr). Empty: none.
#
# psnr is psnr_seen, or heldout_psnr where photos are held out. core_s_per_mp is the CPU time of the bake per million texels. The other columns are the metrics texture.* of
# docs/evaluation.md, texture.vita.* of the single texture.
title="Texture atlases: PSNR against time"
note="Upper left is better. Texels that photos show, against the room without furniture; or held-out photos."
repeats=1 # atlases repeat exactly
baseline="single texture"
timed="core_s_per_mp"
match=scene
line=series label=series panel=scene
x=core_s_per_mp x_label="Core-seconds per megapixel of atlas" y=psnr y_label="PSNR (dB)" zero=no

scene=${BENCH_SCENE:-loft}
scale=${BENCH_SCALE:-1}
samples=${BENCH_SAMPLES:-64} shell_samples=${BENCH_SHELL_SAMPLES:-256}
shell_photos=${BENCH_SHELL:-}
threads=${BENCH_THREADS:-1}
sun=${BENCH_SUN:--62 28} # azimuth, elevation
kept=$PWD/out/bench/vdta/$scale
described=scenes/$scene
data=${BENCH_DATA:-../shared/data}
heldout=${BENCH_HELDOUT-$([ ! -d "$data/apartment/photos" ] || echo apartment)}

say() { echo "vdta: $*" >&2; }
quietly() { "$@" >"$work/messages" 2>&1 || { tail -n 5 "$work/messages" >&2; missing "${1##*/} failed."; }; }
simulated() { quietly "$B/bin/simulate" --set "scale=$scale" --set irradiance_points=0 "$@"; }
photos_of() { awk '$1 == "photo" { print $2 }' "$1/cameras.txt"; }
witnesses() { awk '$1 == "witness" { print $2 }' "$described/cameras.txt"; }
every_second() { awk 'NR % 2 == 0'; }

# --------------------------------------------------------------------------------------------------------- the pictures

# four photos, spread over the list
default_shell() { photos_of "$described" | awk '{ p[NR] = $1 } END { for (i = 0; i < 4; i++) printf "%s ", p[int(i * NR / 4) + 1] }'; }

# what pictures depend on
pictures_text() # WHAT
{
    echo "$1"
    sha256sum "$described/scene.txt" "$described/cameras.txt"
    find "$described" -name '*.obj' -exec sha256sum {} + | sort
    cat "$B/code/simulate"
}
# whether the pictures of a list are there, made from the same
kept_from() # LIST TEXT
{
    [ -e "$B/code/simulate" ] || missing "there is no $B/code/simulate; make SCENE=$scene once, which writes the checksums of the programs."
    pictures_text "$2" >"$work/pictures"
    cmp -s "$work/pictures" "$kept/$1"
}

tell_time() # SAMPLES PATTERN
{
    "$B/bin/simulate" --scene "$described" --out "$kept/room" --set "scale=$scale" --set "samples=$1" --estimate 2>/dev/null | grep -- "$2" >&2 || true
}

shoot()
{
    if kept_from pictures.txt "samples $samples"; then return; fi
    say "photographing $scene at scale $scale. All pictures of a kind take:"
    tell_time "$samples" '^photos'
    rm -rf "$kept"; mkdir -p "$kept"
    simulated --scene "$described" --out "$kept/room" --common
    simulated --scene "$described" --out "$kept/room" --photo all --set "samples=$samples"
    mv "$work/pictures" "$kept/pictures.txt"
}

# the room without its furniture, and half of the photos under another sun
shoot_shell()
{
    local v
    if kept_from shell.txt "samples $samples, shell $shell_samples of $shell_photos, sun $sun"; then return; fi
    say "photographing $scene at scale $scale without furniture, and half of its photos again. All pictures of a kind take:"
    tell_time "$shell_samples" '^pictures of the shell'
    rm -rf "$kept/room/truth/shell" "$kept/suns" "$kept/mixed"; mkdir -p "$kept/sunny"
    # ids and depths of the shell need one ray a pixel; radiance, many
    for v in $(photos_of "$described"); do
        simulated --scene "$described" --out "$kept/room" --photo "$v" --kind shell --set samples=1 --set truth_samples=1
        rm "$kept/room/truth/shell/hdr/$v.exr"
    done
    for v in $shell_photos $(witnesses); do
        simulated --scene "$described" --out "$kept/room" --photo "$v" --kind shell --set "samples=$shell_samples" --set "truth_samples=$shell_samples"
    done
    cp "$described/scene.txt" "$kept/sunny/"
    find "$described" -name '*.obj' -exec cp {} "$kept/sunny/" \;
    awk -v s="$sun" '$1 == "photo" && ++n % 2 == 0 { $0 = $0 " sun " s } { print }' "$described/cameras.txt" >"$kept/sunny/cameras.txt"
    for v in $(photos_of "$described" | every_second); do
        simulated --scene "$kept/sunny" --out "$kept/suns" --photo "$v" --set "samples=$samples"
    done
    mix_suns
    mv "$work/pictures" "$kept/shell.txt"
}

# Photos under two suns, and what is true of those under the first one; the shell is known under that sun only.
mix_suns()
{
    local v kind
    mkdir -p "$kept/mixed/photos" "$kept/mixed/truth/hdr" "$kept/mixed/truth/shell/hdr"
    ln -srf "$kept"/room/photos/* "$kept/mixed/photos/"
    ln -srf "$kept"/suns/photos/* "$kept/mixed/photos/"
    ln -srf "$kept"/room/truth/*.txt "$kept"/room/truth/{ids,depth} "$kept/mixed/truth/"
    [ ! -d "$kept/room/truth/novel" ] || ln -srfn "$kept/room/truth/novel" "$kept/mixed/truth/novel"
    for kind in ids depth; do ln -srfn "$kept/room/truth/shell/$kind" "$kept/mixed/truth/shell/$kind"; done
    ln -srf "$kept"/room/truth/hdr/* "$kept/mixed/truth/hdr/"
    ln -srf "$kept"/suns/truth/hdr/* "$kept/mixed/truth/hdr/"
    ln -srf "$kept"/room/truth/shell/hdr/* "$kept/mixed/truth/shell/hdr/"
    for v in $(photos_of "$described" | every_second); do rm -f "$kept/mixed/truth/shell/hdr/$v.exr"; done
}

# ------------------------------------------------------------------------------------------------------------- the chain

# pixels of the scene's photos, in texts in which PHOTO X Y ... or "in PHOTO X Y ... [rim X Y]" names them, at another scale
scaled()
{
    if [ "$scale" = 1 ]; then cat "$1"; return; fi
    awk -v CONVFMT=%.12g -v s="$scale" -v photos="$(photos_of "$described" | tr '\n' ' ')" '
        BEGIN { n = split(photos, p, " "); for (i = 1; i <= n; i++) known[p[i]] = 1 }
        /^#/ { print; next }
        { for (i = 1; i < NF; i++) if ($i in known || $i == "rim") for (k = i + 1; k <= NF && $k ~ /^[0-9.]+$/; k++) $k *= s; print }' "$1"
}

# a scene of the project: NAME, its photos, its truth
new_scene() # NAME PHOTOS TRUTH
{
    local to=$kept/project/scenes/$1 f
    mkdir -p "$to/edits"
    for f in model.txt scale.txt axes_fix.txt; do [ ! -e "$described/$f" ] || scaled "$described/$f" >"$to/$f"; done
    for f in "$described"/edits/*.txt; do scaled "$f" >"$to/edits/${f##*/}"; done
    awk -v CONVFMT=%.12g -v s="$scale" '$1 == "camera_params" { $3 *= s } { print }' "$described/scene.cfg" >"$to/scene.cfg"
    printf 'PHOTOS := %s\nTRUTH := %s\nPRODUCTS := model\n' "$2" "$3" >"$to/scene.mk"
}

made() { say "make $*"; quietly "${MAKE:-make}" -C "$kept/project" --no-print-directory DEPS=manual QUALITY=draft "$@"; }

# the scene `room`, with its atlases
prepare_room()
{
    local f p
    for p in simulate trace_ids bake_vdta bake_vita evaluate; do [ -x "$B/bin/$p" ] || missing "there is no program $B/bin/$p."; done
    [ -e "$described/scene.txt" ] || missing "there is no $described/scene.txt; BENCH_SCENE=NAME is a described scene with model.txt."
    [ -n "$shell_photos" ] || shell_photos=$(default_shell)
    shoot
    mkdir -p "$kept/project/out"
    for f in Makefile stages common configs tests; do ln -srfn "$PWD/$f" "$kept/project/$f"; done
    ln -srfn "$PWD/out/build" "$kept/project/out/build"
    new_scene room "$kept/room/photos" "$kept/room/truth"
    made SCENE=room vdta
}

prepare()
{
    prepare_room
    shoot_shell
    new_scene mixed "$kept/mixed/photos" "$kept/mixed/truth"
    # the same cameras, so that rows differ by light alone
    echo "SFM := out/room/sfm/0" >>"$kept/project/scenes/mixed/scene.mk"
    made SCENE=mixed vdta
    if [ -n "$heldout" ]; then prepare_heldout; fi
}

# the photos of a folder, or those that the scene names
prepare_heldout()
{
    local photos=() mk=scenes/$heldout/scene.mk
    [ -e "scenes/$heldout/model.txt" ] || missing "scenes/$heldout has no model.txt; BENCH_HELDOUT=NAME is a scene with one, or empty."
    [ ! -d "$data/$heldout/photos" ] || photos=(PHOTOS="$(realpath "$data/$heldout/photos")")
    [ ${#photos[@]} -gt 0 ] || grep -q '^PHOTOS' "$mk" || missing "there is no $data/$heldout/photos, and $mk names no PHOTOS; BENCH_HELDOUT= leaves the scene out."
    mkdir -p "$kept/project/scenes"
    ln -srfn "scenes/$heldout" "$kept/project/scenes/$heldout"
    made SCENE="$heldout" HOLDOUT=8 "${photos[@]}" vdta
}

settings()
{
    printf 'series\tscene\treveal\tclutter\n'
    row() { printf '%s\t%s\t%s\t%s\n' "$@"; }
    row 'single texture' "$scene" - refused
    row 'reveal=edits' "$scene" edits refused
    row 'reveal=all' "$scene" all refused
    row 'clutter kept' "$scene" all kept
    row 'another sun' "$scene" all refused
    [ -n "$heldout" ] || return 0
    row 'single texture' "$heldout" - refused
    row 'reveal=all' "$heldout" all refused
}

# ------------------------------------------------------------------------------------------------------------- the rows

# the layout that `evaluate` reads, without depth maps, which would be compared each time
row_folder() # PRODUCTS
{
    local f
    rm -rf "$fast/row"; mkdir -p "$fast/row/holdout"
    for f in views model remodel ids reveal holdout/views; do [ ! -e "$1/$f" ] || ln -s "$(realpath "$1/$f")" "$fast/row/$f"; done
}

# the atlases of a row; their time goes to $fast/time
bake_vita() # FROM
{
    local v edits=()
    for v in "$1"/remodel/*/model.txt; do [ ! -e "$v" ] || edits+=(--edit "$v"); done
    measured "$B/bin/bake_vita" --threads "$threads" --model "$1/model/model.txt" --axes "$1/model/axes.txt" --views "$1/views" --ids "$1/ids" "${edits[@]}" --out "$fast/row/vita" >"$fast/time"
}
bake_vdta() # FROM REVEAL CLUTTER PHOTOS...
{
    local from=$1 reveal=$2 clutter=$3 args=() v; shift 3
    for v; do args+=(--photo "$v"); done
    [ "$clutter" = refused ] || args+=(--set max_clutter=1 --set min_clutter=1)
    measured "$B/bin/bake_vdta" --threads "$threads" --model "$from/model/model.txt" --axes "$from/model/axes.txt" --views "$from/views" --ids "$from/ids" --reveal "$from/reveal" --set "reveal=$reveal" "${args[@]}" --out "$fast/row/vdta" >"$fast/time"
}

sample() # SERIES SCENE REVEAL CLUTTER
{
    local name=room of=texture photos=() products out=$kept/project/out truth=()
    mapfile -t photos < <(photos_of "$described")
    if [ "$1" = 'another sun' ]; then name=mixed; mapfile -t photos < <(photos_of "$described" | awk 'NR % 2'); fi
    products=$out/$name+draft truth=(--truth "$kept/$name/truth")
    if [ "$2" != "$scene" ]; then
        name=$2 products=$out/$2+draft+holdout8 truth=()
        mapfile -t photos < <(awk '!/^#/ && NF > 2 && !seen[$2]++ { print $2 }' "$products/views/lenses.txt")
    fi
    row_folder "$products"
    if [ "$1" = 'single texture' ]; then
        of=texture.vita
        bake_vita "$products" || return
    else
        [ "$2" = "$scene" ] || bake_vita "$products" || return # what the nearest viewpoint does not have
        bake_vdta "$products" "$3" "$4" "${photos[@]}" || return
    fi
    "$B/bin/evaluate" --folder "$fast/row" --shared "$out/$name" "${truth[@]}" --out "$fast/row/metrics.tsv" 2>"$work/err" || return
    report_row "$of"
}

# the lines of a row, from the time of the bake and the metrics with a prefix
report_row() # PREFIX
{
    grep -E '^(seconds|peak_mib) ' "$fast/time"
    awk -F'\t' -v of="$1." '
        FNR == NR { split($0, t, " "); time[t[1]] = t[2]; next }
        index($1, of) != 1 { next }
        { name = substr($1, length(of) + 1) }
        name ~ /^(psnr_(original|warped|seen|synthesised)|clutter_avoided|clutter_baked|unknown_clean|seam_energy|covered|heldout_psnr|heldout_filled|megapixels)$/ {
            printf "%s %.5g\n", name, $2
            if (name == "heldout_psnr" || name == "psnr_seen") psnr = $2
            if (name == "megapixels" && $2 > 0) printf "core_s_per_mp %.4g\n", time["cpu_seconds"] / $2 }
        END { if (psnr != "") printf "psnr %.5g\n", psnr }' "$fast/time" "$fast/row/metrics.tsv"
}
