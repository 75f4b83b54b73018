# the bench harness: medians, ratios, counts that must repeat, plots, slopes, comparison of two revisions
. tests/lib.sh

export BENCHES=$scratch/benches BENCH_OUT=$scratch/tables REPEATS=3
mkdir -p "$BENCHES"
bench() { local code=$1 rc=0; shift; tests/bench/run "$@" >"$scratch/out" 2>"$scratch/err" || rc=$?; [ "$rc" = "$code" ] || { cat "$scratch/out" "$scratch/err"; fail "$*: exit $rc, wanted $code"; }; }
says() { grep -qF -- "$1" "$scratch/out" "$scratch/err" || { cat "$scratch/out" "$scratch/err"; fail "the output does not have '$1'"; }; }
# cell TABLE SERIES KNOB COLUMN
cell() { awk -F'\t' -v s="$2" -v k="$3" -v c="$4" '/^#/ { next } !n { n = NF; for (i = 1; i <= n; i++) if ($i == c) at = i; next } $1 == s && $2 == k { print $at }' "$1"; }

# ours takes knob times 1, 3 and 2 seconds in the three repeats, the baseline twice that; the error falls as 1/sqrt(seconds)
trivial()
{
    cat >"$BENCHES/trivial.sh" <<'SH'
title="A trivial bench" baseline=theirs match=knob label=knob slope=seconds rate=things y_label="Error"
settings() { printf 'series\tknob\n'; for k in 1 10 100; do printf 'ours\t%s\ntheirs\t%s\n' $k $k; done; }
sample()
{
    n=$(cat "$work/$1.$2" 2>/dev/null || echo 0); echo $((n + 1)) >"$work/$1.$2"
    measured true || return
    awk -v s="$1" -v k="$2" -v n="$n" 'BEGIN { split("1 3 2", f, " "); t = k * f[n % 3 + 1] * (s == "ours" ? 1 : 2)
        printf "seconds %g\nerror %.9g\nunit px\nthings %d\n", t, 1 / sqrt(2 * k * (s == "ours" ? 1 : 2)), 10 * k }'
}
SH
}

a_trivial_bench_writes_the_right_table()
{
    trivial; bench 0 trivial "$B"
    t=$BENCH_OUT/trivial.tsv
    [ "$(sed -n '/^#/!{p;q}' "$t" | tr '\t' ' ')" = "series knob seconds seconds_least seconds_most ratio peak_mib error unit things things_per_s" ] || { cat "$t"; fail "wrong columns"; }
    [ "$(grep -vc '^#' "$t")" = 7 ] || fail "wanted one row for each setting"
    [ "$(cell "$t" ours 10 seconds)" = 20 ] && [ "$(cell "$t" ours 10 seconds_least)" = 10 ] && [ "$(cell "$t" ours 10 seconds_most)" = 30 ] || { cat "$t"; fail "the median is wrong"; }
    [ "$(cell "$t" ours 10 ratio)" = 0.500 ] && [ "$(cell "$t" theirs 100 ratio)" = 1.000 ] || { cat "$t"; fail "the ratio is wrong"; }
    [ "$(cell "$t" ours 100 things)" = 1000 ] && [ "$(cell "$t" ours 100 things_per_s)" = 5 ] && [ "$(cell "$t" ours 100 unit)" = px ] || { cat "$t"; fail "counts are wrong"; }
    awk -v p="$(cell "$t" ours 1 peak_mib)" 'BEGIN { exit !(p > 0.1 && p < 100) }' || fail "wrong peak memory for a small program"
    says "slope of log error over log seconds, ours: -0.500"
}

the_plot_is_an_svg_with_every_series()
{
    command -v gnuplot >/dev/null || skip "gnuplot is not installed"
    trivial; bench 0 trivial "$B"
    s=$BENCH_OUT/trivial.svg
    grep -q '<svg ' "$s" && grep -q '</svg>' "$s" || fail "no SVG"
    for w in 'A trivial bench' ours theirs 'Time (s)' Error 100; do grep -qF ">$w" "$s" || grep -qF "$w</" "$s" || fail "the plot has no '$w'"; done
    [ "$(grep -c 'stroke-dasharray' "$s")" -gt 0 ] || fail "the baseline is not dashed"
    cp "$s" "$scratch/first.svg"
    tests/bench/plot "$BENCH_OUT/trivial.tsv" "$s" seconds 'Time (s)' error Error series knob "" theirs
    ! grep -q 'A trivial bench' "$s" || fail "the plot was not redrawn"
    rm "$s"
    ! tests/bench/plot "$BENCH_OUT/trivial.tsv" "$s" seconds T depth D series "" "" "" 2>"$scratch/err" || fail "a missing column was drawn"
    grep -q 'no column' "$scratch/err" && [ ! -e "$s" ] || fail "the message does not name the missing column"
}

# the errors are 1/sqrt(seconds): ours have 2, 20 and 200 s, and theirs twice that
what_an_error_costs_is_interpolated()
{
    trivial
    sed -i 's|slope=seconds|slope=seconds reach="0.1 0.05 0.9" panel=unit orders=things|' "$BENCHES/trivial.sh"
    bench 0 trivial "$B"
    says "px, ours: error 0.1 at 100 seconds, 1 of the theirs"
    says "px, theirs: error 0.1 at 100 seconds"
    says "px, ours: error 0.05 at more than 200 seconds"
    says "px, ours: error 0.9 at less than 2 seconds"
    says "slope of log error over log seconds, ours px: -0.500"
    ! command -v gnuplot >/dev/null || grep -qF '>n^-0.50' "$BENCH_OUT/trivial.svg" || grep -qF 'n^-0.50<' "$BENCH_OUT/trivial.svg" || fail "the plot does not show the order"
}

