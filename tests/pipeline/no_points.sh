# two cameras without points: points are triangulated, or the run goes on without points and warns
. tests/lib.sh
project no_points
photos set --views 2 >/dev/null
: >set/model/points3D.txt
awk '/^#/ { print; next } { n++; print n % 2 ? $0 : "" }' set/model/images.txt >images.tmp && mv images.tmp set/model/images.txt

# scene NAME: photos NAME/photos, the cameras of set; one round of few planes
scene()
{
    small "$1"
    sed -i 's/^planes = .*/planes = 32\nrounds = 0/' "scenes/$1/scene.cfg"
    mkdir -p "$1/photos"
}
points() { grep -vc '^#' "out/$1/views/points3D.txt" || true; }
m() { make -s DEPS=manual "SCENE=$1" "PHOTOS=$1/photos" SFM=set/model "${@:2}" >log 2>&1; }

two_views_are_triangulated()
{
    scene two; cp set/photos/* two/photos/
    m two depth || { cat log; fail "make depth"; }
    [ "$(points two)" -ge 50 ] || { cat log; fail "$(points two) points, wanted 50"; }
    ! grep -q 'none can be found' log || fail "a warning that there are no points"
    ! cat out/two/log/segment_depth.*.log | grep 'sparse points' || fail "depths were guessed"
    [ -s out/two/depth/photo_1.exr ] && [ -s out/two/depth/photo_2.exr ] || fail "no depth"
}

blank_photos_give_a_warning_and_depth_without_points()
{
    scene blank
    for k in 1 2; do ffmpeg -loglevel error -y -f lavfi -i color=0x80808$k:size=160x120 -frames:v 1 "blank/photos/photo_$k.jpg" || fail "ffmpeg wrote no photo"; done
    m blank depth || { cat log; fail "make depth"; }
    [ "$(points blank)" = 0 ] || fail "a blank wall has points"
    grep -q 'warning: the model has no points that its photos share, and none can be found: the photos have no features' log || { cat log; fail "no warning that there are no points"; }
    grep -q 'warning: .*sparse points.*set \[segment_depth\] near and far' out/blank/log/segment_depth.photo_1.log || fail "no warning that the depths are guessed"
    [ -s out/blank/depth/photo_1.exr ] || fail "no depth"
}

unrelated_photos_give_a_warning_and_depth_without_points()
{
    scene apart; cp set/photos/photo_1.jpg apart/photos/
    ffmpeg -loglevel error -y -f lavfi -i testsrc2=size=160x120 -frames:v 1 apart/photos/photo_2.jpg || fail "ffmpeg wrote no photo"
    printf 'near = 3\nfar = 20\n' >near; sed -i '/^\[segment_depth\]/r near' scenes/apart/scene.cfg
    m apart depth || { cat log; fail "make depth"; }
    grep -q 'warning: the model has no points that its photos share, and none can be found: no two photos' log || { cat log; fail "no warning that there are no points"; }
    ! grep 'sparse points' out/apart/log/segment_depth.photo_1.log || fail "depths were guessed though near and far are set"
    awk '(NF == 7 || NF == 8) && /^[0-9]/ { n++; if ($5 * 3 > 1.31 || $5 * 20 < 0.69) bad++ } END { exit !(n > 50 && bad < n / 4) }' out/apart/depth/photo_1.txt || fail "depths are not between near and far"
}

two_models_without_points_are_both_triangulated()
{
    scene both; cp set/photos/* both/photos/
    mkdir -p models; cp -r set/model models/0; cp -r set/model models/1
    m both SFM=models sfm || { cat log; fail "make sfm"; }
    [ "$(grep -c 'triangulated [0-9]* points' out/both/log/sfm.all.log)" = 2 ] || { cat log; fail "not both were triangulated"; }
}

# a COLMAP that is killed while it triangulates gives an error, not a model without points
a_triangulation_that_fails_is_a_failure()
{
    scene killed; cp set/photos/* killed/photos/; mkdir fake
    printf '#!/bin/sh\n[ "$1" != point_triangulator ] || { echo "Triangulating image #1 (0)"; %s; }\nexec %s "$@"\n' 'kill -9 $$' "$(command -v colmap)" >fake/colmap
    chmod +x fake/colmap
    if PATH=$PWD/fake:$PATH m killed sfm; then cat log; fail "make did not fail"; fi
    grep -q 'colmap point_triangulator failed with exit status 137 (killed: out of memory?)' log || { cat log; fail "the message does not name the failed command"; }
}

for t in two_views_are_triangulated blank_photos_give_a_warning_and_depth_without_points unrelated_photos_give_a_warning_and_depth_without_points \
    two_models_without_points_are_both_triangulated \
    a_triangulation_that_fails_is_a_failure; do run "$t"; done
