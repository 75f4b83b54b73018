# a described scene is photographed by make, again only if its description changed; its edited scene on demand
. tests/lib.sh

# describe SCENE: a small room, three photos in two exposures, one reference image, an edited scene "dark"
describe()
{
    mkdir -p "scenes/$1"
    cat >"scenes/$1/scene.txt" <<'TXT'
remodel-scene 1
texture plain plaster 0.3 0.4 1  0.6 0.58 0.5
material m lambert plain
room hall 0 0 4 3  0 2.5  m m
wall south 0 0 4 0  0 2.5 0.2 m
wall east 4 0 4 3  0 2.5 0.2 m
wall north 4 3 0 3  0 2.5 0.2 m
wall west 0 3 0 0  0 2.5 0.2 m
lamp l quad 1 1 2.49  0 1 0  1 0 0  10 10 9
TXT
    sed 's/10 10 9$/3 3 3/' "scenes/$1/scene.txt" >"scenes/$1/scene-dark.txt"
    cat >"scenes/$1/cameras.txt" <<'TXT'
remodel-shoot 1
lens p pinhole 60 40 50 50 30 20
exposure 0.02
exposure 0.04
sensor 30000 6 1 5
photo a p 1 1 1.5  3 2 1.2
photo b p 1.2 1 1.5  3 2 1.2
photo c p 1.4 1 1.5  3 2 1.2
reference r p 2 1 1  0 1 1
TXT
    printf '[simulate]\nsamples = 4\nirradiance_samples = 64\n' >"scenes/$1/scene.cfg"
    printf 'PHOTOS := out/%s/simulated/photos\n' "$1" >"scenes/$1/scene.mk"
}
m() { make -s DEPS=manual SCENE=room "$@" >log 2>&1 || { cat log; fail "make $*"; }; }
times() { find out/room/simulated -type f -printf '%P %T@\n' | LC_ALL=C sort; }
bytes() { (cd "$1" && find . -type f | LC_ALL=C sort | xargs sha256sum); }

photos_are_made_once_and_again_if_the_description_changes()
{
    project described; describe room
    m hdr CORES=2
    bytes out/room/simulated >"$scratch/two.bytes"
    [ "$(find out/room/simulated/photos -name '*.jpg' | wc -l)" = 6 ] || fail "wanted two exposures of three photos"
    [ -e out/room/hdr/a.exr ] || fail "they were not merged"
    times >a; m hdr; times >b
    diff a b || fail "a second make remade photos"
    sed -i 's/^photo b p 1.2/photo b p 1.25/' scenes/room/cameras.txt
    m hdr; times >b
    grep -q photos/b_e0.jpg <(comm -13 a b) || fail "the photos of a moved camera were not remade"
}

# two edits, one of them a difference, from one photo and one witness
several_edits_are_made_from_chosen_cameras()
{
    project edits; describe room
    printf 'remodel-scene 2\nbase scene.txt\ndrop l\nlamp l quad 1 1 2.4  0 1 0  1 0 0  9 9 9\n' >scenes/room/scene-low.txt
    echo 'witness w p 1.3 1 1.5  3 2 1.2' >>scenes/room/cameras.txt
    m edited EDITS=all EDIT_VIEWS='b w' IRRADIANCE_VIEWS=b
    for e in dark low; do
        for f in scene.txt images.txt hdr/b.exr depth/b.exr ids/w.exr irradiance/b.exr; do
            [ -e "out/room/simulated/truth/edited-$e/$f" ] || fail "there is no $f of $e"
        done
        [ ! -e "out/room/simulated/truth/edited-$e/hdr/a.exr" ] || fail "a was rendered, too"
    done
    grep -q '^lamp l quad 1 1 2.4 ' out/room/simulated/truth/edited-low/scene.txt || fail "the edited scene is not complete"
    ! grep -q '^lamp l quad 1 1 2.49' out/room/simulated/truth/edited-low/scene.txt || fail "the dropped lamp is still there"
    times >a; m edited EDITS='low dark' EDIT_VIEWS=b; times >b
    diff a b || fail "a second make remade something"
    ! make -s DEPS=manual SCENE=room edited EDITS=low EDIT_VIEWS=z >log 2>&1 || fail "an unknown camera was accepted"
    grep -q 'no such photo or witness' log || { cat log; fail "the message does not name the camera"; }
}

