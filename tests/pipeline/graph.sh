# which products the graph makes, keeps and remakes; on a synthetic scene with known poses
. tests/lib.sh
project graph
photos set >/dev/null
small t

run_scene() { make -s DEPS=manual SCENE=t "$@" 2>&1; }

chain_from_photos_to_video()
{
    make -s DEPS=manual status | matches '^No run has begun. make PHOTOS=DIR SCENE=NAME makes a scene.$' || fail "status without a scene"
    make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=t ON_DONE='echo "$REMODEL_SCENE $REMODEL_FOLDER $REMODEL_RESULT" >told; false' >first.log 2>&1 || { cat first.log; fail "make failed"; }
    [ -s out/t/parallax/establishing_dolly/video.mp4 ] || fail "no video"
    [ -s out/t/index.html ] || fail "no page"
    grep -qE '100\.0 % known, [0-9.]+ % inherited' out/t/page/numbers.html || fail "the page does not show how much depth is inherited"
    grep -q 'Inherited depth.*most in photo_[0-9] (' out/t/page/numbers.html || fail "the page does not name the views with the most inherited depth"
    grep -qx 't out/t done' told || fail "ON_DONE was not run, or not told how the run ended"
    tail -n 1 first.log | matches 'ON_DONE: the command ended with status 1; the run itself: done' || fail "the command's failure is not said"
    tail -n 3 first.log | matches 'video  out/t/parallax/establishing_dolly/video.mp4' || fail "the run does not end with the video's path"
    n=$(ffprobe -v error -count_frames -select_streams v -show_entries stream=nb_read_frames,pix_fmt,codec_name,width,height -of csv=p=0 out/t/parallax/establishing_dolly/video.mp4)
    [ "$n" = "h264,160,120,yuv420p,6" ] || fail "the video is $n, wanted h264,160,120,yuv420p,6"
}

a_second_make_does_nothing_even_after_a_comment_in_a_config()
{
    snapshot out/t >a
    echo '# a comment' >>scenes/t/scene.cfg
    run_scene >log
    snapshot out/t >b
    diff a b || fail "a second make remade something"
    run_scene why | matches 'Nothing is stale' || fail "make why finds stale products"
    [ -z "$(run_scene -n report | grep run_stage)" ] || fail "make -n would run something"
    run_scene status >log
    grep -q '^t: the run towards report ended well at ' log && grep -qx 'Nothing is stale.' log || { cat log; fail "status of a scene that is made"; }
    awk '$1 == "segment_depth" && $2 > 0 && $3 == 0 && $4 == 0 { seen = 1 } END { exit !seen }' log || { cat log; fail "status of its depth"; }
}

