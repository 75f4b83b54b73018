# the harness of benches: medians, ratios, counts that must repeat, plots, slopes, two revisions
. tests/lib.sh

export BENCHES=$scratch/benches BENCH_OUT=$scratch/tables REPEATS=3
mkdir -p "$BENCHES"
bench() { local code=$1 rc=0; shift; tests/bench/run "$@" >"$scratch/said" 2>"$scratch/err" || rc=$?; [ "$rc" = "$code" ] || { cat "$scratch/said" "$scratch/err"; fail "$*: exit $rc, wanted $code"; }; }
says() { grep -qF -- "$1" "$scratch/said" "$scratch/err" || { cat "$scratch/said" "$scratch/err"; fail "nothing says '$1'"; }; }
# cell TABLE SERIES KNOB COLUMN
cell() { awk -F'\t' -v s="$2" -v k="$3" -v c="$4" '/^#/ { next } !n { n = NF; for (i = 1; i <= n; i++) if ($i == c) at = i; next } $1 == s && $2 == k { print $at }' "$1"; }

# seconds of ours: 1/knob times 1, 3 and 2 in the three repeats; of the baseline twice that; error falls as 1/sqrt(seconds)
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
    [ "$(sed -n '/^#/!{p;q}' "$t" | tr '\t' ' ')" = "series knob seconds seconds_least seconds_most ratio peak_mib error unit things things_per_s" ] || { cat "$t"; fail "other columns"; }
    [ "$(grep -vc '^#' "$t")" = 7 ] || fail "not a row a setting"
    [ "$(cell "$t" ours 10 seconds)" = 20 ] && [ "$(cell "$t" ours 10 seconds_least)" = 10 ] && [ "$(cell "$t" ours 10 seconds_most)" = 30 ] || { cat "$t"; fail "the median is wrong"; }
    [ "$(cell "$t" ours 10 ratio)" = 0.500 ] && [ "$(cell "$t" theirs 100 ratio)" = 1.000 ] || { cat "$t"; fail "the ratio is wrong"; }
    [ "$(cell "$t" ours 100 things)" = 1000 ] && [ "$(cell "$t" ours 100 things_per_s)" = 5 ] && [ "$(cell "$t" ours 100 unit)" = px ] || { cat "$t"; fail "counts are wrong"; }
    awk -v p="$(cell "$t" ours 1 peak_mib)" 'BEGIN { exit !(p > 0.1 && p < 100) }' || fail "the peak of memory is not that of a small program"
    says "slope of log error over log seconds, ours: -0.500"
}

the_plot_is_an_svg_with_every_line()
{
    command -v gnuplot >/dev/null || skip "gnuplot is not installed"
    trivial; bench 0 trivial "$B"
    s=$BENCH_OUT/trivial.svg
    grep -q '<svg ' "$s" && grep -q '</svg>' "$s" || fail "no SVG"
    for w in 'A trivial bench' ours theirs 'Time (s)' Error 100; do grep -qF ">$w" "$s" || grep -qF "$w</" "$s" || fail "the plot has no '$w'"; done
    [ "$(grep -c 'stroke-dasharray' "$s")" -gt 0 ] || fail "the baseline is not dashed"
    cp "$s" "$scratch/first.svg"
    tests/bench/plot "$BENCH_OUT/trivial.tsv" "$s" seconds 'Time (s)' error Error series knob "" theirs
    ! grep -q 'A trivial bench' "$s" || fail "the plot was not drawn again"
    rm "$s"
    ! tests/bench/plot "$BENCH_OUT/trivial.tsv" "$s" seconds T depth D series "" "" "" 2>"$scratch/err" || fail "a missing column was drawn"
    grep -q 'no column' "$scratch/err" && [ ! -e "$s" ] || fail "a missing column is not named"
}

what_is_no_time_must_repeat()
{
    trivial
    sed -i 's|things %d\\n", t|things %d\\n", t + 0 * n|; s|10 \* k }|10 * k + n }|' "$BENCHES/trivial.sh"
    bench 1 trivial "$B"; says "things was 10 and is 11 in repeat 2"
}

times_of_a_bench_s_own_need_not_repeat()
{
    trivial
    sed -i 's|rate=things|rate=things timed=laps|; s|things %d\\n", t|things %d\\nlaps %d\\n", t|; s|10 \* k }|10 * k, 7 + n }|' "$BENCHES/trivial.sh"
    bench 0 trivial "$B"
    [ "$(cell "$BENCH_OUT/trivial.tsv" ours 10 laps)" = 8 ] || { cat "$BENCH_OUT/trivial.tsv"; fail "the column has not the median"; }
}

a_failing_sample_is_named()
{
    trivial
    sed -i 's|measured true|measured sh -c "echo no paper >\&2; exit 3"|' "$BENCHES/trivial.sh"
    rm -f "$BENCH_OUT/trivial.tsv"
    bench 1 trivial "$B"; says "'ours 1'"; says "no paper"
    [ ! -e "$BENCH_OUT/trivial.tsv" ] || fail "a table was left"
}

a_bench_says_what_it_misses()
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

make_says_what_a_comparison_needs()
{
    export MAKEFLAGS=
    ! tests/bench/compare "" "" "$B" true 2>"$scratch/err" || fail "no name"
    grep -q 'NAME=exr OLD=' "$scratch/err" || fail "it does not say what to give"
    ! tests/bench/compare nothing HEAD "$B" true 2>"$scratch/err" || fail "an unknown bench"
    ! tests/bench/compare exr no-such-revision "$B" true 2>"$scratch/err" || fail "an unknown revision"
    grep -q 'no-such-revision' "$scratch/err" || fail "the revision is not named"
}

for t in a_trivial_bench_writes_the_right_table the_plot_is_an_svg_with_every_line what_is_no_time_must_repeat times_of_a_bench_s_own_need_not_repeat a_failing_sample_is_named \
    a_bench_says_what_it_misses two_builds_are_compared_pair_by_pair make_says_what_a_comparison_needs; do run "$t"; done
