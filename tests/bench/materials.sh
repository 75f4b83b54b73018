# materials.sh - how near fitted materials are to 200 simulated ones, by the number of views.
#
# tests/bench/materials.c says how a truth is made and when it is met: the right model, k_d within 2 %, k_s within 10 %,
# n or alpha within 15 %. error: fraction of truths that are not met. Of Lambertian truths: the fraction that is not found
# to be Lambertian, or whose k_d is off. The columns to_quarter to beyond are a histogram of a truth's largest error over
# its target. BENCH_TRUTHS (200), BENCH_VIEWS ("1 2 6"), BENCH_NOISE ("10": thousandths).
title="Materials from simulated samples"
note="At most 400 samples of a floor with 1 % noise, 200 random truths of each model."
line=series label=views panel=noise
x=views x_label="Views" y=error y_label="Truths that are not met (fraction)"
repeats=1

settings()
{
    printf 'series\tviews\tnoise\n'
    for noise in ${BENCH_NOISE:-10}; do for kind in phong ward lambert; do for views in ${BENCH_VIEWS:-1 2 6}; do
        printf '%s\t%s\t%s\n' "$kind" "$views" "$noise"
    done; done; done
}

prepare()
{
    [ -x "$B/tests/bench/materials" ] || missing "there is no program $B/tests/bench/materials; this revision fits no materials."
}

sample() # SERIES VIEWS NOISE
{
    measured "$B/tests/bench/materials" --kind "$1" --views "$2" --noise "$3" --truths "${BENCH_TRUTHS:-200}"
}