more_truth_is_made_on_demand()
{
    project truth; describe room
    printf 'furniture on\nbox b 2 1 0 2.5 1.5 0.5 m\n' >>scenes/room/scene.txt
    sed -i '1s/1/2/' scenes/room/scene.txt
    echo 'witness w p 1.3 1 1.5  3 2 1.2' >>scenes/room/cameras.txt
    m truth IRRADIANCE_VIEWS=a
    for f in novel/hdr/w novel/depth/w novel/ids/w shell/hdr/a shell/ids/c shell/depth/w irradiance/a; do
        [ -e "out/room/simulated/truth/$f.exr" ] || fail "there is no $f"
    done
    grep -q 'w.jpg' out/room/simulated/truth/novel/images.txt || fail "the witness has no camera"
    [ ! -e out/room/simulated/photos ] || fail "the photos were made, too"
    times >a; m truth; times >b
    diff a b || fail "a second make remade something"
}

the_edited_scene_is_made_on_demand()
{
    project edited; describe room
    m edited EDIT=dark
    for f in scene.txt faces.txt hdr/a.exr depth/b.exr ids/c.exr; do
        [ -e "out/room/simulated/truth/edited-dark/$f" ] || fail "there is no $f"
    done
    [ ! -e out/room/simulated/photos ] || fail "the original scene was photographed, too"
    times >a; m edited EDIT=dark; times >b
    diff a b || fail "a second make remade it"
    ! make -s DEPS=manual SCENE=room edited >log 2>&1 || fail "make edited without EDIT succeeded"
    grep -q 'EDIT=E' log || fail "the message does not name the missing variable"
}

# two exposures of r become one view, on the scale of the photos, with its described camera
lighting_reference_images_are_merged_but_not_rectified()
{
    project lri; describe room
    sed -i 's/^reference r p/lens f equisolid 60 40 27 30 20\nreference r f/' scenes/room/cameras.txt
    printf 'LRI := out/room/simulated/lri\nLRI_SFM := out/room/simulated/truth/lri\nLRI_FRAME := scene\n' >>scenes/room/scene.mk
    m lri
    [ "$(cd out/room/lri && echo *)" = "photos r.exr r.jpg" ] || { ls -R out/room/lri; fail "wanted one picture"; }
    [ ! -e out/room/hdr/a.exr ] || fail "the photos were merged, too"
    grep -aq 'OPENCV_FISHEYE 60 40 27 27 30 20 -0.04' out/room/lri/r.exr && grep -aq worldToCamera out/room/lri/r.exr || fail "the picture does not contain its camera"
    [ "$(awk '$1 == "brackets" { print $2, $4 }' out/room/lri/photos/r.txt)" = "2 $(awk '$1 == "brackets" { print $4 }' out/room/photos/a.txt)" ] ||
        { cat out/room/lri/photos/r.txt; fail "not two exposures on the scene's scale"; }
    "$root/$B/tests/bench/picture_error" out/room/lri/r.exr out/room/lri/r.exr >err || { cat err; fail "it cannot be read"; }
    find out/room/lri -type f -printf '%P %T@\n' | sort >a; m lri; find out/room/lri -type f -printf '%P %T@\n' | sort >b
    diff a b || fail "a second make remade it"
    echo '[import_photos]' >>scenes/room/scene.cfg; echo 'brackets = no' >>scenes/room/scene.cfg # for the photos
    m lri
    grep -q 'have no common scale' log && grep -q '^brackets 2' out/room/lri/photos/r.txt || { cat log; fail "no warning about the other scale"; }
    ! make -s DEPS=manual SCENE=room lri LRI_FRAME=world >log 2>&1 || fail "make lri in an unknown frame succeeded"
    grep -q 'LRI_FRAME=world: wanted photos, scene or model' log || { cat log; fail "the message does not name the frames"; }
    ! make -s DEPS=manual SCENE=room lri LRI= >log 2>&1 || fail "make lri without LRI succeeded"
    grep -q 'LRI=DIR' log || { cat log; fail "the message does not name the missing variable"; }
    ! make -s DEPS=manual SCENE=room lri LRI=nowhere >log 2>&1 || fail "make lri of a missing folder succeeded"
    grep -q 'nowhere is not a folder' log || { cat log; fail "the message does not name the folder"; }
}

