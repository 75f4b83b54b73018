# settings that are chosen without the scene that is reported, on tables with a known answer, and the true cameras of a scene
. tests/lib.sh

# rows "scene setting value", separated by blanks, on standard input; chosen BETTER FORMAT: the result, its columns separated by blanks
chosen() { tr ' ' '\t' | awk -v better="$1" -v format="${2-}" -f tests/bench/left_out.awk | tr '\t' ' ' >"$scratch/out"; }
has() { grep -qxF -- "$1" "$scratch/out" || { cat "$scratch/out"; fail "no line '$1'"; }; }
lines() { [ "$(wc -l <"$scratch/out")" = "$1" ] || { cat "$scratch/out"; fail "wanted $1 lines"; }; }

# x is best on a alone, so a must not get it: without a, y is best. b and c get x from a.
the_setting_comes_from_the_other_scenes()
{
    chosen lower <<'TXT'
a default 10
a x 1
a y 12
b default 5
b x 6
b y 4
c default 5
c x 6
c y 4
TXT
    [ "$(sed -n 1p "$scratch/out")" = "scene default left_out change best best_change chosen best_setting" ] || { cat "$scratch/out"; fail "wrong columns"; }
    has "a 10.00 12.00 +2.00 1.00 -9.00 y x"
    has "b 5.00 6.00 +1.00 4.00 -1.00 x y"
    has "mean 6.67 8.00 +1.33 3.00 -3.67 - -"
    lines 5
}

of_psnr_the_highest_is_chosen()
{
    chosen higher %.1f <<'TXT'
a default 20
a x 21
a y 19.5
b default 30
b x 29
b y 33
c default 25
c x 25.5
c y 24
TXT
    has "a 20.0 19.5 -0.5 21.0 +1.0 y x" # without a: 27.5, 27.25, 28.5
    has "b 30.0 29.0 -1.0 33.0 +3.0 x y" # without b: 22.5, 23.25, 21.75
    has "c 25.0 24.0 -1.0 25.5 +0.5 y x" # without c: 25, 25, 26.25
}

# in floating point 0.1 + 0.2 + 0.3 is more than 0.3 + 0.2 + 0.1, and 0.4 + 0.2 + 0.1 more than 0.1 + 0.4 + 0.2
the_default_wins_ties_and_then_the_first_does()
{
    chosen lower <<'TXT'
a x 0.4
a default 0.5
a y 0.1
b x 0.3
b default 0.1
b y 0.5
c x 0.2
c default 0.2
c y 0.4
d x 0.1
d default 0.3
d y 0.2
TXT
    has "a 0.50 0.50 0.00 0.10 -0.40 default y"
    has "b 0.10 0.30 +0.20 0.10 0.00 x default"
    has "c 0.20 0.20 0.00 0.20 0.00 x default"
    has "d 0.30 0.30 0.00 0.10 -0.20 default x"
}

one_scene_has_nothing_to_choose_on()
{
    chosen lower <<'TXT'
a default 5
a x 4
TXT
    has "# only one scene: there is none to choose on, so the default is chosen"
    has "a 5.00 5.00 0.00 4.00 -1.00 default x"
    has "mean 5.00 5.00 0.00 4.00 -1.00 - -"
    lines 4
}

# x has no value on c, so it can be chosen for none of the three; y has none on d, which has no value of the default either
a_missing_value_rules_a_setting_out()
{
    chosen lower <<'TXT'
a default 5
a x 1
a y 4
b default 5
b x 1
b y 4
c default 5
c x -
c y 6
d default -
d x 1
d y -
TXT
    has "# d takes no part: the default has no value there"
    has "a 5.00 5.00 0.00 1.00 -4.00 default x"
    has "b 5.00 5.00 0.00 1.00 -4.00 default x"
    has "c 5.00 6.00 +1.00 5.00 0.00 y default"
    lines 6
    chosen lower <<<"a x 1"
    has "# a takes no part: the default has no value there"
    lines 2
}

# parts neither choose nor count in the mean; c/d is part of nothing
parts_of_a_scene_get_its_setting()
{
    chosen lower <<'TXT'
a default 5
a x 6
a/one default 8
a/one x 1
a/two default 2
a/two x 3
b default 5
b x 4
c/d default 5
c/d x 5.5
TXT
    has "a 5.00 6.00 +1.00 5.00 0.00 x default"
    has "a/one 8.00 1.00 -7.00 1.00 -7.00 x x"
    has "a/two 2.00 3.00 +1.00 2.00 0.00 x default"
    has "b 5.00 5.00 0.00 4.00 -1.00 default x"
    has "c/d 5.00 5.00 0.00 5.00 0.00 default default"
    has "mean 5.00 5.33 +0.33 4.67 -0.33 - -"
    lines 7
}

