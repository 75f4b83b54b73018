# irradiance.sh - error of irradiance at 35 points against time, by estimator, on fields of light that are known.
#
# Closed forms: sphere, whose radiance grows linearly from one side to the other; patch, a square light over a plane; box, six
# sides of different radiance; window, a quad of 1 % of the hemisphere, 1000 times as bright as all else. Compared with
# converged runs of 2^21 rays: sun, points across the penumbra of a sun of 0.5 degrees; room, a closed room with two boxes, a
# lamp and a window, whose surfaces have known radiance; cornell, the Cornell box of BENCH_CORNELL, texels of known radiance;
# and scenes, textured models of which out/SCENE+draft or out/SCENE has the products (make lights outdoors evaluate). What is not
# there is left out, and said. error: root mean square over the points of the relative error of the luminance. seconds: wall
# time of all points with one thread per core.
#
# Series: hemicube, n x n pixels; rays, towards emitters and by the cosine; blind rays, by the cosine alone. BENCH_CASES
# ("sphere patch box window sun room cornell") and BENCH_SCENES ("loft apartment") choose cases.
title="Irradiance at 35 points: error against time"
note="Lower left is better; n^-0.5 beside a line: its order in the number of rays. A trusted simulator, in a room of its own: 0.28 % in 0.70 s, 0.13 % in 0.99 s, 0.047 % in 7.4 s."
baseline=hemicube
match=case
line=series label=effort panel=case across=3
x=core_s x_label="Core-seconds of all points" y_label="Relative RMS error"
timed="core_s rays_per_core_s"
slope="rays"
orders=rays
repeats=3
reach="0.01 0.0013"

meshes=${BENCH_CORNELL:-../shared/data/cornell-box/meshes}
cases=

# the folder of a scene's products
products_of() # SCENE
{
    local o
    for o in "out/$1+draft" "out/$1"; do
        if [ -e "$o/lights/lights.txt" ] && [ -e "$o/evaluate/irradiance_points.txt" ]; then echo "$o"; return; fi
    done
}

# sets cases, and folder_CASE of those that are read
find_cases()
{
    local c o
    for c in ${BENCH_CASES-sphere patch box window sun room cornell}; do
        if [ "$c" = cornell ] && [ ! -e "$meshes/cbox_floor.obj" ]; then
            echo "irradiance: cornell is left out, because there is no $meshes; BENCH_CORNELL=DIR is a folder of its OBJ files." >&2
        else
            cases+="$c "
        fi
    done
    for c in ${BENCH_SCENES-loft apartment}; do
        o=$(products_of "$c")
        if [ -n "$o" ]; then
            cases+="$c "
        else
            echo "irradiance: $c is left out, because out/$c+draft and out/$c have no lights or no points; make SCENE=$c QUALITY=draft lights outdoors evaluate makes them." >&2
        fi
    done
}
find_cases

# options that say which case
case_options() # CASE
{
    local o
    case $1 in
    sphere | patch | box | window | sun | room) echo "--case $1" ;;
    cornell) echo "--case cornell --folder $meshes" ;;
    *)
        o=$(products_of "$1")
        echo "--case model --folder $o" ;;
    esac
}

prepare()
{
    local c
    [ -x "$B/tests/bench/irradiance" ] || missing "there is no program $B/tests/bench/irradiance; this revision cannot be measured."
    for c in $cases; do
        # shellcheck disable=SC2046 # a list of options
        "$B/tests/bench/irradiance" $(case_options "$c") --converge "$fast/$c.txt" 2>"$work/err" || { tail -n 3 "$work/err" >&2; missing "the truth of $c could not be made."; }
    done
}

settings()
{
    local c n
    printf 'series\tcase\teffort\n'
    for c in $cases; do
        for n in 32 64 128 256 512 1024; do
            # fields that are read cost more a ray: the finest hemicube would take a core-minute
            [ "$n" = 1024 ] && [[ $(case_options "$c") == *--folder* ]] || printf 'hemicube\t%s\t%s\n' "$c" "$n"
        done
        for n in 256 1024 4096 16384 65536; do
            printf 'rays\t%s\t%s\n' "$c" "$n"
            [ "$c" = sphere ] || [ "$c" = box ] || printf 'blind rays\t%s\t%s\n' "$c" "$n" # those two have no emitter
        done
    done
}

sample() # SERIES CASE EFFORT
{
    # shellcheck disable=SC2046
    measured "$B/tests/bench/irradiance" $(case_options "$2") --estimator "${1%% *}" --effort "$3" --truth "$fast/$2.txt"
}
