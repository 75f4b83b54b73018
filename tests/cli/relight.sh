# update_vita, relight: an edit of a synthetic room relit; a lamp that goes off, an object, threads, errors; make relight
. tests/lib.sh
project relight
photos set >/dev/null
boxed t textures
m() { make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=t "$@" >log 2>&1 || { cat log; fail "make $*"; }; }
printf '[bake_outdoors]\nheight = 64\n[update_vita]\nspacing = 0.1\nfinest = 0.05\nrays = 128\ntolerance = 0.05\n[relight]\ntarget_error = 0.2\nrays = 256\nintegrals = yes\n' >>scenes/t/scene.cfg
mkdir -p scenes/t/objects
printf 'v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 0 0 4\nv 4 0 4\nv 4 4 4\nv 0 4 4\nf 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n' >scenes/t/objects/crate.obj
printf 'remodel-script 1\n# A dark room with a crate.\nlamp spot off\nobject crate objects/crate.obj at -2 8 0 ward 0.6 0.2 0.1 0.05 0.2\n' >scenes/t/edits/dark.txt
m relight EDIT=dark RELIT_VIEWS=photo_1
O=out/t
view=$(ls $O/views/*.exr | sed -n 1p); view=$(basename "$view" .exr)
printf 'remodel-lights 1\ndisk spot 0 0 19.9 0 0 -1 3 50 50 50 80 1\n' >lamps.txt
# change EDIT: the options that both programs have
change()
{
    local e=$O/remodel/$1
    printf '%s\n' --model $O/model/model.txt --edited "$e/model.txt" --map "$e/texture.txt" --axes $O/model/axes.txt --vita $O/vita \
        --outdoors $O/outdoors/outdoors.exr --lights lamps.txt --objects "$e/objects.txt" --scene scenes/t --config scenes/t/scene.cfg
}
mapfile -t dark < <(change dark)
shown=(--pictures "$O/relight/dark/unlit" --picture "$view" --views "$O/views" --ids "$O/ids" --depth "$O/depth")

# try CODE WORD PROGRAM ARGUMENT...: runs a program; checks its exit status, a word on standard error, and that a failure leaves nothing
try()
{
    local code=$1 word=$2 program=$3 rc=0; shift 3
    rm -rf made
    "$B/bin/$program" "$@" >out.txt 2>err.txt </dev/null || rc=$?
    [ "$rc" = "$code" ] || { cat err.txt; fail "$program $*: exit $rc, wanted $code"; }
    grep -qF -- "$word" err.txt || { cat err.txt; fail "$program $*: nothing says '$word'"; }
    [ "$code" = 0 ] || grep -q "$program: error: .*[.?]\$" err.txt || { cat err.txt; fail "$program $*: no sentence"; }
    [ "$code" = 0 ] || [ ! -e made ] || [ -z "$(find made -type f)" ] || fail "$program $*: a product was left"
}

a_lamp_goes_off_and_bytes_do_not_depend_on_threads()
{
    for n in 1 2; do
        rm -rf two/$n
        try 0 'samples' update_vita "${dark[@]}" --out two/$n --threads $n
        try 0 'relit 1 of 1' relight "${dark[@]}" --relit two/$n "${shown[@]}" --out two/$n --threads $n
    done
    diff -r two/1 two/2
    ! grep -rqF "$PWD" two/1 || fail "a product names a folder of this machine"
    "$B/bin/verify" --file two/1/vita/atlas.txt || fail "the atlas is not whole"
    for f in "$view.exr" "$view-ratio.exr" "$view-ratio.png" "$view-integrals.exr" "$view.jpg"; do
        "$B/bin/verify" --file "two/1/$f" || fail "$f is not whole"
    done
    grep -q '^settled yes$' two/1/rounds.txt || { cat two/1/rounds.txt; fail "light did not settle"; }
    [ "$(grep -c '^element ' two/1/objects.txt)" -gt 10 ] || fail "the crate has no elements"
    awk '$1 == "changed" { exit !($2 > 50) }' "two/1/$view.txt" || { cat "two/1/$view.txt"; fail "the lamp changes nothing"; }
    ! grep -qE 'nan|inf' two/1/*.txt || fail "a number is none"
}

# same_pixels EXR EXR: the headers, which name other inputs, are left out
same_pixels()
{
    local n; n=$(($(stat -c %s "$1") - 4096))
    cmp <(tail -c "$n" "$1") <(tail -c "$n" "$2")
}

an_edit_that_says_nothing_of_light_leaves_the_picture_alone()
{
    cp -r $O/remodel/dark same
    cp $O/model/model.txt same/model.txt
    printf 'remodel-texture 3\nbase none\n' >same/texture.txt
    local nothing=(--model "$O/model/model.txt" --edited same/model.txt --map same/texture.txt --axes "$O/model/axes.txt" --vita "$O/vita"
        --outdoors "$O/outdoors/outdoors.exr" --lights lamps.txt --config scenes/t/scene.cfg)
    "$B/bin/render_model" --model $O/model/model.txt --axes $O/model/axes.txt --views $O/views --vdta $O/vdta --vita $O/vita --ids $O/ids --depth $O/depth \
        --outdoors $O/outdoors/outdoors.exr --view "$view" --set radiance=all --out same/unlit 2>err.txt || { cat err.txt; fail "render_model"; }
    try 0 'samples' update_vita "${nothing[@]}" --out same/relit
    try 0 'relit 1 of 1' relight "${nothing[@]}" --relit same/relit --pictures same/unlit --picture "$view" --views $O/views --ids $O/ids --depth $O/depth --out same/relit
    grep -q '^changed 0$' "same/relit/$view.txt" || { cat "same/relit/$view.txt"; fail "the light of pixels changed"; }
    same_pixels "same/unlit/$view.exr" "same/relit/$view.exr" || fail "the picture changed"
    for p in "$O"/vita/page*.exr; do
        same_pixels "$p" "same/relit/vita/$(basename "$p")" || fail "$p: texels changed"
    done
}

make_relights_the_views_and_a_second_make_does_nothing()
{
    m relight EDIT=dark RELIT_VIEWS="$view"
    [ -s "$O/relight/dark/$view.jpg" ] && [ -s "$O/relight/dark/$view-ratio.png" ] || fail "no picture"
    [ "$(ls $O/relight/dark/*-ratio.exr | wc -l)" = 1 ] || fail "views that nobody wanted"
    find $O -type f -printf '%p %T@\n' | grep -vE '/log/|/.lock ' | LC_ALL=C sort >before
    m relight EDIT=dark RELIT_VIEWS="$view"
    find $O -type f -printf '%p %T@\n' | grep -vE '/log/|/.lock ' | LC_ALL=C sort | diff before - || fail "a second make made something again"
    sed -i 's/0.6 0.2 0.1/0.1 0.2 0.6/' scenes/t/edits/dark.txt
    touch before
    m relight EDIT=dark RELIT_VIEWS="$view"
    [ "$O/relight/dark/$view.exr" -nt before ] || fail "the object's colour does not reach the picture"
}

what_is_wrong_is_named()
{
    local o i bad
    try 2 'wanted either --picture NAME or --list' relight "${dark[@]}" --relit two/1 --pictures $O/relight/dark/unlit --out made
    try 2 '--ids and --depth go together' relight "${dark[@]}" --relit two/1 --pictures $O/relight/dark/unlit --picture "$view" --views $O/views --ids $O/ids --out made
    try 2 'need --views' relight "${dark[@]}" --relit two/1 --pictures $O/relight/dark/unlit --picture "$view" --materials m.txt --out made
    try 2 '--model' update_vita --out made
    try 2 '--relit' relight "${dark[@]}" --pictures $O/relight/dark/unlit --picture "$view" --out made
    try 1 'no-such' relight "${dark[@]}" --relit no-such "${shown[@]}" --out made
    try 1 'nowhere' relight "${dark[@]}" --relit two/1 --pictures $O/relight/dark/unlit --picture nowhere --out made
    for o in model edited map axes vita outdoors lights objects; do
        bad=("${dark[@]}")
        for i in "${!bad[@]}"; do [ "${bad[i]}" != "--$o" ] || bad[i + 1]=no-such; done
        try 1 'no-such' update_vita "${bad[@]}" --out made
        try 1 'no-such' relight "${bad[@]}" --relit two/1 "${shown[@]}" --out made
    done
    sed -i 's/^v 4 0 0/v 5 0 0/' scenes/t/objects/crate.obj
    try 1 'crate.obj' update_vita "${dark[@]}" --out made
    sed -i 's/^v 5 0 0/v 4 0 0/' scenes/t/objects/crate.obj
    cp -r two/1 short; sed -i '$d' short/objects.txt
    try 1 'update the VITA again' relight "${dark[@]}" --relit short "${shown[@]}" --out made
    try 2 'max_samples' update_vita "${dark[@]}" --set max_samples=0 --out made
}

a_plan_says_what_the_pictures_take()
{
    printf 'process %s\nprocess %s %s\n' "$view" "$view" "$view" >list
    for p in relight "render_model --model x --axes x --vdta x --vita x"; do
        # shellcheck disable=SC2086 # a program and its options
        try 0 used $p --views "$O/views" --out made --estimate list
        awk '$1 == "estimate" { found = NF == 6 && $2 == 2 && $3 > 0 && $3 < 2.0001 * $6 && $4 > 60 && $5 > 0 } END { exit !found }' out.txt ||
            { cat out.txt; fail "$p: no line of the estimate, or a wrong one"; }
        [ ! -e made ] || fail "an estimate wrote something"
    done
    mv $O/vita/atlas.txt atlas.kept
    rm -rf $O/relight/dark/unlit $O/relight/dark/*.txt
    make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=t EDIT=dark RELIT_VIEWS=photo_1 TO=relight plan >log 2>&1 || { cat log; fail "make plan"; }
    mv atlas.kept $O/vita/atlas.txt
    ! grep '^?: .*\(relight\|render_model\|update_vita\|bake_vita\|fit_lights\)' log || { cat log; fail "they have no estimate"; }
    awk '$1 ~ /^(relight|render_model|update_vita|bake_vita)$/ { n += $4 ~ /^[0-9.]+$/ } END { exit n != 4 }' log || { cat log; fail "the plan does not tell them"; }
}

# light goes by the surface of the model, and by samples and rays up to a limit
light_takes_what_the_model_has_of_surface()
{
    "$root/$B/bin/update_vita" "${dark[@]}" --out made --estimate 2 --set rays=1000 >few 2>/dev/null && "$root/$B/bin/update_vita" "${dark[@]}" --out made --estimate 2 --set rays=2000 >many 2>/dev/null || fail "update_vita"
    paste -d' ' few many | awk '{ exit !($2 == 2 && $6 * 2 - $3 < 0.003 && $9 > 1.2 * $3 && $9 < 2 * $3) }' || { cat few many; fail "rays do not count"; }
    "$root/$B/bin/bake_vita" --model $O/model/model.txt --axes x --views x --ids x --out made --estimate 1 --set texels=500 >few 2>/dev/null && "$root/$B/bin/bake_vita" --model $O/model/model.txt --axes x --views x --ids x --out made --estimate 1 --set texels=1000 >many 2>/dev/null || fail "bake_vita"
    paste -d' ' few many | awk '{ exit !($11 > 3.9 * $5 && $11 < 4.1 * $5) }' || { cat few many; fail "texels do not count"; }
    [ ! -e made ] || fail "an estimate wrote something"
    printf 'remodel-lamps 1\ndisk d in v 1 1 rim 2 2\nlit d in v 1 1\n' >one
    { cat one; echo 'lit d in v 1 1 9 9'; } >two_marks
    for f in one two_marks; do "$root/$B/bin/fit_lights" --model x --plan x --axes x --views x --ids x --out made --estimate --lamps $f 2>/dev/null; done |
        paste -sd' ' | awk '{ exit !($9 > $3 && $9 < 1.2 * $3) }' || fail "marks do not count"
}

for t in a_lamp_goes_off_and_bytes_do_not_depend_on_threads an_edit_that_says_nothing_of_light_leaves_the_picture_alone make_relights_the_views_and_a_second_make_does_nothing what_is_wrong_is_named a_plan_says_what_the_pictures_take light_takes_what_the_model_has_of_surface; do run "$t"; done
