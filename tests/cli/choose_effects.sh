# choose_effects: the effects that suit a scene's subjects; bad arguments
. tests/lib.sh
B=$root/$B
cd "$scratch" || exit 1

# subjects N RATIO: a list of N subjects, the second RATIO times as far away
subjects()
{
    printf 'remodel-subjects 1\nsubjects %d\n' "$1"
    for ((i = 0; i < $1; i++)); do
        local z; z=$(awk -v i="$i" -v r="$2" 'BEGIN { print i ? 5 * r : 5 }')
        printf 'subject v user 0 0 9 9 %s 0 0 0\ncorner 0 0 %s\ncorner 1 0 %s\ncorner 1 1 %s\ncorner 0 1 %s\n' "$z" "$z" "$z" "$z" "$z"
    done
}
# choose CODE WORD ARGUMENT...
choose()
{
    local code=$1 word=$2 rc=0; shift 2
    rm -f made.mk
    "$B/bin/choose_effects" --out made.mk "$@" >out.txt 2>err.txt </dev/null || rc=$?
    [ "$rc" = "$code" ] || { cat err.txt; fail "$*: exit $rc, wanted $code"; }
    grep -qF -- "$word" err.txt || { cat err.txt; fail "$*: nothing says '$word'"; }
    [ "$code" = 0 ] || { grep -q 'choose_effects: error: .*[.?]$' err.txt && [ ! -e made.mk ]; } || { cat err.txt; fail "$*: no sentence, or a file was left"; }
}
made() { sed -n 's/^EFFECTS := //p' made.mk; }

all_lists_the_effects_that_suit_the_subjects()
{
    subjects 0 1 >s.txt; choose 0 '0 subjects: 2 effects' --subjects s.txt --effect all
    [ "$(made)" = "establishing_dolly establishing_dolly_out" ] || { cat made.mk; fail "no subject"; }
    subjects 1 1 >s.txt; choose 0 '1 subject: ' --subjects s.txt --effect all
    made | matches 'dolly_zoom_in+dim' && ! made | matches -E 'pull_focus|(^| )dolly( |$|\+)' || { cat made.mk; fail "one subject"; }
    subjects 2 2 >s.txt; choose 0 '2 subjects: ' --subjects s.txt --effect all
    made | matches ' dolly+pull_focus' || { cat made.mk; fail "two subjects"; }
    subjects 2 1.1 >s.txt; choose 0 '2 subjects: ' --subjects s.txt --effect all
    made | matches -E ' dolly$' || { cat made.mk; fail "two subjects at about the same depth"; }
}

the_random_choice_depends_on_the_seed()
{
    subjects 1 1 >s.txt
    for seed in 1 2 3 4 5 6 7 8; do
        choose 0 "chosen at random (seed $seed)" --subjects s.txt --effect auto --set seed=$seed; one=$(made)
        choose 0 'chosen at random' --subjects s.txt --effect auto --set seed=$seed
        [ "$(made)" = "$one" ] || fail "the same seed chose another effect"
        [[ $one == dolly_* && $one != *" "* ]] || fail "$one is not an effect for one subject"
        echo "$one" >>drawn.txt
    done
    [ "$(sort -u drawn.txt | wc -l)" -gt 1 ] || fail "every seed chooses $one"
}

bad_arguments_are_refused_with_a_sentence()
{
    subjects 1 1 >s.txt
    choose 2 'wanted auto or all' --subjects s.txt --effect dolly_in
    choose 2 'effect is missing' --subjects s.txt
    choose 1 nowhere.txt --subjects nowhere.txt --effect all
    sed -i '3s/user/nobody/' s.txt
    choose 1 's.txt:3: found "nobody"' --subjects s.txt --effect all
}

for t in all_lists_the_effects_that_suit_the_subjects the_random_choice_depends_on_the_seed bad_arguments_are_refused_with_a_sentence; do run "$t"; done
