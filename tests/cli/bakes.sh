# bake_vdta, bake_vita: atlases of a synthetic scene; threads; errors; what make bakes again after an edit
. tests/lib.sh
project bakes
photos set >/dev/null
boxed t textures
m() { make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=t "$@" >log 2>&1 || { cat log; fail "make $*"; }; }
m textures
O=out/t
photo=$(basename "$(dirname "$(ls $O/vdta/*/atlas.txt | sed -n 1p)")")
inputs=(--model "$O/model/model.txt" --axes "$O/model/axes.txt" --views "$O/views" --ids "$O/ids")
list() { find $O/vdta $O/vita -type f ! -name '*.d' -printf '%p %T@\n' | LC_ALL=C sort; }

# bake CODE WORD PROGRAM ARGUMENT...: runs it; checks its exit status and a word on standard error
bake()
{
    local code=$1 word=$2 program=$3 rc=0; shift 3
    rm -rf made
    "$B/bin/$program" "$@" >out.txt 2>err.txt </dev/null || rc=$?
    [ "$rc" = "$code" ] || { cat err.txt; fail "$*: exit $rc, wanted $code"; }
    grep -qF -- "$word" err.txt || { cat err.txt; fail "$*: nothing says '$word'"; }
    [ "$code" = 0 ] || grep -q "$program: error: .*[.?]\$" err.txt || { cat err.txt; fail "$*: no sentence"; }
    [ "$code" = 0 ] || [ ! -e made ] || [ -z "$(find made -type f)" ] || fail "$*: a product was left"
}

every_photo_has_an_atlas_and_the_model_has_one()
{
    local n; n=$(awk '!/^#/ && NF > 2 { print $2 }' $O/views/lenses.txt | sort -u | wc -l)
    [ "$(ls $O/vdta/*/atlas.txt | wc -l)" = "$n" ] || fail "wanted $n atlases"
    for f in "$O"/vdta/*/atlas.txt $O/vita/atlas.txt; do
        grep -q '^tile ' "$f" || fail "$f: no tile"
        "$B/bin/verify" --file "$f" || fail "$f is not whole"
    done
    ! grep -rqF "$PWD" $O/vdta/*/*.txt $O/vdta/*/*.exr $O/vita || fail "a product names a folder of this machine"
}

bytes_do_not_depend_on_threads()
{
    for n in 1 2; do
        bake 0 texels bake_vdta "${inputs[@]}" --reveal $O/reveal --photo "$photo" --out two/$n --threads $n
        bake 0 texels bake_vita "${inputs[@]}" --edit $O/remodel/bare/model.txt --out two/vita$n --threads $n
    done
    diff -r two/1 two/2; diff -r two/vita1 two/vita2
    diff -r two/1/"$photo" $O/vdta/"$photo"
}

errors_say_what_is_wrong()
{
    bake 2 'give --photo' bake_vdta "${inputs[@]}" --reveal $O/reveal --out made
    bake 2 'there is no photo nobody' bake_vdta "${inputs[@]}" --reveal $O/reveal --photo nobody --out made
    bake 2 'is for one --photo' bake_vdta "${inputs[@]}" --reveal $O/reveal --photo a --photo b --deps made/d --out made
    bake 1 'no-such/' bake_vdta "${inputs[@]}" --reveal no-such --photo "$photo" --out made
    bake 2 'min_clutter = 0.9 is above max_clutter' bake_vdta "${inputs[@]}" --reveal $O/reveal --photo "$photo" --out made --set min_clutter=0.9
    bake 1 'no-such' bake_vita "${inputs[@]}" --edit no-such/model.txt --out made
    mkdir -p broken; cp $O/ids/*.exr broken/; printf 'remodel-face-index 2\n' >broken/index.txt
    bake 1 'broken/index.txt' bake_vdta --model $O/model/model.txt --axes $O/model/axes.txt --views $O/views --ids broken --reveal $O/reveal --photo "$photo" --out made
}

an_estimate_says_what_the_viewpoints_take()
{
    awk '!/^#/ && NF > 2 { print $2 }' $O/views/lenses.txt | sort -u >list
    bake 0 used bake_vdta "${inputs[@]}" --reveal $O/reveal --out made --estimate list
    awk -v n="$(wc -l <list)" '$1 == "estimate" { found = NF == 6 && $2 == n && $3 > 0 && $4 > 60 && $5 > 0 && $6 <= $3 } END { exit !found }' out.txt ||
        { cat out.txt; fail "no line of the estimate, or a wrong one"; }
    [ ! -e made ] || fail "an estimate wrote something"
    echo nobody >list
    bake 2 'there is no photo nobody' bake_vdta "${inputs[@]}" --reveal $O/reveal --out made --estimate list
    rm -rf out/t/vdta
    make -s plan DEPS=manual SFM=set/model SCENE=t TO=vdta >plan 2>&1 || { cat plan; fail "make plan"; }
    grep -qE '^bake_vdta +[0-9]+ +[0-9]+ +[0-9.]+ ' plan || { cat plan; fail "make plan does not count the bakes"; }
    m textures
}

an_edit_that_reveals_nothing_new_bakes_no_viewpoint_again()
{
    list >before
    m textures
    list | diff before - || fail "a second run made something"
    # a box that is already on the floor, removed under another name: nothing else is revealed
    cp scenes/t/edits/bare.txt scenes/t/edits/again.txt
    m vdta
    find $O/vdta -type f ! -name '*.d' -printf '%p %T@\n' | LC_ALL=C sort >now
    grep /vdta/ before | diff - now || fail "an edit that reveals nothing else baked viewpoints again"
}

for t in every_photo_has_an_atlas_and_the_model_has_one bytes_do_not_depend_on_threads errors_say_what_is_wrong \
    an_estimate_says_what_the_viewpoints_take an_edit_that_reveals_nothing_new_bakes_no_viewpoint_again; do run "$t"; done
