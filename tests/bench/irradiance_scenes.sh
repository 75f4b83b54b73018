# irradiance_scenes.sh - irradiance from photographs alone against the truth, and where its error comes from.
#
# Scenes (BENCH_SCENES, "loft apartment") have products out/SCENE+draft, made by `make SCENE=... QUALITY=draft lri lights`, and a
# truth; what is not there is left out, and said. Points are those of the truth that lie on a surface of the
# model. Each scene is measured with its model (`bare`) and, if there is a scenes/SCENE/model-furnished.txt, with that one,
# whose large furniture is boxes (`furnished`). Textures, what lies outside and lamps are then made anew from the photographs.
#
# Series, each with all that is true in those before it:
#   photographs       everything is found in the photographs; a gather to 1 %
#   converged gather  a gather to 0.1 %
#   true lamps        place, radiance and cones of the lamps are true
#   true outdoors     so is what lies outside of the windows (described scenes)
#   true texture      the texture is of photographs whose radiance is true: without noise, clipping, JPEG (where all photos
#                     have a true radiance). What is left is geometry, and how a texture is made.
#
# error, error90: median and 90th percentile of the luminance's relative error, rms: docs/evaluation.md, irradiance.*_model.
# lamp_radiance, lamp_beta: the largest errors of fitted lamps, a fraction and degrees; of a lamp that is saturated, none.
# In the row `true indirect`, which gathers nothing, lamps are fitted given the true irradiance without them.
title="Irradiance from photographs against the truth"
note="Lower left is better. Points on surfaces of the model."
line=series panel="scene model" across=3
x=error90 x_label="90th percentile of the relative error (%)"
y_label="Median of the relative error (%)"
repeats=1 # repeats exactly
timed="core_s"

bin() { echo "$B/bin/$1"; } # NAME
kept=$PWD/out/bench/irradiance_scenes
data=${BENCH_DATA:-../shared/data}

say() { echo "irradiance_scenes: $*" >&2; }
quietly() { "$@" >"$work/messages" 2>&1 || { tail -n 5 "$work/messages" >&2; missing "${1##*/} failed."; }; }

# ------------------------------------------------------------------------------------------------------------- the scenes

products_of() { echo "out/$1+draft"; } # SCENE
truth_of() # SCENE
{
    if [ -e "scenes/$1/scene.txt" ]; then echo "out/$1/simulated/truth"; else echo "$data/$1/truth"; fi
}
# lamps and sky in the lines of scene.txt
described_light() # SCENE
{
    if [ -e "scenes/$1/scene.txt" ]; then cat "scenes/$1/scene.txt"; return; fi
    awk '
        function world(x, y, z) { return (cos(yaw) * x - sin(yaw) * y + t[1]) " " (sin(yaw) * x + cos(yaw) * y + t[2]) " " (z + t[3]) }
        $1 == "yaw_degrees" { yaw = $2 * atan2(0, -1) / 180 }
        $1 == "t" { for (i = 1; i <= 3; i++) t[i] = $(i + 1) }
        $1 == "spot" { print "lamp spot" ++n " disk " world($3, $4, $5) " " $9 " " $10 " " $11 " " $7 " " $15 " " $16 " " $17 " " $13 }
        $1 == "lamp" { h = $7; print "lamp square quad " world($3 - h, $4 - h, $5) " " (-2 * h * sin(yaw)) " " (2 * h * cos(yaw)) " 0 " (2 * h * cos(yaw)) " " (2 * h * sin(yaw)) " 0 " $9 " " $10 " " $11 }
        ' "$(truth_of "$1")/scene-truth.txt"
}
is_described() { [ -e "scenes/$1/scene.txt" ]; } # SCENE
# whether all photos have a true radiance
has_true_photos() # SCENE
{
    local f
    for f in "out/$1"/hdr/*.exr; do [ -e "$(truth_of "$1")/hdr/${f##*/}" ] || return 1; done
}
models_of() { echo bare; [ ! -e "scenes/$1/model-furnished.txt" ] || echo furnished; } # SCENE

