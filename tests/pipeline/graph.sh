# what the graph makes, keeps and makes again; on a synthetic scene with known poses
. tests/lib.sh
project graph
photos set >/dev/null
small t

run_scene() { make -s DEPS=manual SCENE=t "$@" 2>&1; }

chain_from_photos_to_video()
{
    make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=t >first.log 2>&1 || { cat first.log; fail "make failed"; }
    [ -s out/t/parallax/establishing_dolly/video.mp4 ] || fail "no video"
    [ -s out/t/index.html ] || fail "no page"
    grep -qE '100\.0 % known, [0-9.]+ % inherited' out/t/index.html || fail "the page does not tell what depth is inherited"
    grep -q 'Inherited depth.*most in photo_[0-9] (' out/t/index.html || fail "the page does not name the views with most of it"
    tail -n 2 first.log | matches 'video  out/t/parallax/establishing_dolly/video.mp4' || fail "the run does not end with the video's path"
    n=$(ffprobe -v error -count_frames -select_streams v -show_entries stream=nb_read_frames,pix_fmt,codec_name,width,height -of csv=p=0 out/t/parallax/establishing_dolly/video.mp4)
    [ "$n" = "h264,160,120,yuv420p,6" ] || fail "the video is $n, wanted h264,160,120,yuv420p,6"
}

second_make_does_nothing()
{
    snapshot out/t >a
    run_scene >log
    snapshot out/t >b
    diff a b || fail "a second make made something again"
    run_scene why | matches 'Nothing is stale' || fail "make why sees something stale"
    [ -z "$(run_scene -n report | grep run_stage)" ] || fail "make -n wants to run something"
}

comment_in_a_config_rebuilds_nothing()
{
    snapshot out/t >a
    echo '# a comment' >>scenes/t/scene.cfg
    run_scene >log
    snapshot out/t >b
    diff a b || fail "a comment made something again"
}

a_parameter_redoes_its_stage_and_what_follows()
{
    snapshot out/t >a
    printf '[encode_video]\ncrf = 30\n' >>scenes/t/scene.cfg
    run_scene why >why
    grep -q 'video.mp4: .*encode_video.cfg' why || { cat why; fail "make why does not name the slice"; }
    grep -q 'crf = 30' why || { cat why; fail "make why does not tell the new value"; }
    run_scene >log
    snapshot out/t >b
    [ "$(changed a b)" = "index.html
parallax/establishing_dolly/video.mp4" ] || { changed a b; fail "wrong products were made again"; }
}

a_deleted_product_is_made_again_with_what_follows()
{
    for p in parallax/establishing_dolly/frames/0003.exr views/photo_2.exr depth/photo_3.exr depth/photo_3.txt views/images.txt parallax/establishing_dolly/path.txt index.html; do
        (cd out/t && find views depth parallax -type f ! -name '.*' | sort | xargs -d '\n' sha256sum) >before
        snapshot out/t >a
        rm "out/t/$p"
        run_scene >log || { cat log; fail "make after deleting $p"; }
        [ -e "out/t/$p" ] || fail "$p was not made again"
        snapshot out/t >b
        case $p in
        *0003.exr) want="index.html parallax/establishing_dolly/frames/0003.exr parallax/establishing_dolly/video.mp4" ;;
        index.html) want="index.html" ;;
        *) want= ;;
        esac
        [ -z "$want" ] || [ "$(changed a b | tr '\n' ' ')" = "$want " ] || { changed a b; fail "after $p was deleted, wrong products were made again"; }
        (cd out/t && find views depth parallax -type f ! -name '.*' | sort | xargs -d '\n' sha256sum) >after
        diff before after || fail "after $p was deleted, other bytes came out"
    done
}

depth_is_told_before_it_is_made()
{
    rm out/t/depth/photo_3.exr
    run_scene CORES=1 depth >log || { cat log; fail "make depth"; }
    sed -n '/^depth: /,$p' log | sed -n 1,2p >told
    { read -r first; read -r second; } <told
    [[ $first =~ ^depth:\ 1\ view\ of\ 160\ x\ 120,\ [0-9]\ neighbours,\ 1\ round:\ about\ [0-9]+\ s\ on\ 1\ core,\ [0-9]+\ MiB\ at\ a\ time$ ]] || { cat log; fail "told '$first'"; }
    [[ $second == 'segment_depth 1/1 photo_3'* ]] || { cat log; fail "'$second' follows what is told"; }
    run_scene depth >log || { cat log; fail "make depth again"; }
    ! grep '^depth: ' log || fail "something is told where there is nothing to do"
    rm -r out/t/depth/round0/photo_*.exr
    run_scene depth >log || { cat log; fail "make depth after deleting a round"; }
    grep -qE '^depth: 6 views of 160 x 120, .*, 2 rounds: about ' log || { cat log; fail "of two rounds not both are told"; }
    run_scene >log || { cat log; fail "make"; }
}