a_parameter_redoes_its_stage_and_what_follows()
{
    snapshot out/t >a
    printf '[encode_video]\ncrf = 30\n' >>scenes/t/scene.cfg
    run_scene why >why
    grep -q 'video.mp4: .*encode_video.cfg' why || { cat why; fail "make why does not name the changed parameters"; }
    grep -q 'crf = 30' why || { cat why; fail "make why does not show the new value"; }
    run_scene >log
    snapshot out/t >b
    [ "$(changed a b)" = "index.html
parallax/establishing_dolly/video.mp4" ] || { changed a b; fail "wrong products were remade"; }
}

a_wrong_config_is_refused_and_the_old_products_stay()
{
    cp scenes/t/scene.cfg keep.cfg
    snapshot out/t >a
    printf '[segment_depth]\nplanes = none\n' >>scenes/t/scene.cfg
    if run_scene >log 2>&1; then fail "a wrong value was accepted"; fi
    grep -q 'scene.cfg' log || { cat log; fail "the message does not name the file"; }
    cp keep.cfg scenes/t/scene.cfg
    printf '[segmentdepth]\n' >>scenes/t/scene.cfg
    if run_scene >log 2>&1; then fail "an unknown section was accepted"; fi
    grep -q 'scene.cfg:.*segmentdepth' log || { cat log; fail "the message does not name the section"; }
    cp keep.cfg scenes/t/scene.cfg
    snapshot out/t >b
    diff a b || fail "a refused run changed products"
    rm out/t/index.html
    run_scene >log 2>&1 || { cat log; fail "make with the config corrected"; }
    snapshot out/t >b
    [ "$(changed a b)" = index.html ] || { changed a b; fail "more than the lost page was remade"; }
}

# made_of FOLDER...: hash and name of every product in these folders of out/t
made_of() { (cd out/t && find "$@" -type f ! -name '.*' ! -name '*.d' | LC_ALL=C sort | xargs -d '\n' sha256sum); }

depth_announces_its_work_and_time()
{
    made_of depth >before
    rm out/t/depth/photo_3.exr
    run_scene CORES=1 depth >log || { cat log; fail "make depth"; }
    sed -n '/^depth: /,$p' log | sed -n 1,2p >announced
    { read -r first; read -r second; } <announced
    [[ $first =~ ^depth:\ 1\ view\ of\ 160\ x\ 120,\ [0-9]\ neighbours,\ 1\ round:\ about\ [0-9]+\ s\ on\ 1\ core,\ [0-9]+\ MiB\ at\ a\ time$ ]] || { cat log; fail "found the line '$first'"; }
    [[ $second == 'segment_depth 1/1 photo_3'* ]] || { cat log; fail "'$second' follows the announcement"; }
    made_of depth | diff before - || fail "other bytes came out"
    run_scene depth >log || { cat log; fail "make depth again"; }
    ! grep '^depth: ' log || fail "work is announced where there is none"
    rm -r out/t/depth/round0/photo_*.exr
    run_scene depth >log || { cat log; fail "make depth after deleting a round"; }
    grep -qE '^depth: 6 views of 160 x 120, .*, 2 rounds: about ' log || { cat log; fail "the announcement does not count both rounds"; }
}

points_are_made_on_demand()
{
    [ ! -e out/t/points ] || fail "points were made without make points"
    run_scene points >log || { cat log; fail "make points"; }
    head -n 3 out/t/points/points.ply | matches -ax 'comment remodel-points 1' || fail "the file has no points"
    ! grep -aqF "$PWD" out/t/points/points.ply || fail "the points name a folder of this machine"
    n=$(grep -am 1 '^element vertex' out/t/points/points.ply | cut -d' ' -f3)
    [ "$n" -gt 5000 ] || fail "only $n points"
    sha256sum out/t/points/points.ply >before
    stat -c %y out/t/points/points.ply >a
    run_scene points >log
    stat -c %y out/t/points/points.ply | diff a - || fail "a second make points remade them"
    made_of depth >maps
    rm out/t/depth/photo_3.exr out/t/depth/photo_4.txt
    run_scene points CORES=1 >log || { cat log; fail "make points after depth maps were deleted"; }
    made_of depth | diff maps - || fail "other depth maps came out"
    sha256sum out/t/points/points.ply | diff before - || fail "other points came out"
    ! stat -c %y out/t/points/points.ply | diff -q a - >/dev/null || fail "a new depth map did not remake the points"
    printf '[fuse_points]\ngrid = 0.02\n' >>scenes/t/scene.cfg
    snapshot out/t >a
    run_scene points >log
    snapshot out/t >b
    diff a b || fail "a parameter of fuse_points remade something else"
    [ "$(grep -am 1 '^element vertex' out/t/points/points.ply | cut -d' ' -f3)" -lt $((n / 2)) ] || fail "the points do not follow the grid"
}

# only_photo_5_and_its_readers: of views and depth the file c (changed A B) lists photo_5's and those that read it
only_photo_5_and_its_readers()
{
    local d v
    grep -q '^views/photo_5.exr' c || fail "the changed view was not remade"
    ! grep -qE '^(sfm/|views/(cameras|images|points3D)|views/photo_[12346]\.)' c || { cat c; fail "too much was remade"; }
    for d in out/t/depth/photo_?.d; do
        v=$(basename "$d" .d)
        if reads "$d" photo_5; then grep -q "^depth/$v.exr" c || fail "$v reads the changed view, but was not remade"
        else ! grep -q "^depth/$v.exr" c || fail "$v does not read the changed view, but was remade"; fi
    done
}

a_changed_photo_redoes_its_view_and_its_readers()
{
    made_of views depth >clean
    snapshot out/t >a
    photos set --change 5 >/dev/null
    run_scene depth >log || { cat log; fail "make depth"; }
    snapshot out/t >b
    changed a b >c
    only_photo_5_and_its_readers
    photos set >/dev/null
}

a_mask_redoes_its_view_and_its_readers()
{
    mkdir -p scenes/t/masks
    for at in "50 40" "90 60"; do
        snapshot out/t >a
        painted scenes/t/masks/photo_5.png $at
        if [ "$at" = "90 60" ]; then
            run_scene why >why
            grep -q 'views/photo_5.exr: .*mask/photo_5.txt is newer' why || { cat why; fail "make why does not name the mask"; }
        fi
        run_scene depth >log || { cat log; fail "make with the mask at $at"; }
        snapshot out/t >b
        changed a b >c
        only_photo_5_and_its_readers
        set -- $at
        for p in "$1 $2" "$(($1 + 29)) $(($2 + 24))"; do
            [ "$(alpha out/t/views/photo_5.exr $p)" = 00000000 ] || fail "the view has a pixel at $p"
            [ "$(alpha out/t/depth/photo_5.exr $p interior)$(alpha out/t/depth/photo_5.exr $p boundary)" = 0000000000000000 ] || fail "there is depth at $p"
        done
        for p in "$(($1 - 1)) $2" "$1 $(($2 + 25))"; do
            [ "$(alpha out/t/views/photo_5.exr $p)" = 0000803f ] || fail "the view lacks the pixel $p, beside the mask"
        done
    done
    snapshot out/t >a
    run_scene depth >log
    snapshot out/t >b
    diff a b || fail "a second make remade something"
    ffmpeg -v error -f lavfi -i color=white:s=32x24 -frames:v 1 -y scenes/t/masks/photo_5.png
    if run_scene depth >log 2>&1; then fail "a mask of another size was accepted"; fi
    grep -q 'masks/photo_5.png has 32 x 24 pixels, but the photo "photo_5.jpg" that it masks has 160 x 120' log || { cat log; fail "no message about the mask's size"; }
    # the mask goes, and one of no photo comes
    mv scenes/t/masks/photo_5.png scenes/t/masks/photo_9.png
    run_scene depth >log 2>&1 || { cat log; fail "make without the mask"; }
    snapshot out/t >b
    changed a b >c
    only_photo_5_and_its_readers
    made_of views depth | diff clean - || fail "without the mask other bytes come out than before"
    grep -q 'masks/photo_9.png masks nothing' log || { cat log; fail "no warning about a mask of no photo"; }
    rm -r scenes/t/masks
}

# the planes in the depth map of photo_5
planes_5() { awk '/^segments/ { go = 1; next } go { print $3, $4, $5 }' out/t/depth/photo_5.txt; }

given_depth_is_used_and_redoes_its_view_and_its_readers()
{
    mkdir -p given
    for what in one two other; do
        snapshot out/t >a
        case $what in
        one) cp set/truth/photo_5.exr given ;;
        two) echo 'scale 2' >given/depth.txt ;;
        other) mv given/photo_5.exr given/photo_6.exr ;;
        esac
        run_scene DEPTH=given depth >log || { cat log; fail "make with $what"; }
        snapshot out/t >b
        changed a b >c
        ! grep -qE '^(sfm|views)/' c || { cat c; fail "too much was remade"; }
        gave=photo_5; [ $what != other ] || gave='photo_[56]'
        grep -q "gives the depth of 1 of 6 views" log || { cat log; fail "the run does not count the views whose depth is given"; }
        grep -q "depth is given for 19200 of 19200 pixels" out/t/log/segment_depth.photo_$([ $what = other ] && echo 6 || echo 5).log || fail "the log does not count the pixels whose depth is given"
        ! grep -E '^depth/round0/.*exr' c | matches -v "round0/$gave.exr" || { cat c; fail "views whose depth is not given were remade in the first round"; }
        for d in out/t/depth/photo_?.d; do
            v=$(basename "$d" .d)
            # shellcheck disable=SC2053 # a pattern
            if [[ $v == $gave ]] || sed 1d "$d" | matches "/depth/round0/$gave.exr"; then grep -q "^depth/$v.exr" c || fail "$v reads given depth, but was not remade"
            else ! grep -q "^depth/$v.exr" c || fail "$v does not read given depth, but was remade"; fi
        done
        case $what in
        one) planes_5 >planes ;;
        two) planes_5 | paste - planes | awk '{ for (i = 1; i <= 3; i++) if ((d = 2 * $i - $(i + 3)) > 1e-6 || d < -1e-6) { bad++; break } } END { print bad+0, NR; exit bad > NR / 20 || NR < 100 }' || fail "depth that is twice as far has not half the inverse depths" ;;
        esac
    done
    snapshot out/t >a
    run_scene DEPTH=given depth >log
    snapshot out/t >b
    diff a b || fail "a second make remade something"
    ffmpeg -v error -f lavfi -i color=gray:s=160x120 -frames:v 1 -pix_fmt gray16be given/photo_3.png
    echo 'pixels view' >given/depth.txt
    if run_scene DEPTH=given depth >log 2>&1; then fail "a PNG without scale was accepted"; fi
    grep -q 'given/photo_3.png holds whole numbers' log || { cat log; fail "no message about the scale"; }
    # files of no view: alone they are an error
    rm given/photo_6.exr; mv given/photo_3.png given/photo_33.png
    if run_scene DEPTH=given depth >log 2>&1; then fail "depth of no view was accepted"; fi
    grep -q 'gives the depth of 0 of 6 views. Name its files VIEW.exr, VIEW.png, VIEW.pfm, VIEW.tif or VIEW.tiff, where VIEW is one of: photo_1' log || { cat log; fail "the formats are not named"; }
    cp set/truth/photo_5.exr given/PHOTO_5.EXR
    run_scene DEPTH=given depth >log 2>&1 || { cat log; fail "make"; }
    grep -q "gives the depth of 1 of 6 views" log || { cat log; fail "a name in capitals is not known"; }
    grep -q 'files that belong to no view: photo_33' log || { cat log; fail "no warning about a file of no view"; }
    run_scene depth >log 2>&1 || { cat log; fail "make without DEPTH"; }
    made_of views depth | diff clean - || fail "without given depth other bytes come out than before"
    if run_scene DEPTH=nowhere depth >log 2>&1; then fail "DEPTH=nowhere was accepted"; fi
    grep -q 'DEPTH=nowhere is not a folder' log || { cat log; fail "no message about the folder"; }
}