scenes=
find_scenes()
{
    local s o
    for s in ${BENCH_SCENES-loft apartment}; do
        o=$(products_of "$s")
        if [ -e "$o/lights/lights.txt" ] && [ -e "$(truth_of "$s")/irradiance.txt" ]; then
            scenes+="$s "
        else
            say "$s is left out, because $o has no lights or $(truth_of "$s") no irradiance; make SCENE=$s QUALITY=draft lri lights (with PHOTOS and LRI if scene.mk names none) makes them."
        fi
    done
}

# ----------------------------------------------------------------------------------------------------------- the products

# stage NAME ARGUMENT...: with the parameters of the scene
stage() { local name=$1; shift; quietly "$(bin "$name")" --config "$o/slice/$name.cfg" "$@"; }
references() { local f; for f in "out/$1"/lri/*.exr; do [ ! -e "$f" ] || printf -- '--%s %s\n' "$2" "$f"; done; } # SCENE OPTION

# Products of a scene with a model script in a folder like out/SCENE, from the scene's views and depths.
make_model() # SCENE SCRIPT FOLDER
{
    local views=() v o
    o=$(products_of "$1")
    mkdir -p "$3/ids" "$3/lights"
    ln -srfn "$o/views" "$3/views"
    stage build_model --script "$2" --axes "$o/model/axes.txt" --views "$o/views" --points "$o/points/points.ply" --out "$3/model"
    cp "$o/model/axes.txt" "$3/model/"
    for v in "$o"/depth/*.exr; do v=${v##*/}; views+=(--view "${v%.exr}" --out "$3/ids/$v"); done
    stage trace_ids --model "$3/model/model.txt" --axes "$o/model/axes.txt" --views "$o/views" --depth "$o/depth" "${views[@]}"
    stage trace_ids --model "$3/model/model.txt" --axes "$o/model/axes.txt" --views "$o/views" --index "$3/ids" --out "$3/ids/index.txt"
    bake "$1" "$3" "$3"
}
# texture, outdoors and lamps of MODEL, made from the views of FOLDER
bake() # SCENE MODEL FOLDER
{
    local m=$2/model/model.txt axes=$2/model/axes.txt from=$3/views o
    o=$(products_of "$1")
    mkdir -p "$3/lights" "$3/outdoors"
    stage bake_vita --model "$m" --axes "$axes" --views "$from" --ids "$2/ids" --out "$3/vita"
    # shellcheck disable=SC2046 # a list of options
    stage bake_outdoors --model "$m" --axes "$axes" --views "$from" --ids "$2/ids" $(references "$1" reference) --out "$3/outdoors/outdoors.exr"
    fit_lamps "$1" "$2" "$3" "$3/lights"
}
fit_lamps() # SCENE MODEL FOLDER OUT OPTION...
{
    local from=$3 model=$2 scene=$1 to=$4 o
    o=$(products_of "$1")
    shift 4
    stage fit_lights --lamps "scenes/$scene/lights.txt" --model "$model/model/model.txt" --plan "$model/model/plan.txt" --axes "$model/model/axes.txt" \
        --views "$from/views" --ids "$model/ids" --vita "$from/vita" --outdoors "$from/outdoors/outdoors.exr" --references "out/$scene/lri" "$@" --out "$to"
}

# the views, with true radiance
make_true_views() # SCENE FOLDER
{
    local f id o scale
    o=$(products_of "$1") scale=$(scale_of "$1")
    mkdir -p "$2/hdr" "$2/views"
    cp "$o"/views/*.txt "$2/views/"
    for f in "out/$1"/hdr/*.exr; do
        id=${f##*/} id=${id%.exr}
        quietly "$B/tests/bench/true_photo" --truth "$(truth_of "$1")/hdr/$id.exr" --merged "$f" --scale "$scale" --out "$2/hdr/$id.exr"
        stage rectify --photo "$id" --photos "$2/hdr" --records "out/$1/photos" --views "$2/views" --out "$2/views"
    done
    touch "$2/made"
}
# the points of the truth in the frame of the views, and the scale of radiance
make_frame() # SCENE FOLDER
{
    local o
    o=$(products_of "$1")
    mkdir -p "$2"
    ln -srfn "$o/views" "$2/views"
    ln -srfn "$o/model" "$2/model"
    quietly "$(bin evaluate)" --folder "$2" --shared "out/$1" --truth "$(truth_of "$1")" --out "$2/metrics.tsv"
}
points_of() { echo "$kept/$1/frame/evaluate/irradiance_points.txt"; } # SCENE
scale_of() { awk '$1 == "radiance.scale" { print $2 }' "$kept/$1/frame/metrics.tsv"; } # SCENE

