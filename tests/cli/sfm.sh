# sfm: the lens options passed to COLMAP, which is replaced by a script that records its arguments.
. tests/lib.sh
photos "$scratch/set" --views 3 --size 64x48 >/dev/null
cd "$scratch" || exit 1
mkdir fake
printf '#!/bin/sh\necho "$@" >>args\nexit 1\n' >fake/colmap
chmod +x fake/colmap
export PATH=$scratch/fake:$root/$B/bin:$PATH
import_photos --photos set/photos --out records 2>err || { cat err; fail "import"; }

# passes WORDS [SETTING...]: sfm passes WORDS to COLMAP, and fails because COLMAP does
passes()
{
    local words=$1 rc=0 settings=(); shift
    for s; do settings+=(--set "$s"); done
    rm -f args
    sfm --photos set/photos --records records --out out "${settings[@]}" 2>err || rc=$?
    [ "$rc" = 1 ] || { cat err; fail "exit $rc, wanted 1"; }
    grep -qF -- "$words" args || { cat args err; fail "COLMAP did not get '$words'"; }
}

equisolid_is_passed_as_opencv_fisheye()
{
    passes '--ImageReader.camera_model OPENCV_FISHEYE' camera_model=EQUISOLID camera_params=28.5
    grep -qF -- '--ImageReader.camera_params 28.5,28.5,32,24,-0.0416666666667,0.000520833333333,-3.10019841' args || { cat args; fail "other parameters"; }
    passes '--ImageReader.camera_params 28.5,28.5,31,25.5,-0.04' camera_model=EQUISOLID camera_params=28.5,31,25.5
}

equisolid_without_a_focal_length_is_rejected()
{
    sed -i 's/^exif [^ ]* [^ ]*/exif 16 0/' records/photo_2.txt
    rm -f args; rc=0
    sfm --photos set/photos --records records --out out --set camera_model=EQUISOLID 2>err || rc=$?
    [ "$rc" = 2 ] && [ ! -e args ] || { cat err; fail "exit $rc, wanted 2 before COLMAP runs"; }
    grep -qE 'EXIF of photo "photo_[12].jpg" does not state it for 35 mm film. Set camera_params = F in pixels: .* times 64,' err || { cat err; fail "no advice"; }
}

other_models_are_passed_unchanged()
{
    passes '--ImageReader.camera_model OPENCV --' camera_model=OPENCV
    ! grep -q camera_params args || { cat args; fail "initial parameters that were not given"; }
    passes '--ImageReader.camera_params 60,32,24' camera_model=SIMPLE_PINHOLE camera_params=60,32,24
}

for t in equisolid_is_passed_as_opencv_fisheye equisolid_without_a_focal_length_is_rejected other_models_are_passed_unchanged; do run $t; done
