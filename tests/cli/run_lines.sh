# run_lines.sh: lines of a plan that one process can make together; what fails, is killed, or does not fit
. tests/lib.sh
project lines
mkdir -p out
mkdir made
# a stage that makes several pieces: --n NAME each. bad: this one fails; killed: the process is killed in the middle of it
cat >stage <<'END'
#!/usr/bin/env bash
names=() i=0 failed=0
for word; do case $word in --*) ;; *) names+=("$word") ;; esac; done
echo "stage: process $$" >&2
if [ -e broken ]; then echo "stage: error: the model is broken." >&2; exit 1; fi
for n in "${names[@]}"; do
    i=$((i + 1)) word=made
    echo "stage: words of $n" >&2
    [ "$n" != killed ] || kill -9 $$
    if [ "$n" = bad ]; then word=failed failed=1; echo "stage: error: $n is bad." >&2; else echo $$ >"made/$n"; fi
    [ "${#names[@]}" = 1 ] || echo "stage: $word $i of ${#names[@]}: $n" >&2
done
exit $failed
END
chmod +x stage

# line NAME [ARGUMENT]: of a plan; alone NAME: one that no other can join
line() { printf 'made/%s\tcommon/run/run_stage.sh quiet stage %s out ./stage %s\t--n %s\n' "$1" "$1" "${2---same}" "$1"; }
alone() { printf 'made/%s\tcommon/run/run_stage.sh quiet stage %s out ./stage --n %s\n' "$1" "$1" "$1"; }
lines() { local n; for n; do line "$n"; done; }
# words CODE WORDS [FOLDER KIB]: runs the lines of `plan`; checks the exit status and what comes of each line
words()
{
    local rc=0 said
    rm -rf made out/log; mkdir made
    said=$(common/run/run_lines.sh "${@:3}" <plan 2>err | tr '\n' ' '; exit "${PIPESTATUS[0]}") || rc=$?
    [ "$said" = "$2 " ] || { cat err; fail "the lines ended with '$said', wanted '$2 '"; }
    [ "$rc" = "$1" ] || fail "exit $rc, wanted $1"
}
processes() { cat made/* | sort -u | wc -l; }

lines_that_differ_in_what_is_their_own_are_one_process()
{
    { lines a b c; line d --other; line e --other; alone f; alone g; } >plan
    words 0 '0 0 0 0 0 0 0'
    [ "$(processes)" = 4 ] || { head made/*; fail "wanted four processes: abc, de, f, g"; }
    grep -q 'words of b' out/log/stage.b.log || fail "the log of b lacks its words"
    ! grep -q 'words of [ac]' out/log/stage.b.log || fail "the log of b has words of others"
}

one_that_fails_is_named_and_the_others_are_made()
{
    lines a bad c >plan
    words 1 '0 1 0'
    grep -q '^stage: bad failed; the end of out/log/stage.bad.log says:' err || { cat err; fail "nothing says so"; }
    grep -q 'bad is bad' err || { cat err; fail "nothing says why"; }
    [ -e made/c ] || fail "c was not made"
    lines bad >plan; words 1 1
}

a_process_that_is_killed_loses_one_piece()
{
    lines a b killed d e >plan
    words 1 '0 0 137 0 0'
    [ "$(processes)" = 2 ] || fail "wanted a second process for d and e"
    grep -q '^stage: killed was ended by signal 9' err || { cat err; fail "nothing says so"; }
    lines killed >plan; words 1 137
    lines a killed >plan; words 1 '0 137'
}

what_all_share_fails_all()
{
    lines a b c >plan
    touch broken; words 1 '1 1 1'; rm broken
    for n in a b c; do grep -q 'the model is broken' out/log/stage.$n.log || fail "the log of $n does not say why"; done
}

nothing_begins_on_a_full_disk()
{
    { lines a b; alone c; } >plan
    words 1 'disk disk disk' . $((1 << 50))
    [ -z "$(ls made)" ] || fail "something was made"
    words 0 '0 0 0' . 1
}

no_process_gets_more_than_the_system_takes()
{
    for n in $(seq 450); do line "n$n"; done >plan
    words 0 "$(seq 450 | sed 's/.*/0/' | tr '\n' ' ' | sed 's/ $//')"
    [ "$(processes)" = 3 ] || fail "wanted three processes"
}

for t in lines_that_differ_in_what_is_their_own_are_one_process one_that_fails_is_named_and_the_others_are_made \
    a_process_that_is_killed_loses_one_piece what_all_share_fails_all nothing_begins_on_a_full_disk \
    no_process_gets_more_than_the_system_takes; do run "$t"; done
