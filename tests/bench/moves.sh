# moves.sh - plan_path and sample_validity: parallax of the chosen ends of a move, accuracy of the limits of validity.
#
# Scenes: BENCH_SCENES, names of scenes/ (`make SCENE=NAME depth` is run first), or folders that already hold views/,
# depth/ and photos/. The move is the establishing dolly. BENCH_SWEEPS="ends limits": only these panels; "qualities" is
# a third, which must be named, because it makes every scene at every quality. BENCH_THREADS (all cores).
#
# `ends`: move_pairs.c. The baseline is the best of all pairs of the regions' cells whose whole path is valid, each cell
# at the back of its range; plan_path tries the front, too, and may reach more than 100 %. Every
# cell is rendered once in pictures of parallax_side, 192 px, and every pair is compared. `all pairs, film size` does so
# in pictures of 1280 px; `drawn anew` renders both ends of every pair at that size for this pair alone (BENCH_FULL,
# still-life: the scenes for which both run; the latter takes minutes). The others are the choice of [Colburn 2014] of
# the 12 longest pairs (refine=no), and the default. parallax is in % of the frames, measured in pictures of 640 px,
# which were not used for any choice; `chosen` in those that were; `best` is that of the best pair, valid or not.
# `reached` is parallax over the baseline's, %.
#
# `limits`: check_side of sample_validity; `reached` is the fraction of z limits, at up to BENCH_CELLS (12) positions,
# within one step of those found in pictures of the film's size, %; `error` is the rest. seconds are those of the whole
# stage without that comparison.
# `qualities`: `make SCENE=NAME QUALITY=Q path` for each Q of BENCH_QUALITIES (draft default final), of scenes of scenes/
# alone. angle, parallax and worst_h as path.txt states them; `reached` is parallax over that of the best quality, %. No
# quality should reach less than 80 %.
title="Camera moves: parallax of the chosen ends, accuracy of the limits"
note="Upper left is better. Reached: parallax over that of the best of all pairs; z limits within one step."
repeats=1
baseline="all pairs, small"
match="scene sweep"
timed="core_s"
line=series label=value panel="scene sweep" across=2
x=core_s x_label="CPU time (s)" y=reached y_label="Reached (%)" zero=no

scenes=${BENCH_SCENES-still-life kermit sceaux marble-head}
full=${BENCH_FULL-still-life}
threads=${BENCH_THREADS:-$(nproc)}
sweeps=${BENCH_SWEEPS:-ends limits}
qualities=${BENCH_QUALITIES:-draft default final}

wanted() { case " $sweeps " in *" $1 "*) ;; *) return 1 ;; esac; }
quietly() { "$@" >"$work/messages" 2>&1 || { tail -n 5 "$work/messages" >&2; missing "'$*' failed."; }; }

# known_scene NAME: whether make can make the scene; says so if it cannot
known_scene()
{
    [ ! -e "scenes/$1/scene.mk" ] || return 0
    echo "moves: $1 is skipped: scenes/$1/scene.mk does not exist." >&2
    return 1
}

