# sfm: what COLMAP is told about the lens; a script of its name stands in for it.
. tests/lib.sh
photos "$scratch/set" --views 3 --size 64x48 >/dev/null
cd "$scratch" || exit 1
mkdir fake
printf '#!/bin/sh\necho "$@" >>told\nexit 1\n' >fake/colmap
chmod +x fake/colmap
export PATH=$scratch/fake:$root/$B/bin:$PATH
import_photos --photos set/photos --out records 2>err || { cat err; fail "import"; }

# told WORDS [SETTING...]: sfm fails, for COLMAP does; it has told it WORDS
told()
{
    local words=$1 rc=0 args=(); shift
    for s; do args+=(--set "$s"); done
    rm -f told
    sfm --photos set/photos --records records --out out "${args[@]}" 2>err || rc=$?
    [ "$rc" = 1 ] || { cat err; fail "exit $rc, wanted 1"; }
    grep -qF -- "$words" told || { cat told err; fail "COLMAP is not told '$words'"; }
}

an_equisolid_lens_is_opencv_fisheye_to_colmap()
{
    told '--ImageReader.camera_model OPENCV_FISHEYE' camera_model=EQUISOLID camera_params=28.5
    grep -qF -- '--ImageReader.camera_params 28.5,28.5,32,24,-0.0416666666667,0.000520833333333,-3.10019841' told || { cat told; fail "another start"; }
    told '--ImageReader.camera_params 28.5,28.5,31,25.5,-0.04' camera_model=EQUISOLID camera_params=28.5,31,25.5
}

a_focal_length_that_nobody_states_is_asked_for()
{
    sed -i 's/^exif [^ ]* [^ ]*/exif 16 0/' records/photo_2.txt
    rm -f told; rc=0
    sfm --photos set/photos --records records --out out --set camera_model=EQUISOLID 2>err || rc=$?
    [ "$rc" = 2 ] && [ ! -e told ] || { cat err; fail "exit $rc, wanted 2 before COLMAP runs"; }
    grep -qE 'EXIF of photo "photo_[12].jpg" does not state it for 35 mm film. Set camera_params = F in pixels: .* times 64,' err || { cat err; fail "no advice"; }
}

other_models_are_told_as_they_are()
{
    told '--ImageReader.camera_model OPENCV --' camera_model=OPENCV
    ! grep -q camera_params told || { cat told; fail "a start that nobody gave"; }
    told '--ImageReader.camera_params 60,32,24' camera_model=SIMPLE_PINHOLE camera_params=60,32,24
}

for t in an_equisolid_lens_is_opencv_fisheye_to_colmap a_focal_length_that_nobody_states_is_asked_for other_models_are_told_as_they_are; do run $t; done