an_excluded_photo_redoes_sfm()
{
    snapshot out/t >a
    run_scene EXCLUDE=photo_6.jpg views >log 2>&1 || { cat log; fail "make EXCLUDE"; }
    grep -q photo_6 out/t/views/images.txt && fail "photo_6 is still a view"
    snapshot out/t >b
    changed a b | matches '^sfm/' || fail "SfM was not redone"
    run_scene views >log 2>&1
    grep -q photo_6 out/t/views/images.txt || fail "photo_6 did not come back"
}

a_draft_leaves_the_default_alone_and_shares_its_sfm()
{
    snapshot out/t >a
    run_scene QUALITY=draft video >log 2>&1 || { cat log; fail "draft"; }
    snapshot out/t >b
    diff a b || fail "the draft run changed the default one"
    [ -s out/t+draft/parallax/establishing_dolly/video.mp4 ] || fail "no draft video"
    [ ! -e out/t+draft/sfm ] || fail "the draft run made its own SfM"
}

a_second_run_at_the_same_time_is_refused()
{
    exec 8>out/t/.lock; flock 8
    if run_scene >log 2>&1 8>&-; then fail "the second run went on"; fi
    grep -q 'Another run works on scene t' log || { cat log; fail "no message about the other run"; }
    # a run that has made two of five pieces of its second step, each in ten seconds
    (S=out/t O=out/t jobs=local; . common/run/run_record.sh; record_run depth; record_step 2 3 segment_depth depth; begin_tally 5)
    printf '%s 5\na\nb\n' "$(($(date +%s) - 20))" >out/t/log/run.tally
    run_scene status >log 8>&-
    awk '$1 == "segment_depth" && $2 + $3 == 12 { seen = 1 } /No rule/ { bad = 1 } END { exit !seen || bad }' log || { cat log; fail "status of the goal of a run at work"; }
    make -s DEPS=manual status >log 2>&1 8>&-
    grep -qE '^t: at work towards depth since .*, in out/t, in step 2 of 3 \(depth\), 2 of 5 pieces, about (2[89]|[3-9][0-9]) s left of the step$' log || { cat log; fail "status of a run at work"; }
    exec 8>&-
    run_scene status TO=depth | matches '^t: the run towards depth of .* was ended without a word, in step 2 of 3 (depth)$' || fail "status of a run that was killed"
}

