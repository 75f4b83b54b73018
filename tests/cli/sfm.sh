# sfm: the lens options passed to COLMAP, which is replaced by a script that records its arguments.
. tests/lib.sh
photos "$scratch/set" --views 3 --size 64x48 >/dev/null
cd "$scratch" || exit 1
mkdir fake
printf '#!/bin/sh\necho "$@" >>args\nexit 1\n' >fake/colmap
chmod +x fake/colmap
export PATH=$scratch/fake:$root/$B/bin:$PATH
import_photos --photos set/photos --out records 2>err || { cat err; fail "import"; }
for p in photo_1 photo_2 photo_3; do
    extract_features --photos set/photos --records records --photo $p --out features/$p.txt 2>err || { cat err; fail "features"; }
done
choose_pairs --records records --features features --out pairs.txt 2>err || { cat err; fail "pairs"; }
for p in photo_1 photo_2 photo_3; do
    match_photos --pairs pairs.txt --features features --photo $p --out matches/$p.txt 2>err || { cat err; fail "matches"; }
done
given=(--photos set/photos --records records --features features --matches matches)

# passes WORDS [SETTING...]: sfm passes WORDS to COLMAP, and fails because COLMAP does
passes()
{
    local words=$1 rc=0 settings=(); shift
    for s; do settings+=(--set "$s"); done
    rm -f args
    sfm "${given[@]}" --out out "${settings[@]}" 2>err || rc=$?
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
    sfm "${given[@]}" --out out --set camera_model=EQUISOLID 2>err || rc=$?
    [ "$rc" = 2 ] && [ ! -e args ] || { cat err; fail "exit $rc, wanted 2 before COLMAP runs"; }
    grep -qE 'EXIF of photo "photo_[12].jpg" does not state it for 35 mm film. Set camera_params = F in pixels: .* times 64,' err || { cat err; fail "no advice"; }
}

other_models_are_passed_unchanged()
{
    passes '--ImageReader.camera_model OPENCV --' camera_model=OPENCV
    ! grep -q camera_params args || { cat args; fail "initial parameters that were not given"; }
    passes '--ImageReader.camera_params 60,32,24' camera_model=SIMPLE_PINHOLE camera_params=60,32,24
}

without_matches_it_says_what_is_missing()
{
    rm -f args; rc=0
    sfm --photos set/photos --records records --out out 2>err || rc=$?
    [ "$rc" = 2 ] && [ ! -e args ] && grep -q -- '--features and --matches are required unless --model is given' err || { cat err; fail "exit $rc, wanted 2 and a reason"; }
}

a_missing_list_of_features_is_named()
{
    mv features/photo_2.txt keep
    sed -i 's/exit 1/exit 0/' fake/colmap
    rc=0
    sfm "${given[@]}" --out out 2>err || rc=$?
    mv keep features/photo_2.txt; sed -i 's/exit 0/exit 1/' fake/colmap
    [ "$rc" = 1 ] || { cat err; fail "exit $rc, wanted 1"; }
}

# Frames of one clip have one lens, which COLMAP gives to all photos of a call; it reads no PNG of 16 bits.
frames_of_a_clip_share_a_lens()
{
    local p; mkdir film
    for p in 1 2; do ffmpeg -v error -i set/photos/photo_$p.jpg -pix_fmt rgb48be film/walk_f00000$p.png; done
    cp set/photos/photo_3.jpg film/
    import_photos --photos film --out film-records --set brackets=no 2>err || { cat err; fail "import"; }
    for p in walk_f000001 walk_f000002 photo_3; do extract_features --photos film --records film-records --photo $p --out film-features/$p.txt 2>err || fail "features"; done
    choose_pairs --records film-records --features film-features --out film-pairs.txt 2>err || { cat err; fail "pairs"; }
    for p in walk_f000001 walk_f000002 photo_3; do match_photos --pairs film-pairs.txt --features film-features --photo $p --out film-matches/$p.txt 2>err || fail "matches"; done
    # shellcheck disable=SC2016 # expanded by the script
    printf '#!/bin/bash\n[ "$1" = feature_importer ] || exit 0\nwhile [ $# -gt 1 ]; do case $1 in --ImageReader.single*) echo "$1";; --image_path) images=$2;;
--image_list_path) while read -r n; do echo "$n $(od -An -tu1 -j24 -N1 "$images/$n")"; done <"$2";; esac; shift; done >>calls\n' >fake/colmap
    for p in auto no; do
        rm -f calls; sfm --photos film --records film-records --features film-features --matches film-matches --out out --set single_camera=$p 2>err || true
        sed -i 's/  */ /g; s/photo_3.jpg .*/photo_3.jpg/' calls; tr '\n' ' ' <calls >calls.$p
    done
    [ "$(cat calls.auto)" = "photo_3.jpg --ImageReader.single_camera_per_image walk_f000001.png 8 walk_f000002.png 8 --ImageReader.single_camera " ] || { cat calls.auto err; fail "calls"; }
    [ "$(cat calls.no)" = "photo_3.jpg walk_f000001.png 8 walk_f000002.png 8 --ImageReader.single_camera_per_image " ] || { cat calls.no err; fail "calls with a lens each"; }
}

for t in without_matches_it_says_what_is_missing a_missing_list_of_features_is_named equisolid_is_passed_as_opencv_fisheye equisolid_without_a_focal_length_is_rejected other_models_are_passed_unchanged \
    frames_of_a_clip_share_a_lens; do run $t; done
