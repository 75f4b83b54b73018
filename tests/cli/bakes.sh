# bake_vdta, bake_vita: atlases of a synthetic scene; threads; errors; what make bakes again after an edit
. tests/lib.sh
project bakes
photos set >/dev/null
boxed t textures
m() { make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=t "$@" >log 2>&1 || { cat log; fail "make $*"; }; }
m textures
O=out/t
photo=$(basename "$(dirname "$(ls $O/vdta/*/atlas.txt | sed -n 1p)")")
inputs=(--model "$O/model/model.txt" --axes "$O/model/axes.txt" --views "$O/views" --ids "$O/ids" --things "$O/things")
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
        bake 0 texels bake_vdta "${inputs[@]}" --fill $O/fill --reveal $O/reveal --photo "$photo" --out two/$n --threads $n
        bake 0 texels bake_vita "${inputs[@]}" --set texels=80 --edit $O/remodel/bare/model.txt --out two/vita$n --threads $n
    done
    diff -r two/1 two/2; diff -r two/vita1 two/vita2
    diff -r two/1/"$photo" $O/vdta/"$photo"
}

several_viewpoints_of_a_process_have_the_bytes_of_one_alone()
{
    local p options=()
    for p in "$O"/vdta/*/; do p=${p%/}; options+=(--photo "${p##*/}" --deps "two/${p##*/}.d"); done
    for n in 1 2; do
        rm -rf two/all
        bake 0 "made 2 of $((${#options[@]} / 4)): " bake_vdta "${inputs[@]}" --fill $O/fill --reveal $O/reveal --out two/all "${options[@]}" --threads $n
        diff -r -x '*.d' two/all $O/vdta
    done
    diff <(sed "s|two/all|$O/vdta|" two/"$photo".d) $O/vdta/"$photo".d
}

a_viewpoint_that_fails_is_named_and_the_others_are_baked()
{
    local p others=()
    for p in "$O"/vdta/*/; do p=${p%/}; others+=("${p##*/}"); done
    mkdir -p few/reveal; cp $O/reveal/*.exr few/reveal/; rm few/reveal/"${others[1]}".exr
    rm -rf two/some
    bake 1 '1 of 3 failed' bake_vdta "${inputs[@]}" --fill $O/fill --reveal few/reveal --out two/some --photo "${others[0]}" --photo "${others[1]}" --photo "${others[2]}"
    grep -q "failed 2 of 3: ${others[1]}\$" err.txt || { cat err.txt; fail "it is not named"; }
    grep -q "error: .*few/reveal/${others[1]}.exr" err.txt || { cat err.txt; fail "nothing says why"; }
    [ ! -e two/some/"${others[1]}"/atlas.txt ] || fail "half a product was left"
    for p in 0 2; do diff -r two/some/"${others[p]}" $O/vdta/"${others[p]}"; done
}

a_bake_killed_in_the_middle_and_resumed_gives_the_same_bytes()
{
    local cores made n; n=$(ls $O/vdta/*/atlas.txt | wc -l)
    cp -a $O/vdta whole
    for cores in 1 2; do
        rm -rf $O/vdta
        kill_at "$O/vdta/*/page0.exr" make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=t CORES=$cores vdta
        made=$(find $O/vdta -name atlas.txt | wc -l)
        [ "$made" -lt "$n" ] || fail "the run had ended before it was killed"
        m CORES=$cores vdta
        diff -r -x '.*' whole $O/vdta || fail "the resumed run gives other bytes"
    done
    m textures
}

chunks_of_one_and_of_seven_give_the_same_bytes()
{
    local lines
    for lines in 1 7; do
        rm -rf $O/vdta $O/ids/*.exr $O/reveal/*.txt
        m CORES=$((lines == 1 ? 2 : 1)) VIEWS_PER_JOB=$lines vdta
        diff -r -x '.*' whole $O/vdta || fail "chunks of $lines give other bytes"
    done
    # a log for each viewpoint, with its own words
    [ "$(grep -l ' used ' $O/log/bake_vdta.*.log | wc -l)" = "$(ls $O/vdta/*/atlas.txt | wc -l)" ] || fail "a log lacks its words"
    m textures
}