# the photos, whose poses are those of the truth, bring the reference image into the scene's frame
lighting_reference_images_are_placed_by_the_photos()
{
    project placed; describe room
    printf 'LRI := out/room/simulated/lri\nLRI_SFM := out/room/simulated/truth/lri\nSFM := out/room/simulated/truth\n' >>scenes/room/scene.mk
    m lri
    grep -aq 'remodel:frame' out/room/lri/r.exr || { cat log; fail "the picture does not state how its frame was found"; }
    grep -q 'placed in the scene by 3 photographs' out/room/log/hdr_merge.lri.r.log || { cat out/room/log/hdr_merge.lri.r.log; fail "not placed by the photos"; }
    find out/room/lri -type f -printf '%P %T@\n' | sort >a; m lri; find out/room/lri -type f -printf '%P %T@\n' | sort >b
    diff a b || fail "a second make remade it"
}

# six photos of brick walls give the axes of a room, a script its walls; a window of these is marked in the reference image
marked_corners_place_a_reference_image()
{
    project corners; describe room
    sed -i 's/^texture plain.*/texture plain brick 0.23 0.075 0.012 21  0.56 0.30 0.21  0.62 0.58 0.52/' scenes/room/scene.txt
    sed -i -e '/^photo/d' -e 's/^lens p.*/lens p pinhole 120 80 60 60 60 40/' scenes/room/cameras.txt
    for p in 'a p 0.8 0.8 1.4  3 2.2 0.9' 'b p 1.1 0.7 1.4  3 2.2 0.9' 'c p 0.8 1.1 1.4  3 2.2 0.9' 'd p 1.1 1.0 1.6  3 2.4 1.5' \
        'e p 0.8 0.9 1.7  3 2.2 1.9' 'g p 1.1 0.9 1.7  3 2.2 1.9'; do echo "photo $p" >>scenes/room/cameras.txt; done
    sed -i 's/^samples.*/samples = 8/' scenes/room/scene.cfg
    printf '[segment_depth]\nplanes = 48\npasses = 1\n' >>scenes/room/scene.cfg
    printf 'LRI := out/room/simulated/lri\nLRI_FRAME := corners\nSFM := out/room/simulated/truth\n' >>scenes/room/scene.mk
    ! make -s DEPS=manual SCENE=room lri >log 2>&1 || fail "make lri without marks succeeded"
    grep -q 'LRI_FRAME=corners wants scenes/room/lri.txt' log || { cat log; fail "the message does not name the marks"; }
    # a camera at 0.3 0.5 1.2 of the model looks at its southern wall
    cat >scenes/room/lri.txt <<'TXT'
lens * PINHOLE 120 80 60 60 60 40
corner r w left bottom 43.2 49.6
corner r w left top 43.2 20.8
corner r w right bottom 91.2 49.6
corner r w right top 91.2 20.8
TXT
    ! make -s DEPS=manual SCENE=room lri >log 2>&1 || fail "make lri without a model succeeded"
    grep -q 'LRI_FRAME=corners wants scenes/room/model.txt' log || { cat log; fail "the message does not name the model"; }
    cat >scenes/room/model.txt <<'TXT'
remodel-script 1
set thickness 0.2
set ceiling 2.5
set glass 0.02
wall south from 3 -2 to -3 -2
wall west from -3 -2 to -3 2
wall north from -3 2 to 3 2
wall east from 3 2 to 3 -2
join south west north east south
room hall south west north east
window w on south from -1 0.8 to 1 2
TXT
    m lri
    local said=out/room/log/hdr_merge.lri.r.log
    grep -q 'its camera is at 0.300 0.500 1.200 units in the model' $said || { cat $said; fail "it is at another place"; }
    grep -q '2.50 units in front of the inner face of the wall south' $said || { cat $said; fail "not in front of the wall"; }
    grep -aq 'marks 4 ' out/room/lri/r.exr && grep -aq worldToCamera out/room/lri/r.exr || fail "the picture does not state how its frame was found"
    find out/room/lri out/room/model -type f -printf '%P %T@\n' | sort >a; m lri
    find out/room/lri out/room/model -type f -printf '%P %T@\n' | sort | diff a - || fail "a second make remade something"
    echo 'point r 60 40 0.3 -2 1.2' >>scenes/room/lri.txt; m lri
    grep -q 'placed by 5 marks' $said || { cat $said; fail "a new mark did not remake the picture"; }
    sed -i 's/ w left/ door left/' scenes/room/lri.txt
    ! make -s DEPS=manual SCENE=room lri >log 2>&1 || fail "a mark of no window was accepted"
    grep -q 'scenes/room/lri.txt:2: found the opening "door"' log || { cat log; fail "the message does not name the line"; }
    printf 'lens * PINHOLE 120 80 60 60 60 40\nin r w looking out\n' >scenes/room/lri.txt; m lri
    grep -q 'no photo looks out of w, so that nothing tells how the image is turned' $said || { cat $said; fail "the views were not looked at"; }
}