several_goals_run_one_after_the_other()
{
    rm -rf out/t/points out/t/depth/photo_1.exr
    make -s DEPS=manual SCENE=t -j2 depth points >log 2>&1 || { cat log; fail "make -j2 depth points"; }
    [ -s out/t/points/points.ply ] || fail "no points"
}

jobs_times_threads_never_exceed_the_cores()
{
    made_of depth >want
    rm -rf out/t/depth
    make DEPS=manual SCENE=t -j8 CORES=2 V=1 depth >log 2>&1 || { cat log; fail "make -j8"; }
    [ "$(grep -c 'bin/segment_depth --threads 1 ' log)" -ge 1 ] || { cat log; fail "wanted two jobs of one thread"; }
    ! grep -q 'threads 2' log || fail "two jobs of two threads on two cores"
    made_of depth | diff want - || fail "two jobs give other bytes"
}

threads_splits_and_resumes_give_the_same_bytes()
{
    rm -rf out/t/depth out/t/parallax
    run_scene CORES=3 >log 2>&1 || { cat log; fail "three cores"; }
    products t >want
    rm -rf out/t/views out/t/depth out/t/parallax
    # killed on the way with SIGKILL, then resumed
    for file in views/photo_2.exr depth/photo_2.exr 'parallax/*/frames/0002.exr'; do
        kill_at "out/t/$file" make -s DEPS=manual SCENE=t CORES=1 FRAMES_PER_JOB=2
    done
    run_scene CORES=1 FRAMES_PER_JOB=2 >log 2>&1 || { cat log; fail "resumed run"; }
    products t | diff want - || fail "a resumed run on one core gives other bytes than one on three"
}

for t in chain_from_photos_to_video a_second_make_does_nothing_even_after_a_comment_in_a_config a_parameter_redoes_its_stage_and_what_follows \
    a_wrong_config_is_refused_and_the_old_products_stay depth_announces_its_work_and_time \
    points_are_made_on_demand a_changed_photo_redoes_its_view_and_its_readers a_mask_redoes_its_view_and_its_readers \
    given_depth_is_used_and_redoes_its_view_and_its_readers an_excluded_photo_redoes_sfm a_draft_leaves_the_default_alone_and_shares_its_sfm \
    a_second_run_at_the_same_time_is_refused several_goals_run_one_after_the_other jobs_times_threads_never_exceed_the_cores \
    threads_splits_and_resumes_give_the_same_bytes; do run "$t"; done