points_are_made_when_they_are_asked_for()
{
    [ ! -e out/t/points ] || fail "points were made though nobody asked"
    run_scene points >log || { cat log; fail "make points"; }
    head -n 3 out/t/points/points.ply | matches -ax 'comment remodel-points 1' || fail "these are no points"
    ! grep -aqF "$PWD" out/t/points/points.ply || fail "the points name a folder of this machine"
    n=$(grep -am 1 '^element vertex' out/t/points/points.ply | cut -d' ' -f3)
    [ "$n" -gt 1200 ] || fail "only $n points"
    sha256sum out/t/points/points.ply >before
    stat -c %y out/t/points/points.ply >a
    run_scene points >log
    stat -c %y out/t/points/points.ply | diff a - || fail "a second make points made them again"
    rm out/t/depth/photo_3.exr
    run_scene points CORES=1 >log || { cat log; fail "make points after a depth map was deleted"; }
    sha256sum out/t/points/points.ply | diff before - || fail "other points came out"
    ! stat -c %y out/t/points/points.ply | diff -q a - >/dev/null || fail "a new depth map did not make the points again"
    printf '[fuse_points]\ngrid = 0.02\n' >>scenes/t/scene.cfg
    snapshot out/t >a
    run_scene points >log
    snapshot out/t >b
    diff a b || fail "a parameter of fuse_points made something else again"
    [ "$(grep -am 1 '^element vertex' out/t/points/points.ply | cut -d' ' -f3)" -lt $((n / 2)) ] || fail "the points do not follow the grid"
    run_scene >log # what follows depth, for the tests that come
}

# only_photo_5_and_its_readers: of views and depth the file c (changed A B) lists photo_5's and what reads it
only_photo_5_and_its_readers()
{
    local d v
    grep -q '^views/photo_5.exr' c || fail "the changed view was not made again"
    ! grep -qE '^(sfm/|views/(cameras|images|points3D)|views/photo_[12346]\.)' c || { cat c; fail "too much was made again"; }
    for d in out/t/depth/photo_?.d; do
        v=$(basename "$d" .d)
        if reads "$d" photo_5; then grep -q "^depth/$v.exr" c || fail "$v reads the changed view, but was not made again"
        else ! grep -q "^depth/$v.exr" c || fail "$v does not read the changed view, but was made again"; fi
    done
}

a_changed_photo_redoes_its_view_and_its_readers()
{
    snapshot out/t >a
    photos set --change 5 >/dev/null
    run_scene >log
    snapshot out/t >b
    changed a b >c
    only_photo_5_and_its_readers
    photos set >/dev/null
    run_scene >log
}

a_mask_redoes_its_view_and_its_readers()
{
    (cd out/t && find views depth -type f ! -name '.*' ! -name '*.d' | sort | xargs -d '\n' sha256sum) >before
    mkdir -p scenes/t/masks
    for at in "50 40" "15 10" none; do
        snapshot out/t >a
        if [ "$at" = none ]; then rm scenes/t/masks/photo_5.png; else painted scenes/t/masks/photo_5.png $at; fi
        run_scene why >why
        grep -q 'views/photo_5.exr: .*mask/photo_5.txt is newer' why || fail "make why does not name the mask"
        run_scene depth >log || { cat log; fail "make with the mask at $at"; }
        snapshot out/t >b
        changed a b >c
        only_photo_5_and_its_readers
        [ "$at" != none ] || continue
        set -- $at
        for p in "$1 $2" "$(($1 + 29)) $(($2 + 24))"; do
            [ "$(alpha out/t/views/photo_5.exr $p)" = 00000000 ] || fail "the view has a pixel at $p"
            [ "$(alpha out/t/depth/photo_5.exr $p interior)$(alpha out/t/depth/photo_5.exr $p boundary)" = 0000000000000000 ] || fail "there is depth at $p"
        done
        for p in "$(($1 - 1)) $2" "$1 $(($2 + 25))"; do
            [ "$(alpha out/t/views/photo_5.exr $p)" = 0000803f ] || fail "the view lacks the pixel $p, beside the mask"
        done
        snapshot out/t >a
        run_scene depth >log
        snapshot out/t >b
        diff a b || fail "a second make made something again"
    done
    (cd out/t && find views depth -type f ! -name '.*' ! -name '*.d' | sort | xargs -d '\n' sha256sum) | diff before - || fail "without the mask other bytes come out than before"
    painted scenes/t/masks/photo_9.png 0 0
    run_scene depth >log 2>&1 || { cat log; fail "make with a mask of no photo"; }
    grep -q 'masks/photo_9.png masks nothing' log || fail "a mask of no photo went unnoticed"
    rm scenes/t/masks/photo_9.png
    ffmpeg -v error -f lavfi -i color=white:s=32x24 -frames:v 1 scenes/t/masks/photo_2.png
    if run_scene depth >log 2>&1; then fail "a mask of another size was taken"; fi
    grep -q 'masks/photo_2.png has 32 x 24 pixels, but the photo "photo_2.jpg" that it masks has 160 x 120' log || { cat log; fail "no sentence"; }
    rm -r scenes/t/masks
    run_scene >log || { cat log; fail "make without masks"; }
}

