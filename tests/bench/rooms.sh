# rooms.sh - lamps, daylight and relit pictures of a hundred rooms that a seed decides, and what fails in which of them.
#
# made_room makes a described scene of each seed of BENCH_SEEDS (1 to 100), with photos of 480 x 320 pixels. The cameras are
# the true ones, so that figures are of light; everything else is what a run finds at draft quality, in out/bench/rooms.
# What is there is made again only if it depends on what changed, so the bench can be ended and goes on later.
# Samples (docs/benchmarks.md says why so many): BENCH_PHOTO_SAMPLES (8) of the photos, BENCH_EDIT_SAMPLES (16) of the true
# picture of the edit, BENCH_LIGHT_SAMPLES (32) of the true light, which says what pixels of it count. A room takes six
# core-minutes: two for the photos, two for depth.
# BENCH_SIZE=small: 12 or 14 of the photos, with 288 x 192 pixels and BENCH_PHOTO_SAMPLES of 4, in out/bench/rooms-small. A
# room takes 80 to 95 core-seconds (docs/benchmarks.md says how its figures compare).
#
# lamp: largest relative error of a lamp's luminance. irradiance50, irradiance90: of the truth's points (irradiance.error50,
# error90, as fractions); lit50: irradiance50 with the true lamps, true50: with the true sky and sun, too. lamp_in of
# lamp_n intervals of a lamp's red, green and blue radiance hold the truth, and irradiance_in of irradiance_n intervals
# (light_levels --points), all of 95 %. The edit `window` makes the sunny window larger. old, new: PSNR of one photo over the
# pixels whose light changes by more than 5 %, in the old light and relit; gain: their difference. limit: what the true
# change of light would gain; with BENCH_LIGHT_SAMPLES of 32 its noise costs more than errors of relight do. sun: 1 if a sun is found,
# 0 if not. missed: lamps that are neither marked nor found. core_s: processor time of the room, of what was not there yet.
# failed: 1 if the run ended with an error; its last line is in out/bench/rooms_failed.txt, as are rooms whose lamp is off
# by more than 0.3, whose median irradiance is off by more than 0.15, or that lose more than 0.1 dB.
# out/bench/rooms_summary.txt: medians over the rooms, and how many intervals hold, with the standard error by room.
BENCH_LIGHT='' . "${BENCHES:-tests/bench}/things.sh"
title="A hundred rooms: error of their light, and what new light gains"
note="Each point is a room that nobody tuned on. Upper left is better."
line=series label='' panel=''
x=irradiance50 x_label="Median relative error of irradiance" y=gain y_label="Gain of relit pictures over the old light (dB)" zero=yes
timed=core_s
seeds=${BENCH_SEEDS:-$(seq 1 100)}
samples=${BENCH_EDIT_SAMPLES:-16}
light_samples=${BENCH_LIGHT_SAMPLES:-32}
size=${BENCH_SIZE:-full}
project=$PWD/out/bench/rooms small='' photo_samples=${BENCH_PHOTO_SAMPLES:-8}
case $size in
full) ;;
small) project+=-small small=--small photo_samples=${BENCH_PHOTO_SAMPLES:-4} ;;
*) echo "BENCH_SIZE=$size is unknown; give full or small." >&2; exit 2 ;;
esac
points=40 point_samples=1024 # of true irradiance

prepare_room() { describe "$1" "$2"; } # SEED NAME

