# trace_ids: ids of a synthetic scene, what edits reveal, the index; errors; what make remakes
. tests/lib.sh
project trace
photos set >/dev/null
boxed t model
m() { make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=t "$@" >log 2>&1 || { cat log; fail "make $*"; }; }
m ids
O=out/t
view=$(basename "$(ls $O/ids/*.exr | sed -n 1p)" .exr)
inputs=(--model "$O/model/model.txt" --axes "$O/model/axes.txt" --views "$O/views")

# trace CODE WORD ARGUMENT...: runs trace_ids; checks its exit status and a word on standard error
trace()
{
    local code=$1 word=$2 rc=0; shift 2
    rm -rf made
    "$B/bin/trace_ids" "$@" >out.txt 2>err.txt </dev/null || rc=$?
    [ "$rc" = "$code" ] || { cat err.txt; fail "$*: exit $rc, wanted $code"; }
    grep -qF -- "$word" err.txt || { cat err.txt; fail "$*: nothing says '$word'"; }
    [ "$code" = 0 ] || grep -q 'trace_ids: error: .*[.?]$' err.txt || { cat err.txt; fail "$*: no sentence"; }
    [ "$code" = 0 ] || [ ! -e made ] || [ -z "$(ls made)" ] || fail "$*: a product was left"
}
list() { find $O/ids $O/reveal -type f -printf '%p %T@\n' | LC_ALL=C sort; }

make_makes_ids_reveals_and_an_index()
{
    local n; n=$(ls $O/views/*.exr | wc -l)
    for f in "$O"/ids/*.exr "$O"/reveal/*.exr; do [ -s "$f" ] || fail "no $f"; done
    [ "$(ls $O/ids/*.exr | wc -l)" = "$n" ] && [ "$(ls $O/reveal/*.exr | wc -l)" = "$n" ] || fail "wanted $n views"
    grep -q '^face [0-9]* [0-9]* [0-9]* ' $O/ids/"$view".txt || { cat $O/ids/"$view".txt; fail "no face"; }
    grep -q '^edit bare ' $O/reveal/"$view".txt || fail "no edit"
    grep -q "^view $view " $O/ids/index.txt || fail "the index lacks the view"
    ! grep -rqF "$PWD" $O/ids $O/reveal || fail "a product names a folder of this machine"
}

a_closed_room_fills_every_view()
{
    # the faces' pixels add up to those of the view
    for f in "$O"/ids/*.txt; do
        case ${f##*/} in index.txt | offsets.txt) continue ;; esac
        [ "$(awk '$1 == "face" { n += $3 } END { print n }' "$f")" = $((160 * 120)) ] || { cat "$f"; fail "$f: empty pixels"; }
    done
}

bytes_do_not_depend_on_threads()
{
    for n in 1 2; do
        trace 0 used "${inputs[@]}" --view "$view" --depth $O/depth --out two/$n.exr --threads $n
        trace 0 used "${inputs[@]}" --view "$view" --reveal --edit $O/remodel/bare/model.txt --out two/reveal$n.exr --threads $n
        trace 0 used "${inputs[@]}" --index $O/ids --out two/index$n.txt --threads $n
    done
    cmp two/1.exr two/2.exr; cmp two/1.txt two/2.txt; cmp two/reveal1.exr two/reveal2.exr; cmp two/index1.txt two/index2.txt
    cmp two/index1.txt $O/ids/index.txt || diff <(grep -v '^#' two/index1.txt) <(grep -v '^#' $O/ids/index.txt)
}