make_names_what_fails_and_keeps_the_rest()
{
    local victim=$O/reveal/$photo.exr
    rm -rf $O/vdta; mv "$victim" keep.exr; head -c 500 keep.exr >"$victim"
    ! make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=t CORES=1 vdta >log 2>&1 || fail "make succeeded"
    grep -q "^bake_vdta: $photo failed; the end of $O/log/bake_vdta.$photo.log says:" log || { cat log; fail "it is not named"; }
    grep -q "bake_vdta: error: .*$victim" log || { cat log; fail "nothing says why"; }
    [ ! -e $O/vdta/"$photo"/atlas.txt ] || fail "a product was left"
    [ "$(ls $O/vdta/*/atlas.txt | wc -l)" -gt 0 ] || { cat log; fail "the other piece of the process was not made"; }
    mv keep.exr "$victim"
    m vdta; diff -r -x '.*' whole $O/vdta || fail "the run after it gives other bytes"
    m textures
}

errors_say_what_is_wrong()
{
    bake 2 'give --photo' bake_vdta "${inputs[@]}" --fill $O/fill --reveal $O/reveal --out made
    bake 2 'there is no photo nobody' bake_vdta "${inputs[@]}" --fill $O/fill --reveal $O/reveal --photo nobody --out made
    bake 2 'found 2 --photo and 1 --deps' bake_vdta "${inputs[@]}" --fill $O/fill --reveal $O/reveal --photo a --photo b --deps made/d --out made
    bake 1 'no-such/' bake_vdta "${inputs[@]}" --fill $O/fill --reveal no-such --photo "$photo" --out made
    bake 2 'min_clutter = 0.9 is above max_clutter' bake_vdta "${inputs[@]}" --fill $O/fill --reveal $O/reveal --photo "$photo" --out made --set min_clutter=0.9
    bake 1 'no-such' bake_vita "${inputs[@]}" --edit no-such/model.txt --out made
    mkdir -p broken; cp $O/ids/*.exr broken/; printf 'remodel-face-index 2\n' >broken/index.txt
    bake 1 'broken/index.txt' bake_vdta --model $O/model/model.txt --axes $O/model/axes.txt --views $O/views --ids broken --reveal $O/reveal --photo "$photo" --out made
}

an_estimate_says_what_the_viewpoints_take()
{
    awk '!/^#/ && NF > 2 { print $2 }' $O/views/lenses.txt | sort -u >list
    bake 0 used bake_vdta "${inputs[@]}" --fill $O/fill --reveal $O/reveal --out made --estimate list
    awk -v n="$(wc -l <list)" '$1 == "estimate" { found = NF == 6 && $2 == n && $3 > 0 && $4 > 60 && $5 > 0 && $6 <= $3 } END { exit !found }' out.txt ||
        { cat out.txt; fail "no line of the estimate, or a wrong one"; }
    [ ! -e made ] || fail "an estimate wrote something"
    echo nobody >list
    bake 2 'images.txt has no photo nobody' bake_vdta "${inputs[@]}" --fill $O/fill --reveal $O/reveal --out made --estimate list
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
    several_viewpoints_of_a_process_have_the_bytes_of_one_alone a_viewpoint_that_fails_is_named_and_the_others_are_baked \
    a_bake_killed_in_the_middle_and_resumed_gives_the_same_bytes chunks_of_one_and_of_seven_give_the_same_bytes make_names_what_fails_and_keeps_the_rest \
    an_estimate_says_what_the_viewpoints_take an_edit_that_reveals_nothing_new_bakes_no_viewpoint_again; do run "$t"; done