# as in things.sh, with points of irradiance
describe() # SEED NAME
{
    rm -rf "${work:?}/$2"
    quietly "$B/tests/bench/made_room" --seed "$1" $small --out "$work/$2"
    sed -i "s/^irradiance_points = .*/irradiance_points = $points\nirradiance_samples = $point_samples/; s/^samples = .*/samples = $photo_samples/" "$work/$2/scene.cfg"
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
truth_of() { echo "$project/out/$1/simulated/truth"; } # SCENE

# the true irradiance of a photo; EDIT may be empty
lit() # SCENE EDIT PHOTO
{
    local from=$project/scenes/$1 to=$project/out/$1/simulated f
    f=$to/truth/${2:+edited-$2/}irradiance/$3.exr
    [ "$f" -nt "$from/scene.txt" ] && [ "$f" -nt "$from/cameras.txt" ] && return
    say "simulate $1 ${2:-before} $3, irradiance"
    quietly "$B/bin/simulate" --config "$from/scene.cfg" --scene "$from" --out "$to" ${2:+--edit "$2"} --photo "$3" --kind irradiance --set "samples=$light_samples" --set "truth_samples=$light_samples"
}

# one room: makes its products; false: the run ended with an error. The true cameras are in the frame of the truth, and so
# are the points.
run_room() # SCENE
{
    local p truth
    p=$(photo_of "$1") truth=$(truth_of "$1")
    tried SCENE="$1" hdr || return
    shown "$1" window "$p"
    lit "$1" '' "$p"
    lit "$1" window "$p"
    [ "$project/out/$1/points.txt" -nt "$truth/irradiance.txt" ] || awk '!/^#/ { print $1, $2, $3, $4, $5, $6 }' "$truth/irradiance.txt" >"$project/out/$1/points.txt"
    tried SCENE="$1" SFM="$truth" EDIT=window RELIT_VIEWS="$p" GATHER_POINTS="$project/out/$1/points.txt" irradiance relight
}

fails() { printf '%s\t%s\n' "$1" "$2" >>"$work/failed"; } # SCENE CAUSE

# ---------------------------------------------------------------------------------------------------------- the figures

# measured by evaluate on the photo of the edit and the points alone
metrics() # SCENE
{
    local from=$project/out/$1+draft truth f p
    truth=$(truth_of "$1") p=$(photo_of "$1")
    rm -rf "$fast/row"; mkdir -p "$fast/row"/{relight,rendered/edited-window} "$fast/truth"
    rm -rf "$fast/truth"; mkdir -p "$fast/truth"
    ln -s "$from"/{views,model,ids,remodel} "$fast/row/"
    ln -s "$from/relight/window" "$fast/row/relight/"
    ln -s "$from/relight"/irradiance.* "$fast/row/relight/"
    ln -s "$truth"/{cameras,images,points3D,scene,faces,irradiance}.txt "$fast/truth/"
    for f in depth ids hdr irradiance edited-window/{depth,ids,hdr,irradiance}; do
        mkdir -p "$fast/truth/$f"
        ln -s "$truth/$f/$p.exr" "$fast/truth/$f/"
    done
    for f in "$from/relight/window/unlit/$p"*.exr; do ln -s "$f" "$fast/row/rendered/edited-window/"; done
    quietly "$B/bin/evaluate" --folder "$fast/row" --shared "$project/out/$1" --truth "$fast/truth" --rendered "$fast/row/rendered" --out "$fast/row/metrics.tsv"
}

true_light() # SCENE OPTION...
{
    local o=$project/out/$1+draft scene=$1 scale
    shift
    scale=$(awk -F'\t' '$1 == "radiance.scale" { print $2 }' "$fast/row/metrics.tsv")
    "$B/tests/bench/true_light" --scene "$project/scenes/$scene/scene.txt" --truth-points "$project/out/$scene/points.txt" --points "$project/out/$scene/points.txt" \
        --axes "$o/model/axes.txt" --scale "$scale" --lights "$o/lights/lights.txt" "$@" 2>"$work/err"
}

# of lamps, beside the truth: the largest error, and intervals that hold it
lamps() # SCENE
{
    local o=$project/out/$1+draft
    true_light "$1" >"$fast/lamps"
    awk -v real="$(grep -c '^lamp ' "$project/scenes/$1/scene.txt")" '
        FNR == NR { if ($1 == "range") for (i = 3; i <= 8; i++) range[$2, i] = $i; if ($1 == "range") known[$2] = 1; next }
        $1 == "lamp" { e = $4 < 0 ? -$4 : $4; if (e >= worst) worst = e; found++
            for (c = 0; known[$2] && c < 3; c++) { n++; in_it += $(10 + c) >= range[$2, 3 + 2 * c] && $(10 + c) <= range[$2, 4 + 2 * c] } }
        END { if (found) printf "lamp %.3g\n", worst
              printf "lamp_in %d\nlamp_n %d\nmissed %d\n", in_it, n, (real > found ? real - found : 0) }' "$o/lights/fit.txt" "$fast/lamps"
}

# the luminances of points by two files, and with LOW HIGH in the first one how many intervals hold the second
compare_points() # FOUND TRUTH NAME [in]
{
    awk -v name="$3" -v held="${4-}" 'function y(r, g, b) { return 0.2126 * r + 0.7152 * g + 0.0722 * b }
        /^#/ { next }
        FNR == NR { n++; e[n] = y($7, $8, $9); low[n] = $10; high[n] = $11; next }
        { i++; t = y($7, $8, $9); r = e[i] / t - 1; print name, r < 0 ? -r : r; hold += t >= low[i] * e[i] && t <= high[i] * e[i] }
        END { if (held) printf "irradiance_in %d\nirradiance_n %d\n", hold, i }' "$1" "$2"
}
median() { sort -k2g | awk '{ name = $1; v[NR] = $2 } END { if (NR) printf "%s %.3g\n", name, NR % 2 ? v[(NR + 1) / 2] : (v[NR / 2] + v[NR / 2 + 1]) / 2 }'; }

room_inputs() # SCENE LIGHTS OUTDOORS
{
    local o=$project/out/$1+draft
    printf '%s\n' --model "$o/model/model.txt" --axes "$o/model/axes.txt" --vita "$o/vita" --things "$o/things" --outdoors "$3" --lights "$2" --points "$project/out/$1/points.txt"
}

# irradiance with more and more of the light replaced by the truth, and the stated intervals
irradiance() # SCENE
{
    local o=$project/out/$1+draft truth in
    truth=$(truth_of "$1")/irradiance.txt
    true_light "$1" --lights-out "$fast/lights.txt" --outdoors "$o/outdoors/outdoors.exr" --outdoors-out "$fast/outdoors.exr" >"$work/output" || return
    for in in lit:"$o/outdoors/outdoors.exr" true:"$fast/outdoors.exr"; do
        mapfile -t args < <(room_inputs "$1" "$fast/lights.txt" "${in#*:}")
        quietly "$B/bin/gather_irradiance" "${args[@]}" --hemicubes 0 --out "$fast/${in%%:*}"
        compare_points "$fast/${in%%:*}/irradiance.txt" "$truth" "${in%%:*}50" | median
    done
    mapfile -t args < <(room_inputs "$1" "$o/lights/lights.txt" "$o/outdoors/outdoors.exr")
    "$B/bin/light_levels" "${args[@]}" --fit "$o/lights/fit.txt" --sky "$o/outdoors/sky.txt" --plan "$o/model/plan.txt" --out "$fast/levels" >"$fast/levels.txt" 2>"$work/messages" || missing "light_levels failed."
    compare_points "$fast/levels.txt" "$truth" irradiance in | grep irradiance_
}

# `times` counts the children of this shell, so it must not run in a shell of its own
core_seconds() { awk 'NR == 2 { for (i = 1; i <= 2; i++) { split($i, t, "m"); s += 60 * t[1] + t[2] } print s }' "$1"; } # FILE

sample() # SERIES SCENE
{
    local o=$project/out/$2+draft
    times >"$work/began"
    if ! run_room "$2"; then
        fails "$2" "the run ended: $(grep -E 'error:|^make' "$work/messages" | sed -n 1p)"
        echo "failed 1"
        return
    fi
    metrics "$2"
    {
        echo "failed 0"
        lamps "$2"
        irradiance "$2"
        awk '$1 == "sun" { n++ } END { print "sun", (n > 0) }' "$o/outdoors/sky.txt"
        awk -F'\t' '$1 == "irradiance.error50" { printf "irradiance50 %.3g\n", $2 / 100 }
            $1 == "irradiance.error90" { printf "irradiance90 %.3g\n", $2 / 100 }
            $1 == "edited.window.unlit_psnr" { printf "old %.4g\n", $2 }
            $1 == "edited.window.relit_psnr" { printf "new %.4g\n", $2 }
            $1 == "edited.window.unlit_psnr" { old = $2 }
            $1 == "edited.window.relit_limit_psnr" { limit = $2 }
            $1 == "edited.window.relit_gain" { printf "gain %.3g\n", $2 }
            END { if (limit) printf "limit %.3g\n", limit - old }' "$fast/row/metrics.tsv"
        times >"$work/ended"
        awk -v a="$(core_seconds "$work/began")" -v b="$(core_seconds "$work/ended")" 'BEGIN { printf "core_s %.4g\n", b - a }'
    } >"$fast/values"
    cat "$fast/values"
    cp "$fast/values" "$project/out/$2/values.txt" # to look at while the bench runs
    awk '{ v[$1] = $2 }
        END { if (v["lamp"] > 0.3) print "a lamp is off by " v["lamp"]
              if (v["irradiance50"] > 0.15) print "the median of irradiance is off by " v["irradiance50"] "; with the true lamps by " v["lit50"] ", with the true sky and sun, too, by " v["true50"]
              if (v["gain"] < -0.1) printf "new light costs %.3g dB\n", -v["gain"]
              if (v["missed"] > 0) print "lamps neither marked nor found: " v["missed"] }' "$fast/values" |
        while read -r cause; do fails "$2" "$cause"; done
}

# medians of columns, and the part of the intervals that hold; rooms are drawn, not intervals, so its error is by room
summarize() # TABLE
{
    awk -F'\t' '
        function share(what,    k, sum, all, p, d, squares, with) {
            for (k = 1; k <= rooms; k++) { sum += cell[k, what "_in"]; all += cell[k, what "_n"]; with += cell[k, what "_n"] > 0 }
            if (!all) return
            p = sum / all
            for (k = 1; k <= rooms; k++) { d = cell[k, what "_in"] - p * cell[k, what "_n"]; squares += d * d }
            printf "intervals of %s: %d of %d hold the truth, %.1f %%, standard error by room %.1f %%, %d rooms\n", what, sum, all, 100 * p, (with > 1 ? 100 * sqrt(squares * with / (with - 1)) / all : 0), with }
        /^#/ { next }
        !n { n = NF; for (i = 1; i <= n; i++) { at[$i] = i; name[i] = $i }; next }
        { rooms++; for (i = 3; i <= n; i++) if ($i != "-") { count[i]++; value[i, count[i]] = $i }; for (i = 1; i <= n; i++) cell[rooms, name[i]] = $i }
        END { print "rooms: " rooms
            split("lamp irradiance50 irradiance90 lit50 true50 gain core_s", shown, " ")
            for (s = 1; s in shown; s++) { i = at[shown[s]]; if (!i || !count[i]) continue
                m = count[i]; for (a = 1; a <= m; a++) v[a] = value[i, a] + 0
                for (a = 2; a <= m; a++) { t = v[a]; for (b = a - 1; b >= 1 && v[b] > t; b--) v[b + 1] = v[b]; v[b + 1] = t }
                printf "%s: median %.3g, nine tenths %.3g, worst %.3g\n", shown[s], m % 2 ? v[(m + 1) / 2] : (v[m / 2] + v[m / 2 + 1]) / 2, v[shown[s] == "gain" ? 1 + int(0.1 * (m - 1)) : m - int(0.1 * (m - 1))], shown[s] == "gain" ? v[1] : v[m] }
            share("lamp"); share("irradiance") }' "$1"
}

finish() # TABLE
{
    touch "$work/failed"
    sort -V "$work/failed" >"$out/rooms_failed.txt"
    summarize "$1" | tee "$out/rooms_summary.txt"
    echo "failures: $(cut -f1 "$out/rooms_failed.txt" | sort -u | wc -l) rooms; $out/rooms_failed.txt says which, and why"
}