a_bench_writes_the_table_at_its_end()
{
    mkdir -p "$scratch/benches"
    cat >"$scratch/benches/chosen.sh" <<'SH'
x=effort
settings() { printf 'series\tscene\tvalue\n'; for s in a b; do for v in default u=2; do printf 'ours\t%s\t%s\n' $s $v; done; done; }
sample() { printf 'seconds 1\npeak_mib 1\neffort -\n'; case $2$3 in adefault) echo error 5 ;; au=2) echo error 4 ;; bdefault) echo error 2 ;; bu=2) echo error 3 ;; esac; }
finish() { awk -F'\t' '!/^#/ && $1 != "series" { print $2 "\t" $3 "\t" $9 }' "$1" | left_out lower %.1f; }
SH
    BENCHES=$scratch/benches BENCH_OUT=$scratch/tables REPEATS=1 tests/bench/run chosen "$B" >"$scratch/said" 2>"$scratch/err" || { cat "$scratch/err"; fail "the bench failed"; }
    tr '\t' ' ' <"$scratch/tables/chosen_left_out.tsv" >"$scratch/out"
    has "a 5.0 5.0 0.0 4.0 -1.0 default u=2"
    has "b 2.0 3.0 +1.0 2.0 0.0 u=2 default"
    matches "^table  $scratch/tables/chosen_left_out.tsv" <"$scratch/said" || { cat "$scratch/said"; fail "the table is not named"; }
    matches "no plot was drawn, because no row has both effort and error" <"$scratch/err" || { cat "$scratch/err"; fail "nothing says why there is no plot"; }
}

# a turned by 180 degrees about x, b by 120 about the diagonal
true_cameras_become_a_model()
{
    mkdir -p "$scratch/true" "$scratch/model"
    printf '100 0 50\n0 100 40\n0 0 1\n0 0 0\n1 0 0\n0 -1 0\n0 0 -1\n1 2 3\n100 80\n' >"$scratch/true/a.jpg.camera"
    printf '100 0 50\n0 100 40\n0 0 1\n0 0 0\n0 0 1\n1 0 0\n0 1 0\n1 2 3\n100 80\n' >"$scratch/true/b.jpg.camera"
    awk -v size=50,40 -v to="$scratch/model" -f tests/bench/true_cameras.awk "$scratch"/true/*.camera || fail "the model was not written"
    diff - "$scratch/model/cameras.txt" <<'TXT' || fail "other lenses"
1 PINHOLE 50 40 50 50 25.25 20.25
2 PINHOLE 50 40 50 50 25.25 20.25
TXT
    diff - "$scratch/model/images.txt" <<'TXT' || fail "other poses"
1 0 1 0 0 -1 2 3 1 a.jpg

2 0.5 -0.5 -0.5 -0.5 -2 -3 -1 2 b.jpg

TXT
    [ -e "$scratch/model/points3D.txt" ] || fail "there is no file of points"
    sed -i 's/^0 0 0$/0.1 0 0/' "$scratch/true/b.jpg.camera"
    ! awk -v size=50,40 -v to="$scratch/model" -f tests/bench/true_cameras.awk "$scratch"/true/*.camera 2>"$scratch/err" || fail "a distorted lens was accepted"
    matches 'b.jpg.camera:4: found the distortion 0.1 0 0, wanted zeros' <"$scratch/err" || { cat "$scratch/err"; fail "another message"; }
    sed -i '9d' "$scratch/true/a.jpg.camera"
    ! awk -v size=50,40 -v to="$scratch/model" -f tests/bench/true_cameras.awk "$scratch/true/a.jpg.camera" 2>"$scratch/err" || fail "a camera without a size was accepted"
    matches 'a.jpg.camera: found no size in line 9' <"$scratch/err" || { cat "$scratch/err"; fail "another message"; }
}

for t in the_setting_comes_from_the_other_scenes of_psnr_the_highest_is_chosen the_default_wins_ties_and_then_the_first_does one_scene_has_nothing_to_choose_on \
    a_missing_value_rules_a_setting_out parts_of_a_scene_get_its_setting a_bench_writes_the_table_at_its_end true_cameras_become_a_model; do run "$t"; done
