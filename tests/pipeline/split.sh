# SPLIT: one photograph of a multi-lens camera is cut into pictures; from there to depth; on a synthetic scene with known poses
. tests/lib.sh
project split
photos set >/dev/null

# cell K: name of picture K, from 1, in 3 columns
cell() { echo "c$((($1 - 1) % 3 + 1))r$((($1 - 1) / 3 + 1))"; }
# raw FILE: its pixels
raw() { ffmpeg -v error -i "$1" -f rawvideo -pix_fmt rgb24 -; }
# tiled FROM TO [TILE-OPTIONS]: photos FROM (%d: 1 to 6) as the pictures of one photo
tiled() { mkdir -p "$(dirname "$2")"; ffmpeg -v error -y -start_number 1 -i "$1" -vf "format=rgb24,tile=3x2${3-}" -frames:v 1 -pix_fmt rgb24 "$2"; }
pictures_are() # SCENE ID: each has the pixels of its photo
{
    for k in 1 2 3 4 5 6; do
        cmp <(raw "out/$1/split/$2_$(cell $k).png") <(raw "one/photo_$k.png") || fail "picture $k has other pixels than its photo"
    done
}
mkdir one; for k in 1 2 3 4 5 6; do ffmpeg -v error -i "set/photos/photo_$k.jpg" -pix_fmt rgb24 "one/photo_$k.png"; done
tiled one/photo_%d.png "rig/IMG 1.png"
cp -r set/model model; for k in 1 2 3 4 5 6; do sed -i "s/photo_$k\.jpg/IMG_1_$(cell $k).png/" model/images.txt; done
small t
m() { make -s DEPS=manual SCENE=t "$@" >log 2>&1; }

from_one_photo_to_depth()
{
    m PHOTOS=rig SPLIT=3x2 SFM=model depth || { cat log; fail "make depth"; }
    grep -qx 'SPLIT := 3x2' scenes/t/scene.mk || fail "scene.mk does not keep SPLIT"
    grep -q '1 of 1 photos cut into 3 x 2 pictures' log || { cat log; fail "the run does not report the cut"; }
    pictures_are t IMG_1
    grep -qx 'cut IMG_1_c3r2.png [0-9a-f]* 320 120' out/t/split/split.txt || { cat out/t/split/split.txt; fail "split.txt does not place the picture"; }
    [ "$(wc -w <out/t/views/views.mk)" = 8 ] || { cat out/t/views/views.mk; fail "wanted six views"; }
    for k in 1 2 3 4 5 6; do [ -s "out/t/depth/IMG_1_$(cell $k).exr" ] || fail "no depth of picture $k"; done
    ls rig | cmp - <(echo "IMG 1.png") || fail "something was written into the folder of photos"
}

the_next_make_does_nothing()
{
    find out/t -name '*.exr' -o -path '*/split/*' | LC_ALL=C sort | xargs -d '\n' stat -c '%n %y' >a
    m depth || { cat log; fail "make"; }
    find out/t -name '*.exr' -o -path '*/split/*' | LC_ALL=C sort | xargs -d '\n' stat -c '%n %y' | diff a - || fail "a second make remade something"
    make -s DEPS=manual SCENE=t -n depth >log 2>&1; ! grep run_stage log || fail "make -n would run something"
}

a_changed_picture_redoes_its_view()
{
    snapshot out/t >a
    photos other --change 5 >/dev/null
    ffmpeg -v error -y -i other/photos/photo_5.jpg -pix_fmt rgb24 one/photo_5.png
    cp "rig/IMG 1.png" keep.png
    tiled one/photo_%d.png "rig/IMG 1.png"
    m depth || { cat log; fail "make"; }
    pictures_are t IMG_1
    snapshot out/t >b; changed a b >c
    grep -qx views/IMG_1_c2r2.exr c || { cat c; fail "the view was not remade"; }
    ! grep -E '^(sfm/|views/IMG_1_(c[13]|c2r1)|views/images)' c || fail "too much was remade"
    for d in out/t/depth/IMG_1_c?r?.d; do
        v=$(basename "$d" .d)
        if reads "$d" IMG_1_c2r2; then grep -qx "depth/$v.exr" c || fail "$v reads the changed view, but was not remade"; fi
    done
    ffmpeg -v error -y -i set/photos/photo_5.jpg -pix_fmt rgb24 one/photo_5.png
    cp keep.png "rig/IMG 1.png"
}