several_views_of_a_process_have_the_bytes_of_one_alone()
{
    local v options=() n
    for v in "$O"/ids/*.exr; do v=$(basename "$v" .exr); options+=(--view "$v" --out "two/all/$v.exr"); done
    n=$((${#options[@]} / 4))
    trace 0 "made 2 of $n: " "${inputs[@]}" --depth $O/depth/model "${options[@]}"
    diff -r -x index.txt -x offsets.txt two/all $O/ids; rm -r two/all
    trace 0 "made $n of $n: " "${inputs[@]}" --reveal --edit $O/remodel/bare/model.txt "${options[@]}"
    diff -r two/all $O/reveal; rm -r two/all
    options[1]=nobody
    trace 1 "1 of $n failed" "${inputs[@]}" --depth $O/depth "${options[@]}"
    grep -q "failed 1 of $n: nobody\$" err.txt || { cat err.txt; fail "it is not named"; }
    [ "$(ls two/all/*.exr | wc -l)" = $((n - 1)) ] || fail "the others were not made"
}

errors_say_what_is_wrong()
{
    trace 2 '--view is missing' "${inputs[@]}" --depth $O/depth --out made/a.exr
    trace 2 '--depth is missing' "${inputs[@]}" --view "$view" --out made/a.exr
    trace 2 'found 2 --view and 1 --out' "${inputs[@]}" --depth $O/depth --view a --view b --out made/a.exr
    trace 2 'exclude each other' "${inputs[@]}" --reveal --index $O/ids --out made/a.txt
    trace 2 '--edit is only for --reveal' "${inputs[@]}" --view "$view" --depth $O/depth --edit x/model.txt --out made/a.exr
    trace 2 'ends in .exr' "${inputs[@]}" --view "$view" --depth $O/depth --out made/a
    trace 1 'has no view nobody' "${inputs[@]}" --view nobody --depth $O/depth --out made/a.exr
    trace 1 'no-such/' "${inputs[@]}" --view "$view" --depth no-such --out made/a.exr
    mkdir -p bad; cp $O/ids/*.txt bad; rm bad/index.txt
    sed -i 's/^face .*/face 1 5 6 1 1/' bad/"$view".txt
    trace 1 "bad/$view.txt:" "${inputs[@]}" --index bad --out made/index.txt
    rm bad/"$view".txt
    trace 1 "bad/$view.txt" "${inputs[@]}" --index bad --out made/index.txt
}

an_estimate_says_what_the_views_take()
{
    printf '%s ids\n%s reveal\n' "$view" "$view" >list
    trace 0 used "${inputs[@]}" --out made/a.exr --estimate list --edit $O/remodel/bare/model.txt
    awk '$1 == "estimate" { found = NF == 6 && $2 == 2 && $3 > 0 && $4 > 10 && $5 > 0 && $6 < $3 } END { exit !found }' out.txt ||
        { cat out.txt; fail "no line of the estimate, or a wrong one"; }
    [ ! -e made ] || fail "an estimate wrote something"
    echo nobody ids >list
    trace 2 'there is no view nobody' "${inputs[@]}" --out made/a.exr --estimate list
    echo "$view" depth >list
    trace 1 'list:1: found "depth", wanted ids or reveal' "${inputs[@]}" --out made/a.exr --estimate list
    trace 2 '--estimate excludes' "${inputs[@]}" --out made/a.exr --estimate list --view "$view"
    rm -rf $O/ids $O/reveal
    make -s plan DEPS=manual SFM=set/model SCENE=t TO=ids >plan 2>&1 || { cat plan; fail "make plan"; }
    # six views twice, and the index
    grep -qE '^trace_ids +13 +4 +[0-9.]+ +0.25 ' plan || { cat plan; fail "make plan does not say what the views take"; }
    m ids
}

cameras_outside_the_model_give_a_warning()
{
    sed 's/^translation .*/translation 1000 0 0/' $O/model/axes.txt >far.txt
    trace 0 'warning: all 6 cameras are outside the model' --model $O/model/model.txt --axes far.txt --views $O/views --index $O/ids --out made/index.txt
    trace 0 used --model $O/model/model.txt --axes far.txt --views $O/views --view "$view" --depth $O/depth --out made/a.exr
}

make_remakes_only_what_changed()
{
    list >before; m ids; list | diff before - || fail "a second make made something again"
    # the same edit in other words reveals the same
    printf 'remodel-script 1\n# again\nremove block\n' >scenes/t/edits/bare.txt
    m ids; list >after
    ! diff <(grep 'ids/\|reveal/.*exr' before) <(grep 'ids/\|reveal/.*exr' after) >d || true
    [ ! -s d ] || { cat d; fail "ids or revealed surfaces were made again"; }
    diff before after >/dev/null && fail "the records of what the edits reveal are stale"
    list >before; m ids; list | diff before - || fail "a make after an edit made something again"
    rm $O/reveal/"$view".exr; m ids
    [ -e $O/reveal/"$view".exr ] || fail "a missing picture was not made"
    rm scenes/t/edits/bare.txt; m ids
    ! grep -q '^edit' $O/reveal/"$view".txt || fail "an edit that went is still listed"
}

for t in make_makes_ids_reveals_and_an_index a_closed_room_fills_every_view bytes_do_not_depend_on_threads several_views_of_a_process_have_the_bytes_of_one_alone errors_say_what_is_wrong an_estimate_says_what_the_views_take cameras_outside_the_model_give_a_warning make_remakes_only_what_changed; do run "$t"; done