true_light() # SCENE MODEL LIGHTS OPTION...
{
    local scene=$1 from=$2 lights=$3; shift 3
    described_light "$scene" >"$work/light.txt"
    "$B/tests/bench/true_light" --scene "$work/light.txt" --truth-points "$(truth_of "$scene")/irradiance.txt" --points "$(points_of "$scene")" \
        --axes "$from/model/axes.txt" --scale "$(scale_of "$scene")" --lights "$lights" "$@"
}

# lamps, given the true irradiance without them: that of the scene, less the direct light of its lamps
make_true_indirect() # SCENE FOLDER
{
    local o s=$fast/simulated # all light, or that of lamps alone
    o=$(products_of "$1")
    mkdir -p "$s/all" "$s/lamps" "$2/true-indirect"
    stage fit_lights --lamps "scenes/$1/lights.txt" --model "$2/model/model.txt" --plan "$2/model/plan.txt" --axes "$2/model/axes.txt" --views "$2/views" --ids "$2/ids" --list points --out "$s/list.txt"
    quietly true_light "$1" "$2" "$2/lights/lights.txt" --list "$s/list.txt" --list-out "$s/points.txt"
    cp scenes/"$1"/*.txt "$s/all/"
    cp scenes/"$1"/*.txt "$s/lamps/"
    sed -i '/^\(sun\|panorama\) /d' "$s/lamps/scene.txt"
    find "scenes/$1" -name '*.obj' -exec cp {} "$s/all/" \; -exec cp {} "$s/lamps/" \;
    quietly "$(bin simulate)" --scene "$s/all" --out "$s/all" --points "$s/points.txt" --set truth_samples=1024
    quietly "$(bin simulate)" --scene "$s/lamps" --out "$s/lamps" --points "$s/points.txt" --set truth_samples=1024 --set max_bounces=1
    paste -d' ' <(grep -v '^#' "$s/list.txt") <(grep -v '^#' "$s/all/truth/irradiance-points.txt") <(grep -v '^#' "$s/lamps/truth/irradiance-points.txt") |
        awk -v s="$(scale_of "$1")" 'function e(k,    d) { d = ($k - $(k + 9)) / s; return d > 0 ? d : 0 } { print $1, $2, $3, $4, $5, $6, e(13), e(14), e(15) }' >"$2/true-indirect.txt"
    fit_lamps "$1" "$2" "$2" "$2/true-indirect" --indirect "$2/true-indirect.txt"
}

# what the products depend on
inputs_text() # SCENE
{
    local p
    sha256sum "$(products_of "$1")"/{views/images.txt,points/points.ply,model/axes.txt} scenes/"$1"/*.txt
    for p in build_model trace_ids bake_vita bake_outdoors fit_lights rectify simulate; do cat "$B/code/$p"; done
}
# a step that an interrupted run has not finished: its product comes last
unless_made() { local product=$1; shift; [ -e "$product" ] || "$@"; } # PRODUCT COMMAND...

true_lights_of() # SCENE MODEL
{
    quietly true_light "$1" "$2" "$2/lights/lights.txt" --outdoors "$2/outdoors/outdoors.exr" --outdoors-out "$2/true-outdoors.exr"
    quietly true_light "$1" "$2" "$2/lights/lights.txt" --lights-out "$2/true-lights.txt"
}
bake_true() # SCENE MODEL
{
    mkdir -p "$2/true"
    ln -srfn "$2/../true/views" "$2/true/views"
    bake "$1" "$2" "$2/true"
}

make_products() # SCENE
{
    local to=$kept/$1 m script
    inputs_text "$1" >"$work/inputs"
    if ! cmp -s "$work/inputs" "$to/inputs.txt"; then
        rm -rf "$to"; mkdir -p "$to"
        mv "$work/inputs" "$to/inputs.txt"
        say "making textures and lamps of $1, which takes some minutes"
    fi
    unless_made "$to/frame/metrics.tsv" make_frame "$1" "$to/frame"
    for m in $(models_of "$1"); do
        script=scenes/$1/model.txt
        [ "$m" = bare ] || script=scenes/$1/model-$m.txt
        unless_made "$to/$m/lights/lights.txt" make_model "$1" "$script" "$to/$m"
        unless_made "$to/$m/true-lights.txt" true_lights_of "$1" "$to/$m"
        if is_described "$1"; then unless_made "$to/$m/true-indirect/lights.txt" make_true_indirect "$1" "$to/$m"; fi
    done
    has_true_photos "$1" || return 0
    unless_made "$to/true/made" make_true_views "$1" "$to/true"
    for m in $(models_of "$1"); do unless_made "$to/$m/true/lights/lights.txt" bake_true "$1" "$to/$m"; done
}

prepare()
{
    local p s
    for p in true_light true_photo; do [ -x "$B/tests/bench/$p" ] || missing "the program $B/tests/bench/$p is missing."; done
    [ -n "$scenes" ] || missing "no scene has the products that are needed."
    for s in $scenes; do make_products "$s"; done
}

# --------------------------------------------------------------------------------------------------------------- the rows

settings()
{
    local s m
    printf 'series\tscene\tmodel\n'
    for s in $scenes; do for m in $(models_of "$s"); do
        printf "%s\t$s\t$m\n" photographs 'converged gather' 'true lamps'
        if is_described "$s"; then printf "%s\t$s\t$m\n" 'true outdoors' 'true indirect'; fi
        if has_true_photos "$s"; then printf "%s\t$s\t$m\n" 'true texture'; fi
    done; done
}

# the largest errors of lamps
lamp_errors() # SCENE FOLDER LIGHTS
{
    true_light "$1" "$2" "$3" 2>"$work/err" | awk '
        function size(x) { return x < 0 ? -x : x }
        $1 != "lamp" || / bound$/ { next }
        { if (size($4) > radiance) radiance = size($4); if (size($6) > beta) beta = size($6) }
        END { printf "lamp_radiance %.4f\nlamp_beta %.3f\n", radiance, beta }'
}

sample() # SERIES SCENE MODEL
{
    local f=$kept/$2/$3 target=0.001 row=$fast/row vita lights outdoors o v n=0
    o=$(products_of "$2")
    vita=$f/vita lights=$f/lights/lights.txt outdoors=$f/outdoors/outdoors.exr
    case $1 in 'true indirect') lamp_errors "$2" "$f" "$f/true-indirect/lights.txt"; return ;; photographs) target=0.01 ;; esac
    case $1 in true*) lights=$f/true-lights.txt ;; esac
    case $1 in 'true outdoors' | 'true texture') outdoors=$f/true-outdoors.exr ;; esac
    case $1 in 'true texture') vita=$f/true/vita ;; esac
    rm -rf "$row"; mkdir -p "$row/relight" "$row/views"
    ln -s "$f/model" "$row/model"
    # a few pictures, for the scale of radiance: comparing all of them takes longer than all else
    cp "$o"/views/*.txt "$row/views/"
    for v in "$o"/views/*.exr; do [ $((n++ % 9)) != 0 ] || ln -s "$(realpath "$v")" "$row/views/"; done
    measured "$(bin gather_irradiance)" --set "target_error=$target" --set rays=1048576 --model "$f/model/model.txt" --axes "$f/model/axes.txt" --vita "$vita" --outdoors "$outdoors" \
        --lights "$lights" --references "out/$2/lri" --points "$(points_of "$2")" --out "$row/relight" >"$fast/time" || return
    "$(bin evaluate)" --folder "$row" --shared "out/$2" --truth "$(truth_of "$2")" --out "$row/metrics.tsv" 2>"$work/err" || return
    awk '$1 == "cpu_seconds" { print "core_s", $2 } $1 == "seconds" || $1 == "peak_mib"' "$fast/time"
    awk -F'\t' '
        $1 == "irradiance.error50_model" { printf "error %.4g\nunit %%\n", $2 }
        $1 ~ /^irradiance\.(error90|rms|points)_model$/ { split($1, w, /[._]/); printf "%s %.4g\n", w[2], $2 }' "$row/metrics.tsv"
    [ "$1" != photographs ] || lamp_errors "$2" "$f" "$f/lights/lights.txt"
}

find_scenes