a_lost_picture_is_cut_again()
{
    rm out/t/split/IMG_1_c1r1.png
    m views || { cat log; fail "make"; }
    pictures_are t IMG_1
}

pictures_are_excluded_and_masked_by_id()
{
    mkdir -p scenes/t/masks
    ffmpeg -v error -f lavfi -i color=white:s=160x120 -vf "drawbox=x=30:y=20:w=60:h=50:color=black:t=fill" -frames:v 1 -y scenes/t/masks/IMG_1_c2r1.png
    m EXCLUDE=IMG_1_c3r2 views || { cat log; fail "make"; }
    ! grep -q warning: log || { cat log; fail "a warning"; }
    [ "$(wc -w <out/t/views/views.mk)" = 7 ] || { cat out/t/views/views.mk; fail "wanted five views"; }
    [ "$(alpha out/t/views/IMG_1_c2r1.exr 60 40)" = 00000000 ] || fail "the mask hides nothing"
    rm -r scenes/t/masks
}

between_dark_lines()
{
    small dark; sed -i '1i [import_photos]\nsplit_dark = 16' scenes/dark/scene.cfg
    tiled one/photo_%d.png dark/film.png :padding=6:margin=4:color=black
    make -s DEPS=manual PHOTOS=dark SPLIT=3x2 SFM=none SCENE=dark sfm >log 2>&1 || true # there is no model "none": the run ends after the photos are cut
    pictures_are dark film
    sed -i 's/^split_dark.*/split_border = 4\nsplit_gap = 6/' scenes/dark/scene.cfg
    make -s DEPS=manual SCENE=dark sfm >log 2>&1 || true
    pictures_are dark film
    grep -q '^grid 3 2 4 6 0$' out/dark/split/split.txt || fail "the pictures were not cut by border and gap"
}

exposures_of_a_multi_lens_camera_are_merged_lens_by_lens()
{
    photos bracketed --brackets 3 >/dev/null
    for e in 0 1 2; do tiled "bracketed/photos/photo_%d_e$e.jpg" "brackets/shot$e.png"; done
    small b
    for k in 1 2 3 4 5 6; do for e in 0 1 2; do echo "shot${e}_$(cell $k).png $((1 << 2 * e))"; done; done >scenes/b/exposures.txt
    make -s DEPS=manual PHOTOS=brackets SPLIT=3x2 SCENE=b hdr >log 2>&1 || { cat log; fail "make hdr"; }
    grep -q '6 views of 3 exposures each: 1 s, 4 s, 16 s' log || { cat log; fail "the run does not show the cycle"; }
    for k in 1 2 3 4 5 6; do [ -s "out/b/hdr/shot0_$(cell $k).exr" ] || { ls out/b/hdr; fail "picture $k was not merged"; }; done
    cp scenes/b/exposures.txt brackets/
    make -s DEPS=manual SCENE=b hdr >log 2>&1 || { cat log; fail "make hdr"; }
    grep -q 'warning: .*brackets/exposures.txt is not read' log || { cat log; fail "no warning that exposures.txt is not read"; }
    sed -i 1d scenes/b/exposures.txt
    ! make -s DEPS=manual SCENE=b hdr >log 2>&1 || fail "a bracket without an exposure was merged"
    grep -q 'belong to no complete one: shot0_c1r1.png' log || { cat log; fail "the message does not name the picture"; }
}

another_grid_redoes_structure_from_motion()
{
    m sfm || { cat log; fail "make sfm"; }
    sed -i '1i [import_photos]\nsplit_border = 1' scenes/t/scene.cfg
    snapshot out/t >a
    m sfm || { cat log; fail "make sfm"; }
    snapshot out/t >b; changed a b >c
    grep -qx sfm/models.txt c || { cat c; fail "SfM was not redone"; }
    grep -qx 'cut IMG_1_c2r1.png [0-9a-f]* 160 1' out/t/split/split.txt || { cat out/t/split/split.txt; fail "the border is not there"; }
}

