# rooms.sh - lamps, daylight and relit pictures of a hundred rooms that a seed decides, and what fails in which of them.
#
# made_room makes a described scene of each seed of BENCH_SEEDS (1 to 100), with photos of 480 x 320 pixels. The cameras are
# the true ones, so that figures are of light; everything else is what a run finds at draft quality, in out/bench/rooms.
# What is there is made again only if it depends on what changed, so the bench can be ended and goes on later. A room
# takes five core-minutes, of which the simulation takes half. BENCH_EDIT_SAMPLES (32) are those of the truth of the edit.
#
# lamp: largest relative error of a lamp's luminance. irradiance50, irradiance90: of the truth's points (irradiance.error50,
# error90, as fractions). The edit `window` makes the sunny window larger. old, new: PSNR of one photo over the pixels whose
# light changes by more than 5 %, in the old light and relit; gain: their difference. sun: 1 if a sun is found, 0 if not.
# failed: 1 if the run ended with an error; its last line is in out/bench/rooms_failed.txt, as are rooms whose lamp is off
# by more than 0.3, whose median irradiance is off by more than 0.15, or that lose more than 0.1 dB.
BENCH_LIGHT='' . "${BENCHES:-tests/bench}/things.sh"
title="A hundred rooms: error of their light, and what new light gains"
note="Each point is a room that nobody tuned on. Upper left is better."
line=series label='' panel=''
x=irradiance50 x_label="Median relative error of irradiance" y=gain y_label="Gain of relit pictures over the old light (dB)" zero=yes
seeds=${BENCH_SEEDS:-$(seq 1 100)}
samples=${BENCH_EDIT_SAMPLES:-32}
project=$PWD/out/bench/rooms
points=40 point_samples=1024 # of true irradiance

prepare_room() { describe "$1" "$2"; } # SEED NAME

# as in things.sh, with points of irradiance
describe() # SEED NAME
{
    rm -rf "${work:?}/$2"
    quietly "$B/tests/bench/made_room" --seed "$1" --out "$work/$2"
    sed -i "s/^irradiance_points = .*/irradiance_points = $points\nirradiance_samples = $point_samples/" "$work/$2/scene.cfg"
    diff -rq "$work/$2" "$project/scenes/$2" >/dev/null 2>&1 || { rm -rf "$project/scenes/$2"; cp -r "$work/$2" "$project/scenes/$2"; }
}

settings()
{
    local s
    printf 'series\tscene\n'
    for s in $seeds; do printf 'room\tmade%s\n' "$s"; done
}

# what make says, and whether it went well
tried() { say "make $*"; "${MAKE:-make}" -C "$project" --no-print-directory DEPS=manual QUALITY=draft "$@" >"$work/messages" 2>&1; }
# the photo in the middle of the walk
photo_of() { awk '$1 == "photo" { p[n++] = $2 } END { print p[int(n / 2)] }' "$project/scenes/$1/cameras.txt"; } # SCENE

# the true irradiance of a photo; EDIT may be empty
lit() # SCENE EDIT PHOTO
{
    local from=$project/scenes/$1 to=$project/out/$1/simulated f
    f=$to/truth/${2:+edited-$2/}irradiance/$3.exr
    [ "$f" -nt "$from/scene.txt" ] && [ "$f" -nt "$from/cameras.txt" ] && return
    say "simulate $1 ${2:-before} $3, irradiance"
    quietly "$B/bin/simulate" --config "$from/scene.cfg" --scene "$from" --out "$to" ${2:+--edit "$2"} --photo "$3" --kind irradiance --set "samples=$samples" --set "truth_samples=$samples"
}

# one room: makes its products; false: the run ended with an error
run_room() # SCENE
{
    local p truth=$project/out/$1/simulated/truth
    p=$(photo_of "$1")
    tried SCENE="$1" hdr || return
    shown "$1" window "$p"
    lit "$1" '' "$p"
    lit "$1" window "$p"
    tried SCENE="$1" SFM="$truth" EDIT=window RELIT_VIEWS="$p" irradiance relight && tried SCENE="$1" SFM="$truth" evaluate
}

fails() { printf '%s\t%s\n' "$1" "$2" >>"$work/failed"; } # SCENE CAUSE

lamp_error() # SCENE
{
    local o=$project/out/$1+draft scale
    scale=$(awk -F'\t' '$1 == "radiance.scale" { print $2 }' "$o/metrics.tsv")
    "$B/tests/bench/true_light" --scene "$project/scenes/$1/scene.txt" --truth-points "$project/out/$1/simulated/truth/irradiance.txt" \
        --points "$o/evaluate/irradiance_points.txt" --axes "$o/model/axes.txt" --scale "$scale" --lights "$o/lights/lights.txt" 2>"$work/err" |
        awk '$1 == "lamp" { e = $4 < 0 ? -$4 : $4; if (e >= worst) worst = e; n++ } END { if (n) printf "lamp %.3g\n", worst }'
}

sample() # SERIES SCENE
{
    local o=$project/out/$2+draft
    if ! run_room "$2"; then
        fails "$2" "the run ended: $(grep -E 'error:|^make' "$work/messages" | sed -n 1p)"
        echo "failed 1"
        return
    fi
    {
        echo "failed 0"
        lamp_error "$2"
        awk '$1 == "sun" { n++ } END { print "sun", n > 0 }' "$o/outdoors/sky.txt"
        awk -F'\t' '$1 == "irradiance.error50" { printf "irradiance50 %.3g\n", $2 / 100 }
            $1 == "irradiance.error90" { printf "irradiance90 %.3g\n", $2 / 100 }
            $1 == "edited.window.unlit_psnr" { printf "old %.4g\n", $2 }
            $1 == "edited.window.relit_psnr" { printf "new %.4g\n", $2 }
            $1 == "edited.window.relit_gain" { printf "gain %.3g\n", $2 }' "$o/metrics.tsv"
    } >"$fast/values"
    cat "$fast/values"
    awk '{ v[$1] = $2 }
        END { if (v["lamp"] > 0.3) print "a lamp is off by " v["lamp"]
              if (v["irradiance50"] > 0.15) print "the median of irradiance is off by " v["irradiance50"]
              if (v["gain"] < -0.1) printf "new light costs %.3g dB\n", -v["gain"] }' "$fast/values" |
        while read -r cause; do fails "$2" "$cause"; done
}

finish() # TABLE
{
    touch "$work/failed"
    sort -V "$work/failed" >"$out/rooms_failed.txt"
    echo "failures: $(cut -f1 "$out/rooms_failed.txt" | sort -u | wc -l) rooms; $out/rooms_failed.txt says which, and why"
}
