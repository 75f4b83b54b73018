# plan_path: a move of a small scene; bad arguments, regions of another move, a camera that cannot move
. tests/lib.sh
project planner
photos set --views 3 --size 160x120 >/dev/null
small t
sed -i 's/^planes = .*/planes = 32\nrounds = 0/' scenes/t/scene.cfg
make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=t depth >log 2>&1 || { cat log; fail "make"; }
"$B/bin/sample_validity" --views out/t/views --depth out/t/depth --set grid=3 --set max_side=96 --effect establishing_dolly --out . 2>log || { cat log; fail "sample_validity"; }

# plan CODE WORD ARGUMENT...
plan()
{
    local code=$1 word=$2 rc=0; shift 2
    rm -rf made
    "$B/bin/plan_path" --views out/t/views --depth out/t/depth --out made --set seconds=0.5 --set fps=10 "$@" >out.txt 2>err.txt </dev/null || rc=$?
    [ "$rc" = "$code" ] || { cat err.txt; fail "$*: exit $rc, wanted $code"; }
    grep -qF -- "$word" err.txt || { cat err.txt; fail "$*: nothing says '$word'"; }
    [ "$code" = 0 ] || { grep -q 'plan_path: error: .*[.?]$' err.txt && [ -z "$(find made -type f 2>/dev/null)" ]; } || { cat err.txt; fail "$*: no sentence, or a file was left"; }
}

a_move_is_planned_with_its_scores()
{
    plan 0 'parallax' --validity validity.txt --effect establishing_dolly --threads 1
    grep -qx 'FRAMES := 0001 0002 0003 0004 0005' made/frames.mk || { cat made/frames.mk; fail "frames"; }
    for s in length parallax worst_h h_limit; do grep -q "^score $s " made/path.txt || { cat made/path.txt; fail "no score $s"; }; done
    cp made/path.txt one.txt
    plan 0 'parallax' --validity validity.txt --effect establishing_dolly --threads 2
    cmp one.txt made/path.txt
}

bad_arguments_are_refused_with_a_sentence()
{
    plan 2 'did you mean establishing_dolly?' --validity validity.txt --effect establishing_doly
    plan 2 'is of another move' --validity validity.txt --effect establishing_dolly_out
    plan 2 'takes no image effect' --validity validity.txt --effect establishing_dolly+dim
    plan 2 'wanted --depth with --validity' --effect establishing_dolly
    plan 2 'effect is missing' --validity validity.txt
    plan 2 'fewer than two frames' --validity validity.txt --effect establishing_dolly --set seconds=0.1
    plan 1 nowhere.txt --validity nowhere.txt --effect establishing_dolly
    sed 's/^effect .*/effect dolly_in/' validity.txt >other.txt
    plan 2 'dolly_in needs 1 subject, and the scene has 0' --validity other.txt --effect dolly_in
    plan 1 nobody.txt --validity other.txt --effect dolly_in --subjects nobody.txt
    sed 's/^step .*/step zero/' validity.txt >broken.txt
    plan 1 "broken.txt:$(grep -n '^step' broken.txt | cut -d: -f1): found \"zero\"" --validity broken.txt --effect establishing_dolly
}

a_camera_that_cannot_move_causes_a_warning()
{
    awk '/^region/ { first = 1 } /^cell/ { if (first) print "cell 0 0 from 0 to 0"; else print $1, $2, $3, "none"; first = 0; next } 1' validity.txt >still.txt
    plan 0 'the camera does not move' --validity still.txt --effect establishing_dolly --set refine=no
    sed -i 's/ from .*/ none/' still.txt
    plan 1 'nowhere to go' --validity still.txt --effect establishing_dolly
}

a_film_that_seems_to_stand_still_causes_a_warning_at_the_end()
{
    mkdir -p end/parallax/{establishing_dolly,good}
    plan 0 'and shows hardly any parallax' --validity validity.txt --effect establishing_dolly --set max_angle=0.1
    cp made/path.txt end/parallax/establishing_dolly/
    plan 0 'parallax' --validity validity.txt --effect establishing_dolly
    cp made/path.txt end/parallax/good/
    # shellcheck disable=SC2016
    O=end goal=report bash -euo pipefail -c '. stages/plan_path/run.sh; end_plan_path' 2>words
    grep -q '^warning: film establishing_dolly: its camera moves through only 0[0-9.]* degrees' words || { cat words; fail "no warning"; }
    ! grep -q 'film good' words || fail "a warning of a good film"
}

for t in a_move_is_planned_with_its_scores bad_arguments_are_refused_with_a_sentence a_camera_that_cannot_move_causes_a_warning \
    a_film_that_seems_to_stand_still_causes_a_warning_at_the_end; do run "$t"; done
