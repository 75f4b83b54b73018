# things.sh - rooms whose furniture an edit clears or moves: error against what is true, on rooms that nobody tuned on.
#
# made_room makes a described scene of each seed of BENCH_SEEDS ("1 2"), with photos of 480 x 320 pixels. The chain runs at
# draft quality in a project of its own, out/bench/things; what is there is made again only if it depends on what changed.
# Added to the truth: four photos at even steps (BENCH_PHOTOS=N: another number) after each edit, at BENCH_EDIT_SAMPLES (64)
# samples. Series:
#   clear all   all furniture is cleared
#   moved       one piece is cleared, one stands elsewhere
# light: `old`, the pictures of `make remodel`; `new`, the same relit. BENCH_LIGHT="old" leaves out the latter.
#             made_room marks plain walls that the lamps light, and nothing that they do not.
#
# psnr: over all pixels (edited.E.psnr). revealed_psnr: over what the edit reveals or puts elsewhere, after one gain for each
# face (edited.E.revealed_psnr); revealed: these pixels, % of all. revealed_things_psnr: those of them that show furniture.
# walls: the largest error of a wall of the unedited model, m.
title="Cleared and moved furniture in rooms that a seed decides"
note="Higher is better. Over all pixels, against the part of them that the edit reveals."
repeats=1 # pictures repeat exactly
line=series label=scene panel=light
x=revealed x_label="Revealed pixels (%)" y=revealed_psnr y_label="PSNR of revealed pixels (dB)" zero=no

seeds=${BENCH_SEEDS:-1 2}
samples=${BENCH_EDIT_SAMPLES:-64}
light=${BENCH_LIGHT:-old new}
project=$PWD/out/bench/things

say() { echo "things: $*" >&2; }
quietly() { "$@" >"$work/messages" 2>&1 || { tail -n 5 "$work/messages" >&2; missing "${1##*/} failed."; }; }
made() { say "make $*"; quietly "${MAKE:-make}" -C "$project" --no-print-directory DEPS=manual QUALITY=draft "$@"; }
photos_of() # SCENE
{
    awk -v n="${BENCH_PHOTOS:-4}" '$1 == "photo" { p[k++] = $2 } END { for (i = 0; i < n && i < k; i++) printf "%s ", p[int(i * k / n)] }' "$project/scenes/$1/cameras.txt"
}
edit_of() { if [ "$1" = moved ]; then echo moved; else echo bare; fi; } # SERIES

# ------------------------------------------------------------------------------------------------------------- the rooms

prepare()
{
    local p f s
    for p in bin/simulate bin/evaluate bin/relight tests/bench/made_room; do [ -x "$B/$p" ] || missing "the program $B/$p is missing."; done
    mkdir -p "$project/out" "$project/scenes"
    for f in Makefile stages common configs tests; do ln -srfn "$PWD/$f" "$project/$f"; done
    ln -srfn "$PWD/out/build" "$project/out/build"
    for s in $seeds; do prepare_room "$s" "made$s"; done
}

prepare_room() # SEED NAME
{
    local e v
    describe "$1" "$2"
    made SCENE="$2" textures things
    for e in bare moved; do
        for v in $(photos_of "$2"); do shown "$2" "$e" "$v"; done
        made SCENE="$2" EDIT="$e" RELIT_VIEWS="$(photos_of "$2")" relight
    done
}

# the scene of a seed; files that are the same stay, so that nothing is made again
describe() # SEED NAME
{
    rm -rf "${work:?}/$2"
    quietly "$B/tests/bench/made_room" --seed "$1" --out "$work/$2"
    diff -rq "$work/$2" "$project/scenes/$2" >/dev/null 2>&1 || { rm -rf "$project/scenes/$2"; cp -r "$work/$2" "$project/scenes/$2"; }
}

# the truth of a photo after an edit
shown() # SCENE EDIT PHOTO
{
    local from=$project/scenes/$1 to=$project/out/$1/simulated f
    f=$to/truth/edited-$2/faces.txt # which of them are furniture
    [ "$f" -nt "$from/scene-$2.txt" ] || quietly "$B/bin/simulate" --config "$from/scene.cfg" --scene "$from" --out "$to" --edit "$2" --common
    f=$to/truth/edited-$2/hdr/$3.exr
    [ "$f" -nt "$from/scene.txt" ] && [ "$f" -nt "$from/scene-$2.txt" ] && [ "$f" -nt "$from/cameras.txt" ] && return
    say "simulate $1 $2 $3"
    quietly "$B/bin/simulate" --config "$from/scene.cfg" --scene "$from" --out "$to" --edit "$2" --photo "$3" --set "samples=$samples" --set "truth_samples=$samples"
}

settings()
{
    local s e l
    printf 'series\tscene\tlight\n'
    for s in $seeds; do
        for e in 'clear all' moved; do
            for l in $light; do printf '%s\tmade%s\t%s\n' "$e" "$s" "$l"; done
        done
    done
}

# ------------------------------------------------------------------------------------------------------------- the rows

sample() # SERIES SCENE LIGHT
{
    local e from=$project/out/$2+draft pictures p f
    e=$(edit_of "$1")
    pictures=$from/relight/$e
    [ "$3" = new ] || pictures+=/unlit
    rm -rf "$fast/row"; mkdir -p "$fast/row/rendered/edited-$e"
    ln -s "$from"/{views,model,ids,remodel} "$fast/row/"
    for p in $(photos_of "$2"); do
        for f in "$pictures/$p"*.exr; do [[ $f == *-ratio.exr ]] || ln -s "$f" "$fast/row/rendered/edited-$e/"; done
    done
    measured "$B/bin/evaluate" --folder "$fast/row" --shared "$project/out/$2" --truth "$project/out/$2/simulated/truth" --rendered "$fast/row/rendered" --out "$fast/row/metrics.tsv" >"$fast/time" || return
    grep -E '^(seconds|peak_mib) ' "$fast/time"
    awk -F'\t' -v of="edited.$e." '
        $1 == "model.walls" { printf "walls %.3g\n", $2 }
        index($1, of) == 1 { name = substr($1, length(of) + 1); if (name ~ /^(psnr|ssim|revealed|revealed_psnr|revealed_things|revealed_things_psnr|pictures)$/) printf "%s %.5g\n", name, $2 }' "$fast/row/metrics.tsv"
}