prepare()
{
    [ -x "$B/tests/bench/move_pairs" ] || missing "there is no program $B/tests/bench/move_pairs."
    found_scenes=
    if wanted qualities; then prepare_qualities; fi
    local s name of
    if ! wanted ends && ! wanted limits; then return; fi
    for s in $scenes; do
        name=${s##*/} of=$s
        if [[ $s != */* ]]; then
            known_scene "$s" || continue
            echo "moves: make SCENE=$s depth" >&2
            quietly "${MAKE:-make}" --no-print-directory QUALITY=default SCENE="$s" HOLDOUT= HOLDOUT_VIEWS= depth
            of=out/$s
        elif [ ! -d "$s/views" ] || [ ! -d "$s/depth" ]; then echo "moves: $s is skipped, because it does not hold views/ and depth/." >&2; continue; fi
        mkdir -p "$work/$name/validity"
        for d in views depth photos; do [ ! -d "$of/$d" ] || ln -s "$(realpath "$of/$d")" "$work/$name/$d"; done
        quietly validity "$name" "$work/$name/validity" --set check_cells=0
        found_scenes+=" $name"
    done
    [ -n "$found_scenes" ] || missing "there is no scene; BENCH_SCENES=\"NAMES\" lists names of scenes/, or folders that hold views/ and depth/."
}

# Makes the paths; $work/qualities gets scene, quality, degrees, parallax in %, worst H of each.
prepare_qualities()
{
    local s q of
    made_scenes=
    for s in $scenes; do
        known_scene "$s" || continue
        for q in $qualities; do
            echo "moves: make SCENE=$s QUALITY=$q path" >&2
            of=out/$s+$q
            [ "$q" != default ] || of=out/$s
            quietly "${MAKE:-make}" --no-print-directory QUALITY="$q" SCENE="$s" HOLDOUT= HOLDOUT_VIEWS= EFFECT=establishing_dolly path
            awk -v at="$s $q" '$1 == "score" { v[$2] = $3 } END { print at, v["angle"], 100 * v["parallax"], v["worst_h"] }' \
                "$of/parallax/establishing_dolly/path.txt" >>"$work/qualities"
        done
        made_scenes+=" $s"
    done
    [ -n "$made_scenes" ] || missing "no scene of BENCH_SCENES has a scenes/NAME/scene.mk."
}

validity() # NAME OUT ARGS...
{
    local of=$work/$1 to=$2 records=(); shift 2
    [ ! -d "$of/photos" ] || records=(--records "$of/photos")
    "$B/bin/sample_validity" --threads "$threads" --views "$of/views" --depth "$of/depth" "${records[@]}" --effect establishing_dolly --out "$to" "$@"
}

settings()
{
    printf 'series\tscene\tsweep\tvalue\n'
    local s v
    for s in ${made_scenes-}; do
        for v in $qualities; do printf '%s\t%s\tqualities\t-\n' "$v" "$s"; done
    done
    for s in $found_scenes; do
        if wanted ends; then
            [[ " $full " != *" $s "* ]] || printf '%s\t'"$s"'\tends\t-\n' 'all pairs, film size' 'drawn anew'
            for v in 'all pairs, small' 'longest pairs' 'plan_path'; do printf '%s\t%s\tends\t-\n' "$v" "$s"; done
        fi
        if wanted limits; then for v in ${BENCH_SIDES:-120 160 240 320 480 640 1200}; do printf 'check_side\t%s\tlimits\t%s\n' "$s" "$v"; done; fi
    done
}

pairs() # NAME ARGS...
{
    local of=$work/$1; shift
    measured "$B/tests/bench/move_pairs" --threads "$threads" --views "$of/views" --depth "$of/depth" --validity "$of/validity/validity.txt" "$@"
}

sample() # SERIES SCENE SWEEP VALUE
{
    if [ "$3" = qualities ]; then
        awk -v scene="$2" -v quality="$1" '$1 == scene { if ($4 > best) best = $4; if ($2 == quality) { a = $3; p = $4; h = $5 } }
            END { printf "angle %.4g\nparallax %.4g\nworst_h %.3g\n", a, p, h; if (best > 0) printf "reached %.4g\n", 100 * p / best }' "$work/qualities"
        return
    fi
    local of=$work/$2
    if [ "$3" = limits ]; then
        mkdir -p "$fast/v"
        export -f validity; export work B threads
        # once without the comparison for the time, once with it for the error
        measured bash -c 'validity "$@"' - "$2" "$fast/v" --set "check_side=$4" --set check_cells=0 >"$fast/used" || return
        sed -n 'p; s/^cpu_seconds /core_s /p' "$fast/used"
        if [ ! -e "$of/limits-$4" ]; then
            validity "$2" "$fast/v" --set "check_side=$4" --set "check_cells=${BENCH_CELLS:-12}" 2>"$work/messages" || return
            sed -nE 's/.*in full pictures ([0-9]+) of ([0-9]+) limits .* (worst|largest error) is ([0-9]+) .*/\1 \2 \4/p' "$work/messages" |
                awk '{ n = 1; printf "limits %d\nerror %.4g\nunit %%\nreached %.4g\nworst_steps %d\n", $2, 100 * (1 - $1 / $2), 100 * $1 / $2, $3 }
                    END { if (!n) print "limits 0" }' >"$of/limits-$4"
        fi
        cat "$of/limits-$4"
        return
    fi
    [ -e "$of/best" ] || pairs "$2" --all >"$of/best" || return
    case $1 in
    'all pairs, film size') pairs "$2" --all --set parallax_side=1280 ;;
    'drawn anew') pairs "$2" --all --anew --set parallax_side=1280 ;;
    'all pairs, small') pairs "$2" --all ;;
    'longest pairs') pairs "$2" --set refine=no ;;
    *) pairs "$2" ;;
    esac >"$fast/pairs" || return
    cat "$fast/pairs"
    awk '{ v[FNR == NR, $1] = $2 } END { if (v[1, "parallax"] > 0) printf "reached %.4g\n", 100 * v[0, "parallax"] / v[1, "parallax"] }' "$of/best" "$fast/pairs"
}
