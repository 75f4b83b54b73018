# comparison of metrics with the expected ones: verdicts, tolerances, malformed files, acceptance, whole runs
. tests/lib.sh

compare=$root/tests/regress/compare
# lines FILE LINE...: writes the lines, with tabs for blanks
lines() { local to=$1; shift; printf '%s\n' "$@" | tr ' ' '\t' >"$to"; }
old() { lines "$scratch/old.tsv" "$@"; }
new() { lines "$scratch/new.tsv" "$@"; }
# verdicts CODE: compares old.tsv and new.tsv and wants the exit code; the table goes to $scratch/table
verdicts()
{
    local rc=0
    "$compare" "$scratch/old.tsv" "$scratch/new.tsv" >"$scratch/table" 2>"$scratch/err" || rc=$?
    [ "$rc" = "$1" ] || { cat "$scratch/table" "$scratch/err"; fail "exit $rc, wanted $1"; }
}
is() { grep -qE "^$1 +$2 " "$scratch/table" || { cat "$scratch/table"; fail "the table does not call $2 $1"; }; }
# refused FILE LINE WORD: the comparison is refused with file, line and what was found
refused()
{
    verdicts 2
    grep -qF "$scratch/$1:$2: found" "$scratch/err" && grep -qF -- "$3" "$scratch/err" || { cat "$scratch/err"; fail "the message does not name $1:$2 and '$3'"; }
}

better_worse_and_same_by_direction_and_tolerance()
{
    old 'a 1 px lower 0.1' 'b 30 dB higher 1%' 'c 2 1 lower 5%' 'd 2 1 higher 0.5' 'e 5 1 none 0' 'f -2 1 higher 10%'
    new 'a 1.1 px lower' 'b 29.7 dB higher' 'c 1.8 1 lower' 'd 2.6 1 higher' 'e 6 1 none' 'f -2.1 1 higher'
    verdicts 0
    is same a; is same b; is better c; is better d; is changed e; is same f
    tail -n 1 "$scratch/table" | matches -x 'old: 0 worse, 0 missing, 2 better, 3 same, 1 changed' || fail "the last line does not count them"
    new 'a 1.11 px lower' 'b 29.69 dB higher' 'c 2 1 lower' 'd 2 1 higher' 'e 5 1 none' 'f -2.3 1 higher'
    verdicts 1
    is worse a; is worse b; is same c; is same d; is same e; is worse f
}

tolerance_zero_allows_no_change()
{
    old 'a 22 1 higher 0' 'b 0 1 lower 50%'; new 'a 22 1 higher' 'b 0 1 lower'; verdicts 0
    new 'a 21 1 higher' 'b 0 1 lower'; verdicts 1; is worse a
    new 'a 22 1 higher' 'b 1e-9 1 lower'; verdicts 1; is worse b
}

values_are_the_same_on_a_machine_of_the_same_type()
{
    old 'a 1 px lower 10%' 'b 2 1 none 10%'; new 'a 1.01 px lower' 'b 2 1 none'
    "$compare" --accept --machine 'x, gcc 1' "$scratch/old.tsv" "$scratch/old4.tsv" 2>/dev/null && fail "a missing file was accepted"
    sed -i '1i # machine: x, gcc 1' "$scratch/old.tsv"
    local rc=0
    "$compare" --machine 'x, gcc 1' "$scratch/old.tsv" "$scratch/new.tsv" >"$scratch/table" || rc=$?
    [ "$rc" = 1 ] || { cat "$scratch/table"; fail "exit $rc, wanted 1"; }
    is differs a; is same b
    "$compare" --machine 'x, gcc 2' "$scratch/old.tsv" "$scratch/new.tsv" >"$scratch/table" || { cat "$scratch/table"; fail "another machine gives other values"; }
    is same a
    "$compare" --accept --machine 'x, gcc 2' "$scratch/old.tsv" "$scratch/new.tsv"
    [ "$(grep -c '^# machine: ' "$scratch/old.tsv")" = 1 ] && grep -qx '# machine: x, gcc 2' "$scratch/old.tsv" || { cat "$scratch/old.tsv"; fail "the type of the machine was not accepted"; }
    "$compare" --machine 'x, gcc 2' "$scratch/old.tsv" "$scratch/new.tsv" >"$scratch/table" || { cat "$scratch/table"; fail "what was accepted differs"; }
}

a_missing_metric_fails_and_a_new_one_passes()
{
    old 'a 1 1 lower 1%' 'b 1 1 none 1%'
    new 'a 1 1 lower' 'b 1 1 none' 'c 1 1 lower'; verdicts 0; is new c
    new 'a 1 1 lower'; verdicts 1; is missing b
}

