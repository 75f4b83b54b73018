# find_things: the things of a synthetic scene, names and marks of users; errors; what make remakes
. tests/lib.sh
project things
photos set >/dev/null
boxed t model
m() { make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=t "$@" >log 2>&1 || { cat log; fail "make $*"; }; }
m things
O=out/t
# shellcheck disable=SC2206 # a list of options without blanks
inputs=(--model "$O/model/model.txt" --plan "$O/model/plan.txt" --axes "$O/model/axes.txt" --views "$O/views"
    --depth "$O/depth/model" --ids "$O/ids")

# find_things CODE WORD ARGUMENT...: runs find_things; checks its exit status and a word on standard error
find_things()
{
    local code=$1 word=$2 rc=0; shift 2
    rm -rf made
    "$B/bin/find_things" "$@" --out made >out.txt 2>err.txt </dev/null || rc=$?
    [ "$rc" = "$code" ] || { cat err.txt; fail "$*: exit $rc, wanted $code"; }
    grep -qF -- "$word" err.txt || { cat err.txt; fail "$*: nothing says '$word'"; }
    [ "$code" = 0 ] || grep -q 'find_things: error: .*[.?]$' err.txt || { cat err.txt; fail "$*: no sentence"; }
    [ "$code" = 0 ] || [ ! -e made/things.txt ] || fail "$*: a list was left"
}
# marked LINE...: writes marks.txt
marked() { printf '%s\n' 'remodel-marked-things 1' "$@" >marks.txt; }
# names: of the things that were made, in order
names() { awk '$1 == "thing" { printf "%s%s", n++ ? " " : "", $2 }' made/things.txt; }
times() { find $O/things -type f -printf '%p %T@\n' | LC_ALL=C sort; }

make_makes_a_list_a_volume_a_sheet_and_masks()
{
    local v
    for f in things.txt volume.exr sheet.svg plan.svg; do [ -s "$O/things/$f" ] || fail "no $f"; done
    for v in "$O"/ids/*.exr; do [ -s "$O/things/masks/${v##*/}" ] || fail "no mask of $v"; done
    [ "$(ls $O/things/masks | wc -l)" = "$(ls $O/ids/*.exr | wc -l)" ] || fail "masks of no view"
    # the wall at the back, and the cube before it
    awk '$1 == "thing" { n++; good += $3 == "floor" && $10 > 100 && $11 == 6 } END { exit n != 2 || good != 2 }' \
        $O/things/things.txt ||
        { cat $O/things/things.txt; fail "wanted two things on the floor that six views show"; }
    [ "$(grep -c '<image ' $O/things/sheet.svg)" = 2 ] || fail "the sheet has not two pictures"
    [ "$(grep -c '<path class="thing"' $O/things/plan.svg)" = 2 ] || fail "the plan has not two things"
    for v in hall thing1 thing2; do grep -q ">$v</text>" $O/things/plan.svg || fail "the plan does not name $v"; done
    ! grep -qF "$PWD" $O/things/things.txt $O/things/sheet.svg $O/things/plan.svg || fail "a product names a folder of this machine"
}

bytes_do_not_depend_on_threads()
{
    marked "thing cube in photo_2 80 60"
    for n in 1 2; do find_things 0 used "${inputs[@]}" --marks marks.txt --threads $n; rm -rf two$n; mv made two$n; done
    diff -r two1 two2
    find_things 0 used "${inputs[@]}"
    for f in volume.exr sheet.svg plan.svg masks; do diff -r made/$f $O/things/$f; done
}

marks_name_join_and_split_things()
{
    marked "thing cube in photo_2 80 60"
    find_things 0 used "${inputs[@]}" --marks marks.txt
    [ "$(names)" = "thing1 cube" ] || fail "a name: $(names)"
    marked "thing all in photo_2 80 60 in photo_2 20 20"
    find_things 0 used "${inputs[@]}" --marks marks.txt
    [ "$(names)" = all ] || fail "joined: $(names)"
    marked "thing left in photo_2 5 20" "thing right in photo_2 155 20"
    find_things 0 used "${inputs[@]}" --marks marks.txt
    [ "$(names | tr ' ' '\n' | sort | xargs)" = "left right thing1" ] || fail "split: $(names)"
}

