# held-out views and measured errors; on a synthetic scene with known poses and depths
. tests/lib.sh
project evaluation
photos set >/dev/null
small t

# the truth in its documented layout, and a model of half its size, so that scene units are not metres
mkdir -p truth/depth half
cp set/model/cameras.txt set/model/images.txt truth/
for z in set/truth/*.exr; do cp "$z" truth/depth/; done
cp set/model/cameras.txt half/
awk '/^#/ { print; next } NF == 10 && $10 ~ /jpg$/ { for (i = 6; i <= 8; i++) $i = sprintf("%.17g", $i / 2) } { print }' set/model/images.txt >half/images.txt
awk '/^#/ { print; next } { for (i = 2; i <= 4; i++) $i = sprintf("%.17g", $i / 2) } { print }' set/model/points3D.txt >half/points3D.txt

run_scene() { make -s DEPS=manual SCENE=t "$@" 2>&1; }
all_products() { find "$1"/ -type f ! -path '*/log/*' ! -path '*/slice/*' ! -path '*/stamp/*' ! -name '.*' -printf '%P %T@\n' | LC_ALL=C sort; }
# value METRIC [FOLDER]
value() { awk -F'\t' -v m="$1" '$1 == m { print $2; found = 1 } END { exit !found }' "out/${2:-t+holdout3}/metrics.tsv" || echo missing; }
# within METRIC MIN MAX [FOLDER]
within()
{
    local v; v=$(value "$1" "${4:-}")
    awk -v v="$v" -v a="$2" -v b="$3" 'BEGIN { exit !(v != "missing" && v + 0 >= a && v + 0 <= b) }' || fail "$1 is $v, wanted $2 to $3"
}

a_holdout_run_is_measured()
{
    make -s DEPS=manual PHOTOS=set/photos SFM=half SCENE=t TRUTH=truth HOLDOUT=3 evaluate >log 2>&1 || { cat log; fail "make evaluate"; }
    grep -q '^TRUTH := truth' scenes/t/scene.mk || fail "scene.mk does not name the truth"
    grep -qE 'holdout.psnr +[0-9]' log || { cat log; fail "the run does not show what it measured"; }
    [ ! -e out/t/depth ] && [ ! -e out/t+holdout3/sfm ] || fail "the hold-out run is not beside the scene"
    [ "$(cat out/t+holdout3/holdout/views/views.mk)" = "VIEWS := photo_1 photo_4" ] || fail "wrong views are held out"
    [ "$(cat out/t+holdout3/views/views.mk)" = "VIEWS := photo_2 photo_3 photo_5 photo_6" ] || fail "wrong views are kept"
    [ "$(cd out/t+holdout3/depth && echo *.exr)" = "photo_2.exr photo_3.exr photo_5.exr photo_6.exr" ] || fail "a held-out view has a depth map"
    ! grep -lE 'photo_[14]' out/t+holdout3/depth/*.d || fail "a depth map reads a held-out view"
    grep -aq 'sfm_import' out/t+holdout3/holdout/views/points3D.txt || fail "the held-out views have no points"
}

errors_of_an_exact_scene_are_small()
{
    within camera.scale 1.999999 2.000001
    within camera.center_max 0 1e-6
    within camera.rotation_max 0 1e-4
    within camera.placed 100 100
    within depth.known 99 100
    within depth.error50 0 5
    within depth.within2 40 100
    within depth.bad2 0 50
    within depth.occluded 0 20
    within depth.baseline 0.1 2
    within holdout.pictures 2 2
    within holdout.psnr_covered 18 99
    within holdout.ssim_covered 0.5 1
    within holdout.holes 0 30
    ! grep -viE '^#' out/t+holdout3/metrics.tsv | grep -iE 'nan|inf' || fail "a figure is not a number"
    grep -v '^#' out/t+holdout3/metrics.tsv | cut -f1 >names
    LC_ALL=C sort -c names || fail "the table is not sorted"
    grep -q '^# skipped irradiance' out/t+holdout3/metrics.tsv || fail "the table does not list what is skipped"
    [ "$(grep -c 'depth.occluded' out/t+holdout3/evaluate/views.tsv)" = 4 ] || fail "not every view is measured"
    [ "$(ls out/t+holdout3/evaluate/truth | wc -l)" = 4 ] || fail "not every view has its truth"
}

a_second_make_does_nothing()
{
    all_products out/t+holdout3 >a
    run_scene HOLDOUT=3 evaluate >log || { cat log; fail "make evaluate again"; }
    all_products out/t+holdout3 >b
    diff a b || fail "a second make remade something"
    [ -z "$(run_scene -n HOLDOUT=3 evaluate | grep run_stage)" ] || fail "make -n would run something"
}

a_changed_truth_only_repeats_the_measurement()
{
    all_products out/t+holdout3 >a
    rm truth/depth/photo_3.exr
    run_scene HOLDOUT=3 evaluate >log || { cat log; fail "make evaluate with less truth"; }
    all_products out/t+holdout3 >b
    [ -z "$(changed a b | grep -v -e metrics.tsv -e evaluate/)" ] || { changed a b; fail "too much was remade"; }
    [ "$(grep -c 'depth.occluded' out/t+holdout3/evaluate/views.tsv)" = 3 ] || fail "the view without truth is still measured"
    cp set/truth/photo_3.exr truth/depth/
}

a_lost_frame_is_rendered_and_measured_again()
{
    cp out/t+holdout3/metrics.tsv want
    rm out/t+holdout3/holdout/frames/photo_4.exr out/t+holdout3/holdout/views/photo_1.exr
    run_scene HOLDOUT=3 evaluate CORES=1 >log || { cat log; fail "make evaluate"; }
    [ -e out/t+holdout3/holdout/frames/photo_4.exr ] || fail "the frame was not remade"
    cmp want out/t+holdout3/metrics.tsv || fail "other figures came out"
}

the_page_shows_what_was_measured()
{
    run_scene HOLDOUT=3 >log || { cat log; fail "make"; }
    grep -q 'holdout.psnr_covered' out/t+holdout3/page/numbers.html || fail "the page has no table"
    [ "$(grep -o 'alt="Held-out photograph' out/t+holdout3/page/numbers.html | wc -l)" = 2 ] || fail "the held-out photos are not shown"
    [ "$(grep -o 'alt="True depth of view' out/t+holdout3/page/numbers.html | wc -l)" = 4 ] || fail "the truth is not shown"
    all_products out/t+holdout3 >a
    run_scene HOLDOUT=3 >log
    all_products out/t+holdout3 >b
    diff a b || fail "a second make remade something"
}

views_are_held_out_by_name_and_a_new_choice_is_noticed()
{
    run_scene HOLDOUT_VIEWS="photo_2 photo_5" views >log || { cat log; fail "hold-out by name"; }
    [ "$(cat out/t+holdout/holdout/views/views.mk)" = "VIEWS := photo_2 photo_5" ] || fail "wrong views are held out"
    run_scene HOLDOUT_VIEWS=photo_3 views >log || { cat log; fail "another name"; }
    [ "$(cat out/t+holdout/holdout/views/views.mk)" = "VIEWS := photo_3" ] || fail "the new choice was ignored"
    if run_scene HOLDOUT_VIEWS="photo_3 nobody" views >log; then fail "an unknown name was accepted"; fi
    grep -q 'no view or placed photo "nobody"' log || { cat log; fail "no message about the name"; }
    if run_scene HOLDOUT=1 views >log; then fail "all views were held out"; fi
    grep -q '0 of 6 placed photos would be kept' log || { cat log; fail "no message about too few views"; }
    if run_scene TRUTH=nowhere evaluate >log; then fail "a missing truth was accepted"; fi
    grep -q 'TRUTH=nowhere is not a folder' log || { cat log; fail "no message about the truth"; }
}

known_depth_is_measured_without_truth_and_holdout()
{
    run_scene TRUTH= evaluate >log || { cat log; fail "make evaluate"; }
    [ "$(grep -v '^#' out/t/metrics.tsv | cut -f1)" = depth.known ] || { cat out/t/metrics.tsv; fail "more or less than the known depth is measured"; }
    grep '^# skipped' out/t/metrics.tsv >log || true
    for w in 'camera and depth errors' PSNR irradiance 'texture errors' 'axes and heights' walls textures; do grep -q "^# skipped $w" log || { cat log; fail "the table does not list $w as skipped"; }; done
    [ "$(wc -l <log)" = 7 ] || { cat log; fail "more is skipped"; }
}

for t in a_holdout_run_is_measured errors_of_an_exact_scene_are_small a_second_make_does_nothing a_lost_frame_is_rendered_and_measured_again \
    a_changed_truth_only_repeats_the_measurement the_page_shows_what_was_measured views_are_held_out_by_name_and_a_new_choice_is_noticed \
    known_depth_is_measured_without_truth_and_holdout; do run "$t"; done
