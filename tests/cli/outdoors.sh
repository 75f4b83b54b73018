# bake_outdoors: a closed room, rooms with windows; lighting reference images; threads; errors; what make makes again
. tests/lib.sh
project outdoors
photos set >/dev/null
boxed t model
m() { make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=t "$@" >log 2>&1 || { cat log; fail "make $*"; }; }
# what the photos show stands well inside the room, so that all of it is clutter
printf '[bake_outdoors]\nheight = 64\nedge = 1\nmax_clutter = 1\n' >>scenes/t/scene.cfg
O=out/t
inputs=(--model "$O/model/model.txt" --axes "$O/model/axes.txt" --views "$O/views" --ids "$O/ids" --set height=64 --set edge=1 --set max_clutter=1)

# bake CODE WORD ARGUMENT...: runs bake_outdoors; checks its exit status and a word on standard error
bake()
{
    local code=$1 word=$2 rc=0; shift 2
    rm -rf made
    "$B/bin/bake_outdoors" "$@" >out.txt 2>err.txt </dev/null || rc=$?
    [ "$rc" = "$code" ] || { cat err.txt; fail "$*: exit $rc, wanted $code"; }
    grep -qF -- "$word" err.txt || { cat err.txt; fail "$*: nothing says '$word'"; }
    [ "$code" = 0 ] || grep -q 'bake_outdoors: error: .*[.?]$' err.txt || { cat err.txt; fail "$*: no sentence"; }
    [ "$code" = 0 ] || [ ! -e made ] || [ -z "$(find made -type f)" ] || fail "$*: a product was left"
}
a_closed_room_has_black_outdoors()
{
    m outdoors
    [ -s $O/outdoors/outdoors.exr ] || fail "no picture"
    grep -q 'no picture looks out of the model' $O/log/bake_outdoors.*.log || fail "the log says nothing"
    "$B/bin/verify" --file $O/outdoors/outdoors.exr || fail "the picture is not whole"
    cp $O/outdoors/outdoors.exr black.exr
}

windows_show_the_outdoors()
{
    { echo 'set glass 0.1'; for w in south west north east; do echo "window in-$w on $w from -25 0.2 to 25 18"; done; } >>scenes/t/model.txt
    m outdoors
    grep -q '% from [1-9][0-9]* views' $O/log/bake_outdoors.*.log || { cat $O/log/bake_outdoors.*.log; fail "no view shows the outdoors"; }
    ! cmp -s black.exr $O/outdoors/outdoors.exr || fail "the picture is as black as that of a closed room"
    ! grep -qF "$PWD" $O/outdoors/outdoors.exr || fail "the product names a folder of this machine"
    find $O/outdoors -type f -printf '%p %T@\n' >before
    m outdoors
    find $O/outdoors -type f -printf '%p %T@\n' | diff before - || fail "a second make made it again"
}

the_sky_and_the_sun_are_written_down()
{
    grep -q '^remodel-sky 1$' $O/outdoors/sky.txt || fail "sky.txt has no first line"
    grep -Eq '^sky ([0-9]+ brightest|unknown)' $O/outdoors/sky.txt || { cat $O/outdoors/sky.txt; fail "no sky"; }
    grep -q '^sun unknown$' $O/outdoors/sky.txt || { cat $O/outdoors/sky.txt; fail "a sun where there is none"; }
    grep -q '^patches gain' $O/outdoors/sky.txt || fail "patches were not looked for"
    bake 0 'directions' "${inputs[@]}" --vita $O/fill --set sun=none --sky made/sky.txt --out made/a.exr
    ! grep -q '^patches' made/sky.txt || fail "patches were looked for with sun = none"
    bake 1 'no-such/' "${inputs[@]}" --vita no-such --out made/a.exr
}

bytes_do_not_depend_on_threads()
{
    for n in 1 2; do bake 0 'directions' "${inputs[@]}" --threads $n --vita $O/fill --things $O/things --sky two/$n.txt --out two/$n.exr; done
    cmp two/1.txt two/2.txt
    cmp two/1.exr two/2.exr
    cmp two/1.exr $O/outdoors/outdoors.exr
}

what_stands_before_a_window_is_left_out()
{
    bake 0 'no picture looks out of the model' "${inputs[@]}" --set max_clutter=0.6 --out made/a.exr
}

a_reference_image_without_a_pose_is_left_out()
{
    view=$(ls $O/views/*.exr | sed -n 1p)
    bake 0 'is left out, because its pose in the scene is unknown' "${inputs[@]}" --reference "$view" --out made/a.exr
}

errors_say_what_is_wrong()
{
    bake 2 '--out is missing' "${inputs[@]}"
    bake 2 'height = 66 is no multiple of 4; give 68' "${inputs[@]}" --set height=66 --out made/a.exr
    bake 1 'no-such.exr' "${inputs[@]}" --reference no-such.exr --out made/a.exr
    bake 1 'no-such/' --model $O/model/model.txt --axes $O/model/axes.txt --views $O/views --ids no-such --out made/a.exr
    bake 1 'no-such.txt' --model no-such.txt --axes $O/model/axes.txt --views $O/views --ids $O/ids --out made/a.exr
}

for t in a_closed_room_has_black_outdoors windows_show_the_outdoors the_sky_and_the_sun_are_written_down bytes_do_not_depend_on_threads what_stands_before_a_window_is_left_out a_reference_image_without_a_pose_is_left_out errors_say_what_is_wrong; do run "$t"; done
