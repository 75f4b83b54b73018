# films of given cameras: from transforms.json, from COLMAP's text, from Blender; refusals
. tests/lib.sh
unset CAMERAS EYES FILM
project given
photos set --views 3 --size 160x120 >/dev/null
small t
sed -i 's/^planes = .*/planes = 32\nrounds = 0/; s/^seconds = .*/seconds = 0.25/; s/^max_side = .*/max_side = 96/' scenes/t/scene.cfg
make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=t path >log 2>&1 || { cat log; fail "make"; }
move=out/t/parallax/establishing_dolly

# same FOLDER: its cameras are those of the move, to nine digits
same()
{
    for f in cameras images; do
        paste -d' ' <(grep '^[0-9]' "$move/path/$f.txt") <(grep '^[0-9]' "$1/path/$f.txt") |
            awk '{ for (i = 1; i <= NF / 2; i++) { a = $i; b = $(i + NF / 2); d = a - b; if (a != b && (d > 1e-9 || d < -1e-9)) exit 1 } }' || fail "$1: $f.txt differs"
    done
}

a_film_follows_transforms_json()
{
    cp $move/transforms.json fly.json
    make -s DEPS=manual SCENE=t CAMERAS=fly.json video >log 2>&1 || { cat log; fail "make"; }
    same out/t/parallax/fly
    [ -s out/t/parallax/fly/video.mp4 ] || fail "no film"
    ! grep -q establishing_dolly/video log || fail "another film was made"
    make -s DEPS=manual SCENE=t CAMERAS=fly.json video >log 2>&1
    ! grep -q 'plan_path\|render_views' log || { cat log; fail "a second run made something"; }
    sed -i 's/"fl_x": [0-9.]*/"fl_x": 80/g' fly.json
    make -s DEPS=manual SCENE=t CAMERAS=fly.json path >log 2>&1 || { cat log; fail "make"; }
    grep -q '^1 PINHOLE [0-9]* [0-9]* 80 ' out/t/parallax/fly/path/cameras.txt || fail "a changed file changed nothing"
}

a_film_follows_a_model()
{
    cp -r $move/path flight
    make -s DEPS=manual SCENE=t CAMERAS=flight/ path >log 2>&1 || { cat log; fail "make"; }
    same out/t/parallax/flight
}

# blender.py, run by what stands for Blender, makes the animated camera that blender_cameras.py writes again
cameras_survive_blender()
{
    command -v python3 >/dev/null || skip "python3 is not installed"
    python3 "$root/tests/cli/stand_in_blender.py" $move/blender.py "$root/docs/blender_cameras.py" blent >log 2>&1 || { cat log; fail "the scripts"; }
    make -s DEPS=manual SCENE=t CAMERAS=blent path >log 2>&1 || { cat log; fail "make"; }
    same out/t/parallax/blent
}

refused() { local rc=0; make -s DEPS=manual SCENE=t "$1" video >log 2>&1 || rc=$?; [ "$rc" != 0 ] && grep -qF -- "$2" log || { cat log; fail "$1: no '$2'"; }; }

what_is_no_path_is_refused()
{
    refused CAMERAS=nowhere.json 'has no cameras. Give transforms.json'
    mkdir -p empty; refused CAMERAS=empty 'has no cameras. Give transforms.json'
    cp $move/transforms.json 'my path.json'; refused 'CAMERAS=my path.json' 'wanted a name of letters'
    cp $move/transforms.json dolly_in.json; refused CAMERAS=dolly_in.json 'dolly_in means something else'
    rc=0; make -s DEPS=manual SCENE=t CAMERAS=fly.json CAMERAS_FRAME=model video >log 2>&1 || rc=$?
    [ "$rc" != 0 ] && grep -q "CAMERAS_FRAME=model: a film's cameras are in the scene's frame" log || { cat log; fail "CAMERAS_FRAME with a film"; }
    echo '{"frames": 3}' >bad.json; refused CAMERAS=bad.json 'has no list "frames" of cameras'
    [ ! -e out/t/parallax/bad/path.txt ] || fail "a path was left"
    rc=0; "$B/bin/plan_path" --views out/t/views --effect x --out x --cameras fly.json --keyframes k 2>err.txt || rc=$?
    [ "$rc" = 2 ] && grep -q 'or --cameras for a film of given cameras' err.txt || { cat err.txt; fail "--keyframes with --cameras"; }
}

for t in a_film_follows_transforms_json a_film_follows_a_model cameras_survive_blender what_is_no_path_is_refused; do run "$t"; done
