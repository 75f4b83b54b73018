# render_views: errors of the command line, of effects, of paths, and of cameras that see nothing; ranges of frames
. tests/lib.sh
project render
photos set --views 3 --size 160x120 >/dev/null
small t
sed -i 's/^planes = .*/planes = 32\nrounds = 0/; s/^seconds = .*/seconds = 0.25/; s/^max_side = .*/max_side = 96/' scenes/t/scene.cfg
make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=t path >log 2>&1 || { cat log; fail "make"; }
move=out/t/parallax/establishing_dolly

# render CODE TEXT ARGUMENT...: renders the scene; checks the exit status and a text on standard error, and that usage errors leave no frame
render()
{
    local code=$1 word=$2 rc=0; shift 2
    rm -rf made
    "$B/bin/render_views" --views out/t/views --depth out/t/depth --path "${path:-$move}" --frames "${frames:-1}" --out made "$@" >out.txt 2>err.txt </dev/null || rc=$?
    [ "$rc" = "$code" ] || { cat err.txt; fail "$*: exit $rc, wanted $code"; }
    grep -qF -- "$word" err.txt || { cat err.txt; fail "$*: no '$word' on standard error"; }
    [ "$code" = 0 ] || grep -q 'render_views: error: .*[.]$' err.txt || { cat err.txt; fail "$*: the error is not a sentence"; }
    [ "$code" != 2 ] || [ -z "$(find made -type f 2>/dev/null)" ] || fail "$*: a frame was left"
}

invalid_arguments_exit_with_2_and_a_message()
{
    for c in 1,2,3 a,b,c,d 0,0,0,4 -1,0,4,4 '0,0,4,4x' ''; do render 2 'wanted X,Y,WIDTH,HEIGHT' "--crop=$c"; done
    render 2 '96 x 72 pixels' --crop=90,0,20,20
    for s in 0 -1 nan 17 big ''; do render 2 'wanted a number above 0, at most 16' "--scale=$s"; done
    render 2 'picture of 0 x 0 pixels' --crop=0,0,4,4 --scale=0.01
    render 2 renderer --renderer=best
    render 2 renderer --set renderer=best
    render 2 '--crop goes with flat pictures' --picture half_sphere --crop=0,0,8,8
    frames=0 render 2 'wanted frame numbers'
    frames=1:999 render 2 'wanted frame numbers'
    render 2 'more_views' --set more_views=99
    render 2 'soft_z' --set soft_z=nan
    rc=0
    "$B/bin/render_views" --views out/t/views --depth out/t/depth --cameras out/t/views --effects none --out made 2>err.txt || rc=$?
    [ "$rc" = 2 ] && grep -q -- '--effects goes with --path' err.txt || { cat err.txt; fail "--effects with --cameras: exit $rc"; }
}

errors_of_effects_name_file_and_line()
{
    render 1 nowhere.txt --effects=nowhere.txt
    printf 'remodel-effects 1\nlayer a sparkle\nregion all\nkey 0 1\n' >bad.txt
    render 1 'bad.txt:2: ' --effects=bad.txt
    printf 'remodel-effects 1\nlayer a saturation\nregion all\nkey 0 nan\n' >bad.txt
    render 1 'bad.txt:4: ' --effects=bad.txt
    printf 'remodel-effects 1\nlayer a saturation\nregion inside 0 0 0 1 1 1 0 axes 0 0 0 0\nkey 0 1\n' >bad.txt
    render 1 'bad.txt:3: found "a quaternion of length 0", wanted one of length 1' --effects=bad.txt
}

# broken_path SED FILE TEXT: the path with FILE changed by SED is rejected with file, line and text
broken_path()
{
    rm -rf bad; cp -r $move bad
    sed -i "$1" "bad/path/$2"
    path=bad render 1 "$3"
    grep -qE "bad/path(/|\.txt).*:[0-9]+: " err.txt || { cat err.txt; fail "no file and line"; }
}

errors_of_paths_name_file_and_line()
{
    broken_path '/^2 PINHOLE/s/PINHOLE \([0-9]* [0-9]*\) [^ ]*/PINHOLE \1 0/' cameras.txt 'focal'
    broken_path '/^2 PINHOLE/s/PINHOLE \([0-9]* [0-9]*\) [^ ]*/PINHOLE \1 -50/' cameras.txt '-50'
    broken_path '/^2 PINHOLE/s/PINHOLE \([0-9]* [0-9]*\) [^ ]*/PINHOLE \1 nan/' cameras.txt 'nan'
    broken_path '/ 0002.exr$/s/^2 [^ ]*/2 nan/' images.txt 'nan'
}

a_camera_that_sees_nothing_is_an_error_with_its_frame()
{
    rm -rf bad; cp -r $move bad # the second camera is far behind the scene, looking away from it
    sed -i '/ 0002.exr$/s/^2 \([^ ]* [^ ]* [^ ]* [^ ]*\) [^ ]* [^ ]* [^ ]*/2 \1 0 0 -1000000/' bad/path/images.txt
    path=bad frames=1:2 render 1 'frame 2 of the path sees nothing of the scene'
    [ "$(ls made)" = 0001.exr ] || fail "what was left: $(ls made)"
    path=bad frames=1:2 render 1 'frame 2 of the path sees nothing of the scene' --renderer=fast
}

# both renderers
ranges_of_frames_give_the_same_bytes()
{
    n=$(ls $move/path.txt >/dev/null && awk '$1 == "frames" { print $2 }' $move/path.txt)
    [ "$n" -ge 3 ] || fail "$n frames"
    for r in offline fast; do
        frames=1:$n render 0 '' --renderer=$r; (cd made && sha256sum -- *.exr) >whole.txt
        rm -rf parts; mkdir parts
        frames=2:$n render 0 '' --renderer=$r --threads=1; mv made/*.exr parts/
        frames=1 render 0 '' --renderer=$r; mv made/*.exr parts/
        (cd parts && sha256sum -- *.exr) | cmp - whole.txt || fail "other bytes, $r"
    done
}

for t in invalid_arguments_exit_with_2_and_a_message errors_of_effects_name_file_and_line errors_of_paths_name_file_and_line \
    a_camera_that_sees_nothing_is_an_error_with_its_frame ranges_of_frames_give_the_same_bytes; do run "$t"; done
