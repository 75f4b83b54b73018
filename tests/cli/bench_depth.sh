# the programs of the depth bench: stereo pairs become scenes, and depth maps of a pair get a score
. tests/lib.sh

pair=$scratch/pair made=$scratch/made

# grey FILE.png PROGRAM: a picture of 32 x 8 pixels; awk's PROGRAM sets v, 1 to 127, from x and y
grey()
{
    awk "BEGIN { for (y = 0; y < 8; y++) for (x = 0; x < 32; x++) { $2; printf \"%c\", v } }" >"$scratch/raw"
    ffmpeg -loglevel error -y -f rawvideo -pixel_format gray -video_size 32x8 -i "$scratch/raw" "$1" || fail "ffmpeg wrote no $1"
}
# a wall at a disparity of 4, and a board in front at 8: rows 2..5, columns 14..19 of the left picture, 6..11 of the right one
boards()
{
    rm -rf "$pair" "$made"; mkdir -p "$pair"
    grey "$pair/im2.png" 'v = 40 + x'; grey "$pair/im6.png" 'v = 41 + x'
    grey "$pair/disp2.png" 'v = y > 1 && y < 6 && x > 13 && x < 20 ? 32 : 16'
    grey "$pair/disp6.png" 'v = y > 1 && y < 6 && x > 5 && x < 12 ? 32 : 16'
}
make_scene()
{
    "$B/tests/bench/stereo_pair" --pair "$pair" --out "$made" >"$scratch/out" 2>"$scratch/err" || { cat "$scratch/err"; return 1; }
    "$B/bin/import_photos" --photos "$made/photos" --out "$made/records" 2>"$scratch/err" || fail "the photos were not imported"
    mkdir "$made/sfm"; mv "$made/model" "$made/sfm/0"
    printf 'remodel-sfm 1\n0 colmap\n' >"$made/sfm/models.txt"
    for v in left right; do echo "$v $(awk '$1 == "hash" { print $2 }' "$made/records/$v.txt")"; done >"$made/sfm/photos.txt"
    "$B/bin/sfm_import" --sfm "$made/sfm" --records "$made/records" --out "$made/views" 2>"$scratch/err" || { cat "$scratch/err"; fail "the cameras were not imported"; }
}
score() { "$B/tests/bench/stereo_score" --truth "$made/truth" --views "$made/views" --depth "$1" 2>"$scratch/err" | tr '\n' ' '; }
wants() { [[ $1 == *$2* ]] || fail "found '$1', wanted '$2' in it"; }