values_other_than_times_must_repeat()
{
    trivial
    sed -i 's|things %d\\n", t|things %d\\n", t + 0 * n|; s|10 \* k }|10 * k + n }|' "$BENCHES/trivial.sh"
    bench 1 trivial "$B"; says "things was 10 and is 11 in repeat 2"
}

columns_listed_as_timed_need_not_repeat()
{
    trivial
    sed -i 's|rate=things|rate=things timed=laps|; s|things %d\\n", t|things %d\\nlaps %d\\n", t|; s|10 \* k }|10 * k, 7 + n }|' "$BENCHES/trivial.sh"
    bench 0 trivial "$B"
    [ "$(cell "$BENCH_OUT/trivial.tsv" ours 10 laps)" = 8 ] || { cat "$BENCH_OUT/trivial.tsv"; fail "the column does not have the median"; }
}

a_failing_sample_is_named()
{
    trivial
    sed -i 's|measured true|measured sh -c "echo no paper >\&2; exit 3"|' "$BENCHES/trivial.sh"
    rm -f "$BENCH_OUT/trivial.tsv"
    bench 1 trivial "$B"; says "'ours 1'"; says "no paper"
    [ ! -e "$BENCH_OUT/trivial.tsv" ] || fail "a table was left"
}

missing_programs_and_benches_are_named()
{
    bench 2 nothing "$B"; says "no bench 'nothing'"
    REPEATS=few bench 2 trivial "$B"; says "REPEATS=few"
    unset BENCHES
    bench 3 simulate "$scratch/no-build"; says "no program $scratch/no-build/bin/simulate"
}

two_builds_are_compared_pair_by_pair()
{
    trivial
    sed -i 's|n=$(cat "$work/$1.$2"|B0=${B##*/}; n=$(cat "$work/$B0.$1.$2"|; s|>"$work/$1.$2"|>"$work/$B0.$1.$2"|; s|awk -v s|awk -v old=$([ $B0 = old ] \&\& echo 1 \|\| echo 0) -v s|; s|things %d\\n", t,|things %d\\n", t * (1 + old),|; s|10 \* k }|10 * k - old }|' "$BENCHES/trivial.sh"
    mkdir -p "$scratch/old/tests"; ln -sfn "$root/$B/tests/bench" "$scratch/old/tests/bench"
    bench 0 trivial "$B" before "$scratch/old"
    t=$BENCH_OUT/trivial-before.tsv
    [ "$(cell "$t" ours 10 seconds_old)" = 40 ] && [ "$(cell "$t" ours 10 seconds_new)" = 20 ] || { cat "$t"; fail "the medians are wrong"; }
    [ "$(cell "$t" ours 10 ratio)$(cell "$t" ours 10 ratio_least)$(cell "$t" ours 10 ratio_most)" = 0.5000.5000.500 ] || { cat "$t"; fail "the ratios are wrong"; }
    [ "$(cell "$t" ours 10 changed)" = "things 99 -> 100" ] || { cat "$t"; fail "a changed count is not shown"; }
    says "geometric mean of the ratios, ours: 0.500"; says "geometric mean of the ratios, theirs: 0.500"
}

a_comparison_names_its_missing_arguments()
{
    export MAKEFLAGS=
    ! tests/bench/compare "" "" "$B" true 2>"$scratch/err" || fail "a comparison without a name ran"
    grep -q 'NAME=exr OLD=' "$scratch/err" || fail "the message does not name the arguments"
    ! tests/bench/compare nothing HEAD "$B" true 2>"$scratch/err" || fail "an unknown bench was accepted"
    ! tests/bench/compare exr no-such-revision "$B" true 2>"$scratch/err" || fail "an unknown revision was accepted"
    grep -q 'no-such-revision' "$scratch/err" || fail "the message does not name the revision"
}

# a sphere of linear radiance has a closed form: errors fall by four as pixels do
the_bench_of_irradiance_knows_a_sphere()
{
    local i=$B/tests/bench/irradiance
    "$i" --case sphere --converge "$scratch/truth.txt"
    for n in 32 64; do "$i" --case sphere --estimator hemicube --effort $n --truth "$scratch/truth.txt" >"$scratch/$n.txt"; done
    awk '$1 == "error" { e[++n] = $2 } END { exit !(e[1] < 2e-4 && e[1] / e[2] > 3.5 && e[1] / e[2] < 4.5) }' "$scratch/32.txt" "$scratch/64.txt" || { cat "$scratch"/{32,64}.txt; fail "the hemicube is not of first order in its rays"; }
    ! "$i" --case cornell --converge "$scratch/truth.txt" 2>"$scratch/err" || fail "the Cornell box was made of nothing"
    grep -q 'needs --folder' "$scratch/err" || fail "the message does not name the option"
}

benches_of_irradiance_leave_out_what_is_not_there()
{
    unset BENCHES
    BENCH_CASES=cornell BENCH_CORNELL=$scratch/none BENCH_SCENES=nowhere bench 2 irradiance "$B"
    says "cornell is left out"; says "nowhere is left out"
    BENCH_SCENES=nowhere bench 3 irradiance_scenes "$B"; says "nowhere is left out"
}

for t in a_trivial_bench_writes_the_right_table the_plot_is_an_svg_with_every_series what_an_error_costs_is_interpolated values_other_than_times_must_repeat columns_listed_as_timed_need_not_repeat a_failing_sample_is_named \
    missing_programs_and_benches_are_named two_builds_are_compared_pair_by_pair a_comparison_names_its_missing_arguments \
    the_bench_of_irradiance_knows_a_sphere benches_of_irradiance_leave_out_what_is_not_there; do run "$t"; done
