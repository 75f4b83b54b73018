# suggest.sh - suggested models of flats and rooms that a seed decides, against their true plans.
#
# Series:
#   flat   made_house of each seed of BENCH_FLATS ("1 2"): BENCH_ROOMS (4) rooms, six photos of 480 x 320 pixels in each,
#          one exposure, whose lamps and windows are blown out. Its plan.txt is the truth.
#   room   made_room of each seed of BENCH_SEEDS ("1 2"), in three exposures; the truth is the model of its marks.
# The cameras are the true ones, so that the figures are of the suggestion. Everything else is what a run finds at draft
# quality, in out/bench/suggest; what is there is made again only if it depends on what changed. A flat of four rooms takes
# ten core-minutes, a room four.
#
# walls: intersection over union of the lengths of the rooms' sides, those within 5 cm of each other. rooms, doors, windows:
# how many there are, how many are found (rooms by nine tenths of their area, openings by half of it), how many are
# suggested. walls_error, openings_error, thickness_error, ceiling_error, floor_error: medians, m
# (tests/bench/plan_score.c). failed: 1 if no plan could be built.
# out/bench/suggest_summary.txt: means and F1 of each series.
BENCH_LIGHT='' . "${BENCHES:-tests/bench}/things.sh"
title="Suggested models against the true plans"
note="Each point is a flat or a room that nobody tuned on. Upper left is better."
x=walls_error x_label="Distance of walls (m), median" y=walls y_label="Intersection over union of walls"
line=series label=scene panel=
timed=core_s
project=$PWD/out/bench/suggest seeds=${BENCH_SEEDS-1 2}
flats=${BENCH_FLATS-1 2}
rooms=${BENCH_ROOMS:-4}

prepare_room() { describe "$1" "$2"; } # SEED NAME
truth_of() { echo "$project/out/$1/simulated/truth"; } # SCENE

settings()
{
    local s
    printf 'series\tscene\n'
    for s in $flats; do printf 'flat\tflat%s\n' "$s"; done
    for s in $seeds; do printf 'room\tmade%s\n' "$s"; done
}

# the scene of a flat; files that are the same stay, so that nothing is made again
describe_flat() # SEED NAME
{
    rm -rf "${work:?}/$2"
    quietly "$B/tests/bench/made_house" --seed "$1" --rooms "$rooms" --views "$((6 * rooms))" --exposures 1 --out "$work/$2"
    diff -rq "$work/$2" "$project/scenes/$2" >/dev/null 2>&1 || { rm -rf "$project/scenes/$2"; cp -r "$work/$2" "$project/scenes/$2"; }
}

tried() { say "make $*"; "${MAKE:-make}" -C "$project" --no-print-directory DEPS=manual QUALITY=draft "$@" >"$work/messages" 2>&1; }

sample() # SERIES SCENE
{
    local o=$project/out/$2+draft truth against
    [ "$1" = room ] || describe_flat "${2#flat}" "$2"
    times >"$work/began"
    truth=$(truth_of "$2")
    against=(--truth "$o/model/plan.txt")
    [ "$1" = room ] || against=(--truth "$project/scenes/$2/plan.txt" --axes "$o/model/axes.txt")
    if tried SCENE="$2" hdr && tried SCENE="$2" SFM="$truth" suggest && { [ "$1" = flat ] || tried SCENE="$2" SFM="$truth" model; } &&
        "$B/bin/build_model" --script "$o/model/suggested.txt" --axes "$o/model/axes.txt" --out "$fast/built" >"$work/messages" 2>&1 &&
        "$B/tests/bench/plan_score" "${against[@]}" --plan "$fast/built/plan.txt" >"$fast/score" 2>"$work/messages"; then
        echo "failed 0"
        cat "$fast/score"
    else
        echo "failed 1"
        say "$2: $(grep -E 'error:|^make' "$work/messages" | sed -n 1p)"
    fi
    times >"$work/ended"
    awk 'NR % 2 == 0 { for (i = 1; i <= 2; i++) { split($i, t, "m"); s[FILENAME] += 60 * t[1] + t[2] } }
        END { printf "core_s %.4g\n", s[ARGV[2]] - s[ARGV[1]] }' "$work/began" "$work/ended"
}

finish() # TABLE
{
    awk -F'\t' '
        /^#/ { next }
        !n { n = NF; for (i = 1; i <= n; i++) at[$i] = i; next }
        { s = $at["series"]; all[s]++; failed[s] += $at["failed"]
          if ($at["failed"]) next
          m = split("walls walls_error openings_error thickness_error ceiling_error floor_error", means, " ")
          for (i = 1; i <= m; i++) if (at[means[i]] && $at[means[i]] != "-") { sum[s, means[i]] += $at[means[i]]; count[s, means[i]]++ }
          k = split("rooms doors windows", kinds, " ")
          for (i = 1; i <= k; i++) { there[s, i] += $at[kinds[i]]; found[s, i] += $at[kinds[i] "_found"]; made[s, i] += $at[kinds[i] "_suggested"] } }
        END { for (s in all) { printf "%s: %d, of which %d failed\n", s, all[s], failed[s]
            for (i = 1; i <= m; i++) if (count[s, means[i]]) printf "  %s: mean %.4g\n", means[i], sum[s, means[i]] / count[s, means[i]]
            for (i = 1; i <= k; i++) if (there[s, i] + made[s, i]) printf "  %s: F1 %.1f %%, %d found of %d, %d suggested\n", kinds[i], 200 * found[s, i] / (there[s, i] + made[s, i]), found[s, i], there[s, i], made[s, i] } }' "$1" |
        tee "$out/suggest_summary.txt"
}
