# one photo with its depth: a film without COLMAP, from DEPTH or from what a portrait carries
. tests/lib.sh
project one_photo
photos set --views 1 >/dev/null || true
one=$(ls set/photos/* | sed -n 1p)

# scene NAME: one round of few planes
scene() { small "$1"; sed -i 's/^planes = .*/planes = 32\nrounds = 0/' "scenes/$1/scene.cfg"; mkdir -p "$1/photos"; }
m() { make -s DEPS=manual "SCENE=$1" "PHOTOS=$1/photos" "${@:2}" >log 2>&1; }
# ramp FILE FROM TO: a PFM of 160 x 120 whose values rise evenly from left to right
ramp()
{
    printf 'Pf\n160 120\n-1\n' >"$1"
    perl -e 'my ($a, $b) = @ARGV; my $row = pack("f<*", map { $a + ($b - $a) * $_ / 159 } 0 .. 159); print $row x 120;' "$2" "$3" >>"$1"
}

a_photo_without_depth_is_refused()
{
    scene none; cp "$one" none/photos/
    ! m none depth || fail "one photo made depth"
    grep -qF "a parallax video needs at least 2, taken from different places, or one with its depth (DEPTH)." log || { cat log; fail "nothing says what to do"; }
}

disparity_of_a_folder_and_of_a_file()
{
    scene two; cp "$one" two/photos/me.jpg; mkdir two/depth; ramp two/depth/me.pfm 10 40; echo 'samples disparity' >two/depth/depth.txt
    m two DEPTH=two/depth depth || { cat log; fail "make depth"; }
    ! grep -q "starting points" log || fail "points are missed where none can be"
    grep -qF "an ordinary angle of view is taken, 60 degrees" log || { cat log; fail "nothing says which lens was taken"; }
    # a hundredth of 10 to 40 at either end: 39.4 / 10.6
    grep -qE "the nearest surfaces are taken to be at 1, the farthest at 3.7" out/two/log/segment_depth.me.log || { cat out/two/log/segment_depth.me.log; fail "nothing says which range was taken"; }
    cp out/two/depth/me.exr folder.exr; mv two/depth/me.pfm two/depth/other.pfm
    m two DEPTH=two/depth/other.pfm depth || { cat log; fail "make depth from a file"; }
    cmp folder.exr out/two/depth/me.exr || fail "a file gives other depth than its folder"
    rm two/depth/depth.txt; ramp two/depth/other.pfm 1 2
    m two DEPTH=two/depth/other.pfm depth || { cat log; fail "make depth from depths"; }
    grep -qE "the farthest at 1.9" out/two/log/segment_depth.me.log || fail "depth was taken for disparity"
}

a_portrait_makes_a_film()
{
    scene phone; cp "$root/tests/fuzz/corpus/photo/portrait-range.heic" phone/photos/me.heic
    m phone || { tail -n 30 log; fail "make"; }
    grep -qF "me.heic carries its depth" log || { cat log; fail "nothing says where the depth comes from"; }
    find out/phone/parallax -name video.mp4 -size +1k | matches video || fail "no film"
    cp "$one" phone/photos/other.jpg
    ! m phone depth 2>/dev/null || true
    [ ! -e out/phone/photo_depth ] || fail "the depth stays when the photo is not alone"
}

for t in a_photo_without_depth_is_refused disparity_of_a_folder_and_of_a_file a_portrait_makes_a_film; do run "$t"; done