# the planes in the depth map of photo_5
planes_5() { awk '/^segments/ { go = 1; next } go { print $3, $4, $5 }' out/t/depth/photo_5.txt; }

given_depth_is_honoured_and_redoes_its_view_and_its_readers()
{
    (cd out/t && find depth -type f ! -name '.*' ! -name '*.d' | sort | xargs -d '\n' sha256sum) >before
    mkdir -p given
    for what in one two other none; do
        snapshot out/t >a
        case $what in
        one) cp set/truth/photo_5.exr given ;;
        two) echo 'scale 2' >given/depth.txt ;;
        other) mv given/photo_5.exr given/photo_6.exr ;;
        none) rm given/photo_6.exr ;;
        esac
        run_scene DEPTH=given depth >log || { cat log; fail "make with $what"; }
        snapshot out/t >b
        changed a b >c
        [ $what != none ] || { (cd out/t && find depth -type f ! -name '.*' ! -name '*.d' | sort | xargs -d '\n' sha256sum) | diff before - || fail "without given depth other bytes come out than before"; continue; }
        ! grep -qE '^(sfm|views)/' c || { cat c; fail "too much was made again"; }
        gave=photo_5; [ $what != other ] || gave='photo_[56]'
        grep -q "gives the depth of 1 of 6 views" log || { cat log; fail "it is not said how many views have depth"; }
        grep -q "depth is given for 19200 of 19200 pixels" out/t/log/segment_depth.photo_$([ $what = other ] && echo 6 || echo 5).log || fail "it is not said how many pixels are given"
        ! grep -E '^depth/round0/.*exr' c | matches -v "round0/$gave.exr" || { cat c; fail "views whose depth is not given were made again in the first round"; }
        for d in out/t/depth/photo_?.d; do
            v=$(basename "$d" .d)
            if [[ $v == "$gave" ]] || sed 1d "$d" | matches "/depth/round0/$gave.exr"; then grep -q "^depth/$v.exr" c || fail "$v looks at given depth, but was not made again"
            else ! grep -q "^depth/$v.exr" c || fail "$v does not look at given depth, but was made again"; fi
        done
        case $what in
        one) planes_5 >planes ;;
        two) planes_5 | paste - planes | awk '{ for (i = 1; i <= 3; i++) if ((d = 2 * $i - $(i + 3)) > 1e-6 || d < -1e-6) { bad++; break } } END { print bad+0, NR; exit bad > NR / 20 || NR < 100 }' || fail "depth that is twice as far has not half the inverse depths" ;;
        esac
        snapshot out/t >a
        run_scene DEPTH=given depth >log
        snapshot out/t >b
        diff a b || fail "a second make made something again"
    done
    ffmpeg -v error -f lavfi -i color=gray:s=160x120 -frames:v 1 -pix_fmt gray16be given/photo_3.png
    echo 'pixels view' >given/depth.txt
    if run_scene DEPTH=given depth >log 2>&1; then fail "a PNG without scale was taken"; fi
    grep -q 'given/photo_3.png holds whole numbers' log || { cat log; fail "no sentence about the scale"; }
    mv given/photo_3.png given/photo_33.png
    run_scene DEPTH=given depth >log 2>&1 || { cat log; fail "make"; }
    grep -q 'files that belong to no view: photo_33' log || { cat log; fail "a file of no view went unnoticed"; }
    if run_scene DEPTH=nowhere depth >log 2>&1; then fail "DEPTH=nowhere was taken"; fi
    grep -q 'DEPTH=nowhere is not a folder' log || { cat log; fail "no sentence about the folder"; }
    run_scene >log || { cat log; fail "make without DEPTH"; }
}