a_pair_becomes_a_scene()
{
    boards; make_scene
    wants "$(tr '\n' ' ' <"$scratch/out")" "disparities 16 near 62.5 "
    cmp "$pair/im2.png" "$made/photos/left.png" || fail "the left photo is not the picture"
    wants "$(cat "$made/truth/images.txt")" "2 1 0 0 0 -1 0 0 1 right.png"
    [ "$(ls "$made/truth/depth")" = "left.exr
right.exr" ] || fail "wanted a truth for each side"
}

pixels_seen_by_both_are_scored()
{
    boards; make_scene
    # 28 columns of 8 rows are in both pictures; the board hides 4 columns of 4 rows from the right one
    wants "$(score "$made/truth/depth/left.exr")" "error 0.0000 unit % bad1 0.0000 bad05 0.0000 bad2_all 0.0000 known 100.0000 pixels 208 "
    # the truth of the right view is wrong on the board (24 pixels) and, where scored, at its place in the right picture (16)
    wants "$(score "$made/truth/depth/right.exr")" "error 19.2308 unit % bad1 19.2308 "
}

one_truth_suffices_to_find_hidden_pixels()
{
    boards; make_scene; cp "$made/truth/depth/right.exr" "$scratch/right.exr"; rm "$made/truth/depth/right.exr"
    wants "$(score "$made/truth/depth/left.exr")" "error 0.0000 unit % bad1 0.0000 bad05 0.0000 bad2_all 0.0000 known 100.0000 pixels 208 "
    wants "$(score "$scratch/right.exr")" "error 19.2308"
}

# write_npz TYPE: a wall at 4, with one unknown (infinite) pixel
write_npz()
{
    local header="{'descr': '$1', 'fortran_order': False, 'shape': (8, 32), }" i
    {
        printf '\223NUMPY\001\000'
        printf "\\$(printf %03o ${#header})\\000%s" "$header"
        for ((i = 0; i < 256; i++)); do if [ $i = 10 ]; then printf '\000\000\200\177'; else printf '\000\000\200\100'; fi; done
    } >"$scratch/npy"
    {
        printf 'PK\003\004\024\000\000\000\010\000'
        head -c 16 /dev/zero
        printf '\007\000\000\000arr.npy'
        gzip -nc "$scratch/npy" | tail -c +11
    } >"$pair/wall_disp.npz"
}
float_disparities_of_one_side_are_read()
{
    rm -rf "$pair" "$made"; mkdir -p "$pair"
    grey "$pair/wall_left.png" 'v = 40 + x'; grey "$pair/wall_right.png" 'v = 41 + x'
    write_npz '<f4'; make_scene
    [ "$(ls "$made/truth/depth")" = left.exr ] || fail "there is a truth of the right side"
    wants "$(score "$made/truth/depth/left.exr")" "known 100.0000 pixels 223 "
    write_npz '<f8'; rm -rf "$made"
    ! make_scene >"$scratch/out" || fail "an array of doubles was accepted"
    wants "$(cat "$scratch/err")" "wanted an archive whose first array is deflated and has 32 x 8 floats"
}

an_incomplete_pair_is_refused()
{
    boards; rm "$pair/disp2.png"
    ! make_scene >"$scratch/out" || fail "half a pair was accepted"
    wants "$(cat "$scratch/err")" "holds no rectified pair"
    boards; make_scene; rm -r "$made/views"
    ! "$B/tests/bench/stereo_score" --truth "$made/truth" --views "$made/views" --depth "$made/truth/depth/left.exr" 2>"$scratch/err" || fail "a score was given without views"
    wants "$(cat "$scratch/err")" "cameras.txt"
}

# both pairs have the same pictures and disparities, in the layouts of cones and teddy
settings_are_chosen_on_the_other_pairs()
{
    boards
    mkdir "$scratch/pairs"
    cp -r "$pair" "$scratch/pairs/cones"; cp -r "$pair" "$scratch/pairs/teddy"
    REPEATS=1 BENCH_OUT=$scratch/tables BENCH_PAIRS=$scratch/pairs BENCH_SCENES='' BENCH_SWEEPS=candidates BENCH_CANDIDATES='smoothness=2 passes=1,rounds=0' \
        tests/bench/run depth "$B" >"$scratch/out" 2>"$scratch/err" || { cat "$scratch/err"; fail "the bench failed"; }
    wants "$(grep -v '^#' "$scratch/tables/depth.tsv" | cut -f 3,4 | tr '\t\n' '  ')" "sweep value candidates default candidates smoothness=2 candidates passes=1,rounds=0 "
    wants "$(grep -v '^#' "$scratch/tables/depth_left_out.tsv" | cut -f 1 | tr '\n' ' ')" "scene teddy cones mean "
    # the pairs are equal, so what is best on one is what the other gets
    awk -F'\t' '/^#/ || $1 == "scene" { next } $3 != $5 || ($1 != "mean" && $7 != $8) { exit 1 }' "$scratch/tables/depth_left_out.tsv" || { cat "$scratch/tables/depth_left_out.tsv"; fail "equal pairs have other settings"; }
}

missing_inputs_of_the_bench_are_named()
{
    rc=0; BENCH_PAIRS="$scratch/none" BENCH_SCENES='' tests/bench/run depth "$B" 2>"$scratch/err" || rc=$?
    [ "$rc" = 3 ] || fail "exit $rc, wanted 3"
    wants "$(cat "$scratch/err")" "BENCH_PAIRS=DIR"; wants "$(cat "$scratch/err")" "neither pairs nor scenes"
}

for t in a_pair_becomes_a_scene pixels_seen_by_both_are_scored one_truth_suffices_to_find_hidden_pixels float_disparities_of_one_side_are_read \
    an_incomplete_pair_is_refused settings_are_chosen_on_the_other_pairs missing_inputs_of_the_bench_are_named; do run "$t"; done