another_unit_or_direction_fails()
{
    old 'a 1 px lower 1%' 'b 1 1 lower 1%'; new 'a 1 m lower' 'b 1 1 higher'
    verdicts 1; is unlike a; is unlike b
}

malformed_files_are_refused_with_file_and_line()
{
    old '# of a run' 'a 1 1 lower 1%'
    for v in nan inf -inf 1e999 0x10 1,5 '1 ' ''; do
        printf '# head\n\na\t1\t1\tlower\nb\t%s\t1\tlower\n' "$v" >"$scratch/new.tsv"; refused new.tsv 4 "\"$v\""
    done
    new 'a 1 1 sideways'; refused new.tsv 1 sideways
    new 'a 1 1'; refused new.tsv 1 "3 fields"
    new 'a 1 1 lower' 'a 1 1 lower'; refused new.tsv 2 "second time"
    new '# nothing'; verdicts 2; grep -q "no metric" "$scratch/err" || fail "no message about an empty file"
    new 'a 1 1 lower'
    for t in -1 nan 5%% % few; do old 'a 1 1 lower 1%' "b 1 1 lower $t"; refused old.tsv 2 "\"$t\""; done
    old 'a nan 1 lower 1%'; refused old.tsv 1 '"nan"'
    rm "$scratch/old.tsv"; verdicts 2; grep -qF "$scratch/old.tsv" "$scratch/err" || fail "the message does not name the missing file"
}

acceptance_keeps_tolerances_and_comments()
{
    old '#_reviewed' 'a 1 px lower 0.25' 'gone 1 1 lower 3%'
    new 'a 7 px lower' 'b 2 1 higher'
    "$compare" --accept "$scratch/old.tsv" "$scratch/new.tsv"
    lines "$scratch/wanted" '#_reviewed' 'a 7 px lower 0.25' 'b 2 1 higher 2%'
    diff "$scratch/wanted" "$scratch/old.tsv" || fail "wrong accepted file"
    verdicts 0
    new 'a nan px lower'; cp "$scratch/old.tsv" "$scratch/before"
    ! "$compare" --accept "$scratch/old.tsv" "$scratch/new.tsv" 2>/dev/null || fail "a malformed file was accepted"
    cmp "$scratch/before" "$scratch/old.tsv" || fail "the expected file was changed"
    [ -z "$(find "$scratch" -name '.accept*')" ] || fail "a temporary file was left"
}

colours_only_on_a_terminal()
{
    old 'a 1 1 lower 1%'; new 'a 2 1 lower'
    verdicts 1
    ! grep -q $'\033' "$scratch/table" || fail "colours in a file"
    command -v script >/dev/null || skip "the command script, which makes a terminal, is not installed"
    script -qec "env -u NO_COLOR '$compare' '$scratch/old.tsv' '$scratch/new.tsv'" /dev/null </dev/null >"$scratch/table" || true
    grep -q $'\033\\[31mworse' "$scratch/table" || { cat -v "$scratch/table"; fail "no colour on a terminal"; }
}

# a make that only writes metrics: VALUE for every scene; it fails for the scene broken
runs_of_scenes_are_compared_and_accepted()
{
    project regress
    cat >./make <<'SH'
#!/bin/sh
for w; do case $w in SCENE=*) s=${w#SCENE=} ;; QUALITY=*) q=${w#QUALITY=} ;; esac; done
[ "$s" != broken ] || exit 1
mkdir -p "out/$s+$q" && printf 'depth.bad1\t%s\t1\tlower\n' "$VALUE" >"out/$s+$q/metrics.tsv"
SH
    chmod +x make
    export MAKE=./make EXPECTED=expected VALUE=4
    go() { local code=$1 rc=0; shift; tests/regress/run "$@" >"$scratch/out" 2>&1 || rc=$?; [ "$rc" = "$code" ] || { cat "$scratch/out"; fail "$*: exit $rc, wanted $code"; }; }
    go 1 compare small; grep -q 'regress-accept SCENES=small' "$scratch/out" || fail "the message does not name regress-accept"
    go 0 accept small
    go 0 compare small
    VALUE=5 go 1 compare small; grep -q 'small: worse' "$scratch/out" || fail "the scene is not called worse"
    go 1 compare broken small; grep -q 'broken: failed to run' "$scratch/out" && grep -q 'small: as expected' "$scratch/out" || fail "a scene has no verdict"
    go 2 compare
}

for t in better_worse_and_same_by_direction_and_tolerance tolerance_zero_allows_no_change values_are_the_same_on_a_machine_of_the_same_type a_missing_metric_fails_and_a_new_one_passes \
    another_unit_or_direction_fails malformed_files_are_refused_with_file_and_line acceptance_keeps_tolerances_and_comments \
    colours_only_on_a_terminal runs_of_scenes_are_compared_and_accepted; do run "$t"; done