a_photo_that_goes_redoes_sfm()
{
    snapshot out/t >a
    run_scene EXCLUDE=photo_6.jpg >log 2>&1 || { cat log; fail "make EXCLUDE"; }
    grep -q photo_6 out/t/views/images.txt && fail "photo_6 is still a view"
    snapshot out/t >b
    changed a b | matches '^sfm/' || fail "SfM was not done again"
    run_scene >log 2>&1
    grep -q photo_6 out/t/views/images.txt || fail "photo_6 did not come back"
}

draft_stands_beside_and_shares_sfm()
{
    snapshot out/t >a
    run_scene QUALITY=draft video >log 2>&1 || { cat log; fail "draft"; }
    snapshot out/t >b
    diff a b || fail "the draft run touched the default one"
    [ -s out/t+draft/parallax/establishing_dolly/video.mp4 ] || fail "no draft video"
    [ ! -e out/t+draft/sfm ] || fail "the draft run made its own SfM"
}

a_second_run_is_refused()
{
    exec 8>out/t/.lock; flock 8
    if run_scene >log 2>&1 8>&-; then fail "the second run went on"; fi
    grep -q 'Another run works on scene t' log || { cat log; fail "no sentence"; }
    exec 8>&-
}

a_failed_stage_keeps_the_old_product_and_says_why()
{
    cp scenes/t/scene.cfg keep.cfg
    before=$(sha256sum out/t/depth/photo_2.exr)
    printf '[segment_depth]\nplanes = none\n' >>scenes/t/scene.cfg
    if run_scene >log 2>&1; then fail "a wrong value was taken"; fi
    grep -q 'scene.cfg' log || { cat log; fail "the sentence does not name the file"; }
    cp keep.cfg scenes/t/scene.cfg
    printf '[segmentdepth]\n' >>scenes/t/scene.cfg
    if run_scene >log 2>&1; then fail "an unknown section was taken"; fi
    grep -q 'scene.cfg:.*segmentdepth' log || { cat log; fail "the sentence does not name the section"; }
    cp keep.cfg scenes/t/scene.cfg
    [ "$before" = "$(sha256sum out/t/depth/photo_2.exr)" ] || fail "the good product was lost"
    run_scene >log 2>&1 || { cat log; fail "make after the mend"; }
}

threads_splits_and_resumes_give_the_same_bytes()
{
    products t >want
    rm -rf out/t/views out/t/depth out/t/parallax
    run_scene CORES=1 FRAMES_PER_JOB=2 >log 2>&1 || { cat log; fail "one core"; }
    products t | diff want - || fail "one core gives other bytes"
    rm -rf out/t/views out/t/depth out/t/parallax
    # ended three times on the way, by the hardest signal, then resumed
    for wait in 0.7 1.2 1.7; do
        setsid make -s DEPS=manual SCENE=t >log 2>&1 &
        p=$!
        sleep "$wait"
        kill -9 -- "-$p" 2>/dev/null || true
        wait "$p" 2>/dev/null || true
    done
    run_scene CORES=3 >log 2>&1 || { cat log; fail "resumed run"; }
    products t | diff want - || fail "a resumed run gives other bytes"
}

jobs_times_threads_never_exceed_the_cores()
{
    rm -rf out/t/depth
    make DEPS=manual SCENE=t -j8 CORES=2 V=1 depth >log 2>&1 || { cat log; fail "make -j8"; }
    [ "$(grep -c 'bin/segment_depth --threads 1 ' log)" -ge 1 ] || { cat log; fail "two jobs of one thread were expected"; }
    ! grep -q 'threads 2' log || fail "two jobs of two threads on two cores"
}

several_goals_follow_each_other()
{
    rm -rf out/t/points out/t/depth/photo_1.exr
    make -s DEPS=manual SCENE=t -j2 depth points >log 2>&1 || { cat log; fail "make -j2 depth points"; }
    [ -s out/t/points/points.ply ] || fail "no points"
}

run chain_from_photos_to_video
run second_make_does_nothing
run comment_in_a_config_rebuilds_nothing
run a_parameter_redoes_its_stage_and_what_follows
run a_deleted_product_is_made_again_with_what_follows
run depth_is_told_before_it_is_made
run points_are_made_when_they_are_asked_for
run a_changed_photo_redoes_its_view_and_its_readers
run a_mask_redoes_its_view_and_its_readers
run given_depth_is_honoured_and_redoes_its_view_and_its_readers
run a_photo_that_goes_redoes_sfm
run draft_stands_beside_and_shares_sfm
run a_second_run_is_refused
run several_goals_follow_each_other
run a_failed_stage_keeps_the_old_product_and_says_why
run threads_splits_and_resumes_give_the_same_bytes
run jobs_times_threads_never_exceed_the_cores
