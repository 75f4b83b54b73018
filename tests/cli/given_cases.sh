# models that other programs exported, for developers who have ../shared/data/cases and ../shared/data/kermit: each must place the
# photos and give them points, or say by name what is wrong
. tests/lib.sh
cases=$root/../shared/data/cases photos=$root/../shared/data/kermit/photos
export PATH=$root/$B/bin:$PATH
cd "$scratch" || exit 1

# prepared: the records, features and matches of the photos, made once
prepared()
{
    [ -d "$cases" ] && [ -d "$photos" ] || skip "$cases and $photos do not both exist"
    [ ! -e prepared ] || return 0
    import_photos --photos "$photos" --out records
    for f in "$photos"/*.jpg; do extract_features --photos "$photos" --records records --photo "$(basename "$f" .jpg)" --out "features/$(basename "$f" .jpg).txt"; done
    choose_pairs --records records --features features --out pairs.txt
    for f in "$photos"/*.jpg; do match_photos --pairs pairs.txt --features features --photo "$(basename "$f" .jpg)" --out "matches/$(basename "$f" .jpg).txt"; done
    touch prepared
}
# imported MODEL: SfM of a case, messages in err
imported() { sfm --photos "$photos" --records records --features features --matches matches --model "$cases/$1" --out sfm 2>err; }
# gives MODEL JUDGED POINTS: all photos are placed, with so many points at least
gives()
{
    prepared
    [ "$(sfm --records records --model "$cases/$1" --judge 2>/dev/null)" = "$2" ] || fail "$1 is not judged as $2"
    imported "$1" || { cat err; fail "sfm failed"; }
    sfm_import --sfm sfm --records records --out views 2>err || { cat err; fail "sfm_import failed"; }
    grep -q '11 of 11 photos are placed' err || { cat err; fail "not all photos are placed"; }
    local points; points=$(grep -vc '^#' views/points3D.txt)
    [ "$points" -ge "$3" ] || { cat err; fail "$points points, wanted $3"; }
}

text_without_points_is_triangulated() { gives colmap-no-blank-lines/model few 600; }
binary_without_points_is_triangulated() { gives colmap-binary-without-points/model few 600; }
bundler_without_points_is_triangulated() { gives bundler-without-points/model few 600; }
points_without_tracks_are_found_anew() { gives points-without-tracks/model few 600; }
points_with_tracks_of_one_are_found_anew() { gives points-tracks-of-one/model few 600; }
lists_with_windows_paths_are_read() { gives realitycapture-bundler/lst enough 760; }
lists_with_blanks_are_read() { gives realitycapture-bundler/spaces enough 760; }
lists_with_quotes_are_read() { gives realitycapture-bundler/quotes enough 760; }
good_points_are_kept() { gives given-disparity/model enough 760; }
an_unknown_lens_is_named()
{
    prepared
    ! imported colmap-binary-without-points/newlens || fail "it was accepted"
    grep -q 'newlens/cameras.bin: camera 1 has COLMAP.s lens model number 11, RAD_TAN_THIN_PRISM_FISHEYE' err || { cat err; fail "the lens is not named"; }
}
# poses in the axes of OpenGL, and from camera to world, without points: each gives some points by chance
poses_of_other_conventions_are_named()
{
    prepared
    mkdir turned
    cp "$cases/given-disparity/model/cameras.txt" turned
    : >turned/points3D.txt
    local way
    for way in "y up and z backward" "camera's centre in place of the translation"; do
        awk -v way="$way" '
            /^#/ || NF != 10 || $10 !~ /jpg/ { next }
            way ~ /^y/ { print $1, -$3, $2, -$5, $4, $6, -$7, -$8, $9, $10; print ""; next }
            { # C = -R^T t, by the conjugate quaternion
              w = $2; x = -$3; y = -$4; z = -$5; a = -$6; b = -$7; c = -$8
              u = 2 * (y * c - z * b); v = 2 * (z * a - x * c); s = 2 * (x * b - y * a)
              print $1, $2, $3, $4, $5, a + w * u + y * s - z * v, b + w * v + z * u - x * s, c + w * s + x * v - y * u, $9, $10; print "" }
            ' "$cases/given-disparity/model/images.txt" >turned/images.txt
        ! sfm --photos "$photos" --records records --features features --matches matches --model turned --out sfm 2>err || fail "$way: it was accepted"
        grep -q 'the given cameras contradict their photos: of [0-9]* matches between photos, [0-9] % are where the cameras see them, but 9[0-9] % would be' err || { cat err; fail "$way: it is not said"; }
        says "$way"
    done
}

# depth FOLDER [DEPTH.TXT]: depth of kermit003 with the case's depth, messages in err
depth()
{
    prepared
    if [ ! -e views-of-photos ]; then
        imported given-disparity/model && sfm_import --sfm sfm --records records --out views
        for f in "$photos"/*.jpg; do rectify --photo "$(basename "$f" .jpg)" --photos "$photos" --records records --views views --out views; done
        touch views-of-photos
    fi
    rm -rf given; mkdir given; cp "$cases/$1"/* given; chmod u+w given/*
    [ -z "${2-}" ] || printf '%s' "$2" >given/depth.txt
    segment_depth --views views --view kermit003 --given given --out depth/kermit003.exr --set planes=32 --set passes=1 2>err
}
says() { grep -qF -- "$1" err || { cat err; fail "nothing says '$1'"; }; }

disparity_is_recognised_and_named()
{
    depth given-disparity/depth || { cat err; fail "it failed"; }
    says "falls where that of its sparse points rises (rank correlation -"
    says 'Write the line "samples disparity" into given/depth.txt'
    ! grep -q 'depth is given for' err || fail "depth that is inside out is used"
}
# said to be disparity, it is used; the depth of most points is then right
disparity_that_is_said_is_used()
{
    depth given-disparity/depth "samples disparity" || { cat err; fail "it failed"; }
    says 'depth is given for'
    ! grep -q 'warning' err || { cat err; fail "a warning"; }
}
formats_of_depth_are_read()
{
    local f
    for f in KERMIT003.EXR kermit003.pfm kermit003.tif; do
        depth given-depth-formats/depth || { cat err; fail "it failed"; }
        find given -type f ! -name "$f" -delete
        segment_depth --views views --view kermit003 --given given --out depth/kermit003.exr --set planes=32 --set passes=1 2>err || { cat err; fail "$f"; }
        says 'depth is given for'
        ! grep -q warning err || { cat err; fail "$f: a warning"; }
        sed '/^#/d' depth/kermit003.txt >"planes-$f"
    done
    cmp planes-kermit003.pfm planes-kermit003.tif && cmp planes-KERMIT003.EXR planes-kermit003.pfm || fail "the formats differ"
}
sentinels_are_unknown()
{
    depth given-depth-formats/sentinel || { cat err; fail "it failed"; }
    says 'pixels have the value 1e+10, far from all others, which is taken as unknown'
    ! grep -q warning err || { cat err; fail "a warning"; }
}

for t in text_without_points_is_triangulated binary_without_points_is_triangulated bundler_without_points_is_triangulated \
    points_without_tracks_are_found_anew points_with_tracks_of_one_are_found_anew lists_with_windows_paths_are_read lists_with_blanks_are_read \
    lists_with_quotes_are_read good_points_are_kept an_unknown_lens_is_named poses_of_other_conventions_are_named \
    disparity_is_recognised_and_named disparity_that_is_said_is_used formats_of_depth_are_read sentinels_are_unknown; do run "$t"; done
