# sample_validity: the regions of a small scene; bad arguments
. tests/lib.sh
project validity
photos set --views 3 --size 160x120 >/dev/null
small t
sed -i 's/^planes = .*/planes = 32\nrounds = 0/' scenes/t/scene.cfg
make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=t subjects >log 2>&1 || { cat log; fail "make"; }

# sample CODE WORD ARGUMENT...
sample()
{
    local code=$1 word=$2 rc=0; shift 2
    rm -rf made
    "$B/bin/sample_validity" --views out/t/views --depth "${depth:-out/t/depth}" --out made --set grid=3 --set max_side=96 "$@" >out.txt 2>err.txt </dev/null || rc=$?
    [ "$rc" = "$code" ] || { cat err.txt; fail "$*: exit $rc, wanted $code"; }
    grep -qF -- "$word" err.txt || { cat err.txt; fail "$*: nothing says '$word'"; }
    [ "$code" = 0 ] || { grep -q 'sample_validity: error: .*[.?]$' err.txt && [ -z "$(find made -type f 2>/dev/null)" ]; } || { cat err.txt; fail "$*: no sentence, or a file was left"; }
}

regions_and_their_picture_are_made()
{
    sample 0 'cells are valid' --effect establishing_dolly --threads 1
    [ "$(grep -c '^cell ' made/validity.txt)" = 18 ] || { cat made/validity.txt; fail "not nine cells an end"; }
    [ -s made/validity.png ] || fail "no picture"
    ! grep -qF "$PWD" made/validity.txt || fail "the file names a folder of this machine"
    cp made/validity.txt one.txt
    sample 0 'cells are valid' --effect establishing_dolly --threads 2
    cmp one.txt made/validity.txt
}

bad_arguments_are_refused_with_a_sentence()
{
    sample 2 'did you mean establishing_dolly?' --effect establishing_doly
    sample 2 'not a known image effect' --effect dolly_in+blur
    sample 2 'takes no image effect' --effect establishing_dolly+dim
    sample 2 'only dolly has two' --effect dolly_in+pull_focus --subjects "$(two)"
    sample 2 'effect is missing'
    sample 2 'dolly_in needs 1 subject, and the scene has 0' --effect dolly_in
    sample 2 'dolly needs 2 subjects, and the scene has 0' --effect dolly --subjects out/t/parallax/subjects.txt
    sample 1 nowhere.txt --effect dolly_in --subjects nowhere.txt
    depth=nowhere sample 1 nowhere --effect establishing_dolly
    sample 1 nowhere --effect establishing_dolly --records nowhere
}
two()
{
    printf 'remodel-subjects 1\nsubjects 2\n' >two.txt
    for i in 1 2; do printf 'subject v user 0 0 9 9 5 0 0 0\ncorner 0 0 5\ncorner 1 0 5\ncorner 1 1 5\ncorner 0 1 5\n' >>two.txt; done
    echo two.txt
}

for t in regions_and_their_picture_are_made bad_arguments_are_refused_with_a_sentence; do run "$t"; done
