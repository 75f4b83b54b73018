# exposure brackets: how photos are grouped into views, merged, and which products are remade; on a synthetic scene with known poses
. tests/lib.sh
project brackets
photos set --brackets 3 >/dev/null
small t

run_scene() { make -s DEPS=manual SCENE=t "$@" 2>&1; }
# times_file FILE: names and times of all products, of merged exposures and of photos' records
times_file() { { snapshot out/t; find out/t/hdr out/t/photos -type f -printf '%P %T@\n'; } | LC_ALL=C sort >"$1"; }
merged() { (cd out/t/hdr && LC_ALL=C sha256sum -- *); }

from_brackets_to_video()
{
    make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=t >first.log 2>&1 || { cat first.log; fail "make failed"; }
    grep -q '6 views of 3 exposures each: 1/16384 s, 1/4096 s, 1/1024 s' first.log || { cat first.log; fail "the run does not show the cycle"; }
    [ "$(cat out/t/photos/photos.mk)" = "PHOTO_IDS := photo_1 photo_2 photo_3 photo_4 photo_5 photo_6
BRACKETED := yes" ] || { cat out/t/photos/photos.mk; fail "wrong views"; }
    ! cmp -s out/t/hdr/photo_3.jpg set/photos/photo_3_e1.jpg || fail "the photos for SfM are not tone-mapped"
    grep -q '^curve srgb$' out/t/hdr/response.txt || { cat out/t/hdr/response.txt; fail "wanted the sRGB curve of these photos"; }
    grep -aq 'exact' out/t/views/photo_3.exr || fail "the view is not marked as exact radiometry"
    grep -aq 'hdr/photo_3.exr' out/t/views/photo_3.exr || fail "the view is not made from the merged exposures"
    [ -s out/t/parallax/establishing_dolly/video.mp4 ] && [ -s out/t/index.html ] || fail "no video or no page"
    grep -q 'hdr_merge' out/t/page/numbers.html || fail "the page does not show the merge"
}

the_next_make_does_nothing()
{
    times_file a
    run_scene >log
    times_file b
    diff a b || fail "a second make remade something"
    run_scene why | matches 'Nothing is stale' || fail "make why finds stale products"
}

merged_views_are_nearly_the_middle_exposure()
{
    # the middle exposure is well exposed almost everywhere: its film and that of the brackets, by the same cameras, are nearly the same
    mkdir -p single; for i in 1 2 3 4 5 6; do cp "set/photos/photo_${i}_e1.jpg" "single/photo_$i.jpg"; done
    small single
    for s in t single; do mkdir scenes/$s/keyframes; printf 'remodel-keyframes 1\nkey 0 view photo_3\nkey 0.2 view photo_4\n' >scenes/$s/keyframes/across.txt; done
    make -s DEPS=manual PHOTOS=single SFM=set/model SCENE=single EFFECT=across video >log 2>&1 || { cat log; fail "make of single photos"; }
    run_scene EFFECT=across video >log || { cat log; fail "make of brackets"; }
    [ ! -e out/single/hdr ] && [ ! -e out/single/photos/members ] || fail "single photos were merged"
    db=$(ffmpeg -v info -i out/t/parallax/across/video.mp4 -i out/single/parallax/across/video.mp4 \
        -filter_complex '[0:v][1:v]psnr' -frames:v 1 -f null - 2>&1 | sed -nE 's/.*average:([0-9]+).*/\1/p')
    [ "${db:-0}" -ge 30 ] || fail "PSNR between the two films is ${db:-none} dB"
    rm -r out/t/parallax/across scenes/t/keyframes
}

an_incomplete_cycle_is_refused_and_products_stay()
{
    times_file a
    mv set/photos/photo_3_e1.jpg away.jpg
    if run_scene >log 2>&1; then fail "it was accepted"; fi
    grep -q 'photo_3_e0.jpg (1/16384 s), photo_3_e2.jpg (1/1024 s)' log || { cat log; fail "the message does not name the photos"; }
    mv away.jpg set/photos/photo_3_e1.jpg
    head -c 3000 set/photos/photo_1_e0.jpg >cut.jpg
    cp set/photos/photo_1_e0.jpg keep.jpg; cp cut.jpg set/photos/photo_1_e0.jpg
    if run_scene >log 2>&1; then fail "a cut photo was accepted"; fi
    grep -q 'photo_1_e0.jpg is a damaged' log || { cat log; fail "the message does not name the cut photo"; }
    cp keep.jpg set/photos/photo_1_e0.jpg
    run_scene >log || { cat log; fail "make with the photo restored"; }
    times_file b
    changed a b | grep -v '^members/\|^photo_[0-9]_e[0-9].txt' >c || true
    [ ! -s c ] || { cat c; fail "something was remade"; }
}

a_changed_bracket_redoes_its_view_and_its_readers()
{
    merged >before
    times_file a
    photos other --brackets 3 --change 5 >/dev/null
    cp set/photos/photo_5_e0.jpg keep.jpg
    cp other/photos/photo_5_e0.jpg set/photos/
    run_scene depth >log || { cat log; fail "make"; }
    times_file b
    changed a b >c
    for w in hdr/photo_5.exr views/photo_5.exr depth/photo_5.exr; do
        grep -q "^${w#hdr/}\$\|^$w\$" c || { cat c; fail "$w was not remade"; }
    done
    ! grep -qE '^(sfm/|views/(cameras|images|points3D)|(views/)?photo_[12346]\.|list.txt|photos.mk)' c || { cat c; fail "too much was remade"; }
    for d in out/t/depth/photo_?.d; do
        v=$(basename "$d" .d)
        if reads "$d" photo_5; then grep -q "^depth/$v.exr" c || fail "$v reads the changed view, but was not remade"
        else ! grep -q "^depth/$v.exr" c || fail "$v does not read the changed view, but was made again"; fi
    done
    cp keep.jpg set/photos/photo_5_e0.jpg
    run_scene hdr >log
    merged | diff before - || fail "the old exposures do not give the old bytes"
}

a_deleted_merge_is_remade()
{
    merged >before
    rm out/t/hdr/photo_2.exr out/t/hdr/photo_4.jpg
    run_scene depth >log || { cat log; fail "make after deleting merged views"; }
    merged | diff before - || fail "other bytes came out"
}

a_mask_of_an_exposure_masks_its_view()
{
    times_file a
    mkdir -p scenes/t/masks
    painted scenes/t/masks/photo_3_e0.png 50 40
    painted scenes/t/masks/photo_3.png 100 40
    run_scene depth >log || { cat log; fail "make"; }
    times_file b
    changed a b >c
    grep -q '^views/photo_3.exr' c || { cat c; fail "the view was not remade"; }
    ! grep -qE '^(sfm|hdr)/|^views/photo_[12456]\.' c || { cat c; fail "too much was remade"; }
    for p in "65 50" "115 50"; do [ "$(alpha out/t/views/photo_3.exr $p)" = 00000000 ] || fail "the view has a pixel at $p"; done
    [ "$(alpha out/t/views/photo_3.exr 90 50)" = 0000803f ] || fail "the view lacks a pixel between the masks"
    rm -r scenes/t/masks
}

brackets_txt_groups_photos_into_views()
{
    mkdir -p named
    n=0
    for p in set/photos/photo_[1-4]_e?.jpg; do n=$((n + 7)); cp "$p" "named/IMG $((n % 13)).jpg"; done
    n=0
    mkdir -p scenes/named
    small named
    for v in 1 2 3 4; do
        printf 'photo_%s' "$v"
        for _ in 0 1 2; do n=$((n + 7)); printf ' "IMG %d.jpg"' $((n % 13)); done
        echo
    done >scenes/named/brackets.txt
    make -s DEPS=manual PHOTOS=named SFM=set/model SCENE=named hdr >log 2>&1 || { cat log; fail "make"; }
    for v in 1 2 3 4; do
        cmp "out/named/hdr/photo_$v.jpg" "out/t/hdr/photo_$v.jpg" || fail "photo_$v is not merged from its exposures"
        exr=$(tail -c 2000 "out/named/hdr/photo_$v.exr" | sha256sum)
        [ "$exr" = "$(tail -c 2000 "out/t/hdr/photo_$v.exr" | sha256sum)" ] || fail "photo_$v has other radiance"
    done
    sed -i '$d' scenes/named/brackets.txt
    if make -s DEPS=manual SCENE=named hdr >log 2>&1; then fail "photos of no view were accepted"; fi
    grep -q 'brackets.txt has no view with IMG ' log || { cat log; fail "the message does not name them"; }
    make -s DEPS=manual SCENE=named hdr EXCLUDE="$(printf "'IMG %d.jpg' " $((70 % 13)) $((77 % 13)) $((84 % 13)))" >log 2>&1 || { cat log; fail "make EXCLUDE"; }
    [ "$(wc -l <out/named/photos/list.txt)" = 3 ] || fail "three views were expected"
}

any_cores_give_the_same_bytes_and_draft_shares_the_merge()
{
    merged >before
    rm -rf out/t/hdr
    run_scene CORES=1 hdr >log || { cat log; fail "one core"; }
    merged | diff before - || fail "one core gives other bytes"
    rm -rf out/t/hdr
    run_scene CORES=3 hdr >log || { cat log; fail "three cores"; }
    merged | diff before - || fail "three cores give other bytes"
    times_file a
    run_scene QUALITY=draft views >log 2>&1 || { cat log; fail "draft"; }
    times_file b
    diff a b || fail "the draft run changed the default one"
    [ -s out/t+draft/views/photo_1.exr ] && [ ! -e out/t+draft/hdr ] || fail "the draft run merged for itself"
}

written_exposures_redo_only_their_view()
{
    times_file a
    echo 'photo_2_e2.jpg 0.00097 8 100' >scenes/t/exposures.txt # EXIF: 1/1024
    run_scene hdr >log || { cat log; fail "make"; }
    times_file b
    changed a b >c
    grep -q '^photo_2.exr' c || { cat c; fail "photo_2 was not remade"; }
    ! grep -qE '^(sfm/|photo_[13456]\.)' c || { cat c; fail "too much was remade"; }
    echo 'photo_9.jpg 1' >>scenes/t/exposures.txt
    if run_scene hdr >log 2>&1; then fail "an exposure of a missing photo was accepted"; fi
    grep -q 'exposures.txt:2: found photo_9.jpg' log || { cat log; fail "no message about it"; }
    rm scenes/t/exposures.txt
}

brackets_no_keeps_photos_apart()
{
    printf '[import_photos]\nbrackets = no\n' >>scenes/t/scene.cfg
    rm -rf out/t
    if run_scene hdr SFM= >log 2>&1; then :; else cat log; fail "make"; fi
    [ "$(wc -l <out/t/photos/list.txt)" = 18 ] && [ ! -e out/t/photos/brackets.txt ] && [ ! -e out/t/hdr ] || fail "they were grouped"
}

for t in from_brackets_to_video the_next_make_does_nothing merged_views_are_nearly_the_middle_exposure \
    an_incomplete_cycle_is_refused_and_products_stay a_changed_bracket_redoes_its_view_and_its_readers a_deleted_merge_is_remade \
    a_mask_of_an_exposure_masks_its_view brackets_txt_groups_photos_into_views \
    any_cores_give_the_same_bytes_and_draft_shares_the_merge written_exposures_redo_only_their_view brackets_no_keeps_photos_apart; do run "$t"; done