# cameras on an arc: from each of three places to the next, two go along like the lenses of one camera
lenses_keep_their_poses_in_the_camera()
{
    local k=0
    small lenses; printf '[sfm_import]\nrefine = yes\n' >>scenes/lenses/scene.cfg
    cp -r set/model offset
    # poses off by some millimetres
    awk 'NF == 10 { k++; for (i = 6; i < 9; i++) $i += 0.01 * sin(7 * k + i) } 1' set/model/images.txt >offset/images.txt
    mkdir pairs
    for shot in 1 2 3; do
        ffmpeg -v error -y -start_number $((2 * shot - 1)) -i one/photo_%d.png -vf "format=rgb24,tile=2x1" -frames:v 1 -pix_fmt rgb24 "pairs/shot$shot.png"
        for column in 1 2; do k=$((k + 1)); sed -i "s/photo_$k\.jpg/shot${shot}_c${column}r1.png/" offset/images.txt; done
    done
    make -s DEPS=manual PHOTOS=pairs SPLIT=2x1 SFM=offset SCENE=lenses sfm >log 2>&1 || { cat log; fail "make sfm"; }
    grep -q 'the 2 lenses of the multi-lens camera have the same poses relative to each other in its 3 photos' log || { cat log; fail "the lenses were not adjusted as one camera"; }
    # the third camera's lenses the wrong way round
    sed -i 's/shot3_c1r1/shot3_c3r1/; s/shot3_c2r1/shot3_c1r1/; s/shot3_c3r1/shot3_c2r1/' offset/images.txt
    make -s DEPS=manual SCENE=lenses sfm >log 2>&1 || { cat log; fail "make sfm"; }
    grep -q 'warning: the 2 lenses of the multi-lens camera are not at the same places' log || { cat log; fail "no warning about lenses that moved"; }
}

photos_that_cannot_be_cut_are_named()
{
    mkdir odd; ffmpeg -v error -y -i "rig/IMG 1.png" -vf "pad=481:241" odd/a.png
    make -s DEPS=manual PHOTOS=odd SPLIT=3x2 SFM=none SCENE=odd sfm >log 2>&1 || true
    grep -q 'a.png: 481 x 241 px are no multiple of 3 x 2 pictures; 1 px across and 1 px down' log || { cat log; fail "no warning about the pixels left over"; }
    [ "$(grep -c '^cut ' out/odd/split/split.txt)" = 6 ] || fail "it was not cut"
    rc=0; make -s DEPS=manual SCENE=odd SPLIT=60x2 sfm >log 2>&1 || rc=$?
    [ "$rc" = 2 ] && grep -q 'leaves 8 px for a picture' log || { cat log; fail "pictures of 8 px were cut"; }
    cp set/photos/photo_1.jpg odd/b.jpg; truncate -s 900 odd/b.jpg
    ! make -s DEPS=manual SCENE=odd sfm >log 2>&1 || fail "a damaged photo was cut"
    grep -q 'b.jpg is a damaged' log && grep -q 'EXCLUDE = b' log || { cat log; fail "the message does not name the damaged photo"; }
    make -s DEPS=manual SCENE=odd EXCLUDE=b sfm >log 2>&1 || true
    ! grep -q 'damaged\|no photo in' log || { cat log; fail "it was not left out"; }
    ! make -s DEPS=manual SCENE=odd SPLIT= EXCLUDE=b sfm >log 2>&1 || fail "one photo made a scene"
    grep -q 'contains one photo besides those left out' log || { cat log; fail "without SPLIT the message does not count one photo"; }
}

for t in from_one_photo_to_depth the_next_make_does_nothing a_changed_picture_redoes_its_view a_lost_picture_is_cut_again \
    pictures_are_excluded_and_masked_by_id between_dark_lines exposures_of_a_multi_lens_camera_are_merged_lens_by_lens \
    another_grid_redoes_structure_from_motion lenses_keep_their_poses_in_the_camera photos_that_cannot_be_cut_are_named; do run "$t"; done