a_mark_on_nothing_gives_a_warning()
{
    marked "# the bare floor" "thing cube in photo_2 80 60" "thing rug in photo_2 155 118"
    find_things 0 'warning: things.txt:4: nothing stands before the model at 155 118 of photo_2' "${inputs[@]}" \
        --marks marks.txt
    grep -qF 'this mark of rug is left out' err.txt || { cat err.txt; fail "the name is not said"; }
    [ "$(names)" = "thing1 cube" ] || fail "$(names)"
}

# thing1 is what the list calls a thing without a name
a_name_is_not_given_twice()
{
    marked "thing thing1 in photo_2 80 60"
    find_things 0 used "${inputs[@]}" --marks marks.txt
    [ -z "$(names | tr ' ' '\n' | sort | uniq -d)" ] || fail "twice the same name: $(names)"
}

a_scene_may_have_no_things()
{
    find_things 0 used "${inputs[@]}" --set min_voxels=1000000
    [ -z "$(names)" ] || fail "$(names)"
    grep -qF 'No things were found.' made/sheet.svg || fail "the sheet does not say so"
    [ -s made/volume.exr ] && [ "$(ls made/masks | wc -l)" = 6 ] || fail "a product is missing"
}

larger_voxels_if_there_would_be_too_many()
{
    # of 62 x 62 x 22, with an edge of 0.0022 of 22
    find_things 0 'voxels are 9.07 times as large as asked for, because there would be 747 million; the most are 1 ' \
        "${inputs[@]}" --set voxel=0.0022 --set max_voxels=1
    grep -q '^thing ' made/things.txt || fail "no thing"
}

errors_say_what_is_wrong()
{
    find_things 2 '--model is missing' "${inputs[@]:2}"
    find_things 2 '--plan is missing' "${inputs[@]:0:2}" "${inputs[@]:4}"
    find_things 2 '--ids is missing' "${inputs[@]:0:10}"
    find_things 1 'nowhere.txt' "${inputs[@]}" --marks nowhere.txt
    for c in "chair sofa in photo_2 1 1|found \"chair\", wanted thing or flat" \
        "thing 12 in photo_2 1 1|found \"12\", wanted a name" \
        "thing sofa in nobody 1 1|found \"nobody\", wanted a photo" \
        "thing sofa in photo_2 161 1|a pixel of the photo, which has 160 x 120" \
        "thing sofa in photo_2 1|found the end of the line, wanted Y"; do
        marked "# names" "${c%%|*}"
        find_things 1 "${c##*|}" "${inputs[@]}" --marks marks.txt
        grep -qF 'marks.txt:3: ' err.txt || { cat err.txt; fail "$c: no file and line"; }
    done
    find_things 1 'no-such/photo_1.' "${inputs[@]:0:8}" --depth no-such --ids $O/ids
    find_things 1 'no-such/photo_1.exr' "${inputs[@]:0:10}" --ids no-such
    mkdir -p less; cp $O/depth/model/*.exr $O/depth/model/*.txt less; rm less/photo_4.exr
    find_things 1 'less/photo_4.exr' "${inputs[@]:0:8}" --depth less --ids $O/ids
}

make_remakes_only_what_changed()
{
    times >before; m things; times | diff before - || fail "a second make made something again"
    printf 'remodel-marked-things 1\nthing cube in photo_2 80 60\n' >scenes/t/things.txt
    m things
    grep -q '^thing cube ' $O/things/things.txt || fail "marks came, but nothing was made again"
    grep -q '^# input things.txt ' $O/things/things.txt || fail "the list does not record the marks"
    times >before; m things; times | diff before - || fail "with marks, a second make made something again"
    rm scenes/t/things.txt; m things
    ! grep -q '^thing cube ' $O/things/things.txt || fail "marks went, but nothing was made again"
    rm $O/things/things.txt; m things
    [ -s $O/things/things.txt ] || fail "a missing list was not made"
}

for t in make_makes_a_list_a_volume_a_sheet_and_masks bytes_do_not_depend_on_threads marks_name_join_and_split_things \
    a_mark_on_nothing_gives_a_warning a_name_is_not_given_twice a_scene_may_have_no_things \
    larger_voxels_if_there_would_be_too_many errors_say_what_is_wrong make_remakes_only_what_changed; do run "$t"; done