# a lens of 180 degrees: black corners, the middle in the light of the room
a_hemisphere_is_merged_with_its_image_circle()
{
    project dome; describe room
    sed -i 's/^reference r p/lens d equisolid 48 48 16.9705627 24 24 circle 180\nreference r d/' scenes/room/cameras.txt
    printf 'LRI := out/room/simulated/lri\nLRI_SFM := out/room/simulated/truth/lri\nLRI_FRAME := scene\n' >>scenes/room/scene.mk
    m lri
    [ -s out/room/lri/r.exr ] || { ls -R out/room/lri; fail "wanted one picture"; }
    grep -aq 'OPENCV_FISHEYE 48 48 16.97' out/room/lri/r.exr || fail "the picture does not contain its camera"
}

# a fisheye photo has several views, made by one process; a deleted or stale view is remade alone
views_of_one_photo_are_made_by_one_process()
{
    project wide; describe room
    sed -i 's/^photo a p/lens f equisolid 60 40 27 30 20\nphoto a f/; s/^photo \([bc]\) p/photo \1 f/' scenes/room/cameras.txt
    echo 'SFM := out/room/simulated/truth' >>scenes/room/scene.mk
    m views
    for v in a@0 a@1 a@2 b@0 b@1 b@2 c@0 c@1 c@2; do [ -s "out/room/views/$v.exr" ] || { ls out/room/views; fail "there is no $v"; }; done
    [ "$(cd out/room/log && echo rectify.*.log)" = "rectify.a.log rectify.b.log rectify.c.log" ] || { ls out/room/log; fail "wanted one process for each photo"; }
    (cd out/room/views && sha256sum -- *.exr) >before
    find out/room/views -name '*.exr' -printf '%P %T@\n' | sort >a
    rm out/room/views/b@1.exr
    m views
    find out/room/views -name '*.exr' -printf '%P %T@\n' | sort >b
    [ "$(comm -13 a b | cut -d' ' -f1)" = b@1.exr ] || { comm -13 a b; fail "not only the deleted view was remade"; }
    (cd out/room/views && sha256sum -c --quiet ../../../before) || fail "other bytes"
    touch -d '2 hours ago' out/room/views/c@0.exr
    m views
    find out/room/views -name '*.exr' -printf '%P %T@\n' | sort >a
    [ "$(comm -13 b a | cut -d' ' -f1)" = c@0.exr ] || { comm -13 b a; fail "not only the stale view was remade"; }
    m views
    find out/room/views -name '*.exr' -printf '%P %T@\n' | sort | diff a - || fail "a third make remade a view"
}

one_core_gives_the_bytes_of_two()
{
    project one; describe room; m hdr CORES=1; bytes out/room/simulated >"$scratch/one.bytes"
    diff "$scratch/one.bytes" "$scratch/two.bytes" || fail "they differ"
}

an_error_in_the_description_is_named_and_leaves_no_product()
{
    project fault; describe room
    sed -i '5s/.*/wall south 0 0 4 zero  0 2.5 0.2 m/' scenes/room/scene.txt
    ! make -s DEPS=manual SCENE=room hdr >log 2>&1 || fail "make succeeded"
    grep -q 'scenes/room/scene.txt:5: found' log || { cat log; fail "the message does not name file and line"; }
    describe room; sed -i '/^lamp/d' scenes/room/scene.txt
    ! make -s DEPS=manual SCENE=room hdr >log 2>&1 || fail "make succeeded without a light"
    grep -qi 'light' log || { cat log; fail "the message does not name the missing light"; }
    [ -z "$(find out/room/simulated -type f 2>/dev/null)" ] || { find out/room/simulated; fail "a product was left"; }
}

for t in photos_are_made_once_and_again_if_the_description_changes the_edited_scene_is_made_on_demand \
    several_edits_are_made_from_chosen_cameras more_truth_is_made_on_demand lighting_reference_images_are_merged_but_not_rectified \
    lighting_reference_images_are_placed_by_the_photos marked_corners_place_a_reference_image a_hemisphere_is_merged_with_its_image_circle \
    views_of_one_photo_are_made_by_one_process one_core_gives_the_bytes_of_two \
    an_error_in_the_description_is_named_and_leaves_no_product; do run "$t"; done
