# outdoors.sh - what lies outside without lighting reference images: error of its light, on rooms that nobody tuned on.
#
# The rooms are those of the bench `things` (BENCH_SEEDS, "1 2") and described scenes with products (BENCH_SCENES, "loft")
# in out/SCENE+draft, made by `make SCENE=... QUALITY=draft outdoors`; what is not there is left out, and said. Series:
#   sky and sun   the sky continues what windows show, the sun comes from its patches (sun = find)
#   sky           the same without a sun (sun = none)
#
# Errors are fractions of the truth, in luminance, signed (tests/bench/outdoors_error.c). seen: radiance that leaves through
# openings, without the sun; sky: what floors receive from outdoors, without the sun; floor: the same with it; off: size of
# that error. sun: irradiance of what faces the sun, -1 if it is not found; sun_off: its direction, degrees.
# stated, stated_off: half of the intervals of 95 % that sky.txt states for sun and sun_off.
BENCH_LIGHT='' . "${BENCHES:-tests/bench}/things.sh"
title="Light from outdoors without lighting reference images"
note="Lower left is better. What floors receive from sky and sun, against the truth."
timed="core_s"
line=series label=scene panel=
x=core_s x_label="Core-seconds" y=off y_label="Error of the floors' light from outdoors, a fraction"
described=${BENCH_SCENES:-loft}
threads=${BENCH_THREADS:-1}

prepare_room() { describe "$1" "$2"; made SCENE="$2" outdoors; } # SEED NAME
products_of() { case $1 in made*) echo "$project/out/$1+draft" ;; *) echo "out/$1+draft" ;; esac; } # SCENE
scene_of() { case $1 in made*) echo "$project/scenes/$1" ;; *) echo "scenes/$1" ;; esac; } # SCENE
truth_of() { case $1 in made*) echo "$project/out/$1/simulated/truth" ;; *) echo "out/$1/simulated/truth" ;; esac; } # SCENE

settings()
{
    local s k
    printf 'series\tscene\n'
    for s in $described $(printf 'made%s ' $seeds); do
        [ -e "$(products_of "$s")/fill/atlas.txt" ] || { say "$s is left out, because $(products_of "$s") has no textures"; continue; }
        for k in 'sky and sun' sky; do printf '%s\t%s\n' "$k" "$s"; done
    done
}

sample() # SERIES SCENE
{
    local o sun=find
    o=$(products_of "$2")
    [ "$1" = 'sky and sun' ] || sun=none
    measured "$B/bin/bake_outdoors" --threads "$threads" --model "$o/model/model.txt" --axes "$o/model/axes.txt" --views "$o/views" --ids "$o/ids" \
        --vita "$o/fill" --set "sun=$sun" --sky "$fast/sky.txt" --out "$fast/outdoors.exr" >"$fast/time" || return
    awk '$1 == "cpu_seconds" { print "core_s", $2 } $1 == "seconds" || $1 == "peak_mib"' "$fast/time"
    "$B/tests/bench/outdoors_error" --scene "$(scene_of "$2")/scene.txt" --truth "$(truth_of "$2")" --views "$o/views" --model "$o/model/model.txt" \
        --axes "$o/model/axes.txt" --outdoors "$fast/outdoors.exr" >"$fast/error" 2>"$work/err" || return
    awk '{ print } $1 == "floor" { print "off", $2 < 0 ? -$2 : $2 }' "$fast/error"
    awk '$1 == "sun" && $2 == "patches" { for (i = 3; i < NF; i += 2) if ($i == "error") print ++n == 1 ? "stated_off" : "stated", $(i + 1)
                                                                      else if ($i == "irradiance") i += 2 }' "$fast/sky.txt"
}
