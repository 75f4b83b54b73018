# bad photos, odd names, a full disk, killed stages: each gives the right result, or a clear error and no damage
. tests/lib.sh
project failures
photos set >/dev/null
small t

copy() { rm -rf "$1"; mkdir "$1"; cp set/photos/*.jpg "$1"/; }
# refused WORD...: make PHOTOS=bad fails with a message that has every word, and makes no list of views
refused()
{
    rm -rf out/bad scenes/bad
    before=$(ls -l --time-style=full-iso bad | sha256sum)
    if make -s DEPS=manual PHOTOS=bad SCENE=bad SFM=set/model >log 2>&1 </dev/null; then cat log; fail "it was accepted"; fi
    for w in "$@"; do grep -qF -- "$w" log || { cat log; fail "the message does not have '$w'"; }; done
    [ ! -e out/bad/views/views.mk ] || fail "the run went on to views"
    [ "$before" = "$(ls -l --time-style=full-iso bad | sha256sum)" ] || fail "the user's folder was changed"
}

truncated_photo() { copy bad; head -c 5000 set/photos/photo_4.jpg >bad/photo_4.jpg; refused photo_4.jpg EXCLUDE; }
empty_photo() { copy bad; : >bad/photo_3.jpg; refused photo_3.jpg empty; }
not_a_photo() { copy bad; echo hello >bad/photo_2.jpg; refused photo_2.jpg; }
cmyk_photo() { copy bad; cp "$root"/tests/fuzz/corpus/photo/*cmyk*.jpg bad/photo_5.jpg; refused photo_5.jpg CMYK; }
two_bad_photos_are_both_named() { copy bad; : >bad/photo_3.jpg; echo x >bad/photo_5.jpg; refused photo_3.jpg photo_5.jpg; }
no_photo() { rm -rf bad; mkdir bad; refused bad; }
one_photo() { rm -rf bad; mkdir bad; cp set/photos/photo_1.jpg bad; refused bad; }
no_folder()
{
    if make -s DEPS=manual PHOTOS=nowhere SCENE=nowhere >log 2>&1; then fail "it was accepted"; fi
    grep -q 'nowhere' log || fail "the message does not name the folder"
    [ ! -e scenes/nowhere ] || fail "a scene was left behind"
}
a_model_without_its_script_is_refused_before_any_work()
{
    rm -rf scenes/plain out/plain
    if make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=plain PRODUCTS=model >log 2>&1; then fail "it was accepted"; fi
    grep -q 'scenes/plain/model.txt.*make suggest' log || { cat log; fail "the message does not name the script"; }
    grep -q '^PRODUCTS := model$' scenes/plain/scene.mk || fail "scene.mk does not keep PRODUCTS"
    [ ! -e out/plain/photos ] || fail "work was done"
}
unreadable_photo()
{
    copy bad
    rm bad/photo_4.jpg; ln -s nowhere.jpg bad/photo_4.jpg
    refused photo_4.jpg
}

odd_photo_names()
{
    rm -rf 'o d d'; mkdir 'o d d'
    cp set/photos/photo_1.jpg 'o d d/a photo.jpg'
    cp set/photos/photo_2.jpg "o d d/it's \"quoted\".jpg"
    cp set/photos/photo_3.jpg 'o d d/cost $5 #2.jpg'
    cp set/photos/photo_4.jpg 'o d d/same.jpg'
    cp set/photos/photo_5.jpg 'o d d/same.JPEG'
    cp set/photos/photo_6.jpg 'o d d/dots.1.2.jpg'
    rm -rf odd-model; cp -r set/model odd-model
    sed -i -e "s|photo_1.jpg$|a photo.jpg|; s|photo_2.jpg$|it's \"quoted\".jpg|; s|photo_3.jpg$|cost \$5 #2.jpg|; s|photo_4.jpg$|same.jpg|; s|photo_5.jpg$|same.JPEG|; s|photo_6.jpg$|dots.1.2.jpg|" odd-model/images.txt
    small odd
    make -s DEPS=manual PHOTOS='o d d' SFM=odd-model SCENE=odd >log 2>&1 || { cat log; fail "make"; }
    n=$(grep -c '\.exr$' out/odd/views/images.txt)
    [ "$n" = 6 ] || { cut -c1-80 out/odd/views/images.txt; fail "$n views, wanted 6"; }
    make -s DEPS=manual SCENE=odd why >log 2>&1
    grep -q 'Nothing is stale' log || { cat log; fail "a second make would remake something"; }
}

odd_folder_names()
{
    d='pho$to #1 '"it's"
    rm -rf "$d"; cp -r set/photos "$d"
    small folder
    make -s DEPS=manual PHOTOS="$d" SFM=set/model SCENE=folder views >log 2>&1 || { cat log; fail "make PHOTOS"; }
    make -s DEPS=manual SCENE=folder views >log 2>&1 || { cat log; fail "make from scene.mk"; }
}

a_killed_stage_leaves_no_product_and_is_run_again()
{
    photos large --size 320x240 --views 4 >/dev/null
    mkdir -p scenes/large # as many planes as by default, so that the stage takes long enough to be caught
    printf '[segment_depth]\nrounds = 0\n' >scenes/large/scene.cfg
    make -s DEPS=manual PHOTOS=large/photos SFM=large/model SCENE=large depth >log 2>&1 || { cat log; fail "make"; }
    want=$(sha256sum out/large/depth/photo_3.exr)
    for _ in 1 2 3 4 5; do
        rm -f out/large/depth/photo_3.*
        make -s DEPS=manual SCENE=large depth >log 2>&1 &
        run=$! caught=
        while [ ! "$caught" ] && kill -0 "$run" 2>/dev/null; do
            for p in /proc/[0-9]*; do
                [ "$p/exe" -ef "$root/$B/bin/segment_depth" ] && [ "$p/cwd" -ef . ] || continue
                tr '\0' ' ' <"$p/cmdline" | matches -- '--view photo_3 .*--out out/large/' || continue
                ! kill -9 "${p#/proc/}" || caught=yes
            done 2>/dev/null
            sleep 0.01
        done
        rc=0; wait "$run" || rc=$?
        [ "$rc" = 0 ] || break # else the stage was over before the signal came
    done
    [ "$caught" ] && [ "$rc" -ne 0 ] || { cat log; fail "make did not fail"; }
    grep -q 'signal 9' log || { cat log; fail "the message does not name the signal"; }
    [ ! -e out/large/depth/photo_3.exr ] || fail "there is a half-made product"
    make -s DEPS=manual SCENE=large status TO=depth >log 2>&1
    grep -q '^large: the run towards depth failed at .*, in step [0-9]* of [0-9]* (depth)$' log && grep -q '^failed: segment_depth photo_3; out/large/log/segment_depth.photo_3.log ends with:$' log || { cat log; fail "status of a run that failed"; }
    make -s DEPS=manual SCENE=large depth >log 2>&1 || { cat log; fail "make after it"; }
    [ "$want" = "$(sha256sum out/large/depth/photo_3.exr)" ] || fail "other bytes"
}

photos_held_upright_give_an_upright_video()
{
    # EXIF orientation 6: the stored rows are columns of what people see
    mkdir -p turned
    for p in set/photos/*.jpg; do
        { printf '\xff\xd8\xff\xe1\x00\x22Exif\x00\x00II\x2a\x00\x08\x00\x00\x00\x01\x00\x12\x01\x03\x00\x01\x00\x00\x00\x06\x00\x00\x00\x00\x00\x00\x00'
          tail -c +3 "$p"; } >"turned/${p##*/}"
    done
    # a planned move may differ where two paths score almost the same; a film of keys does not
    small turned
    for s in t turned; do mkdir -p scenes/$s/keyframes; printf 'remodel-keyframes 1\nkey 0 view photo_3\nkey 0.2 view photo_4\n' >scenes/$s/keyframes/across.txt; done
    make -s DEPS=manual PHOTOS=turned SFM=set/model SCENE=turned EFFECT=across video >log 2>&1 || { cat log; fail "make"; }
    grep -q '^orientation 6' out/turned/photos/photo_1.txt || fail "the orientation is not recorded"
    v=out/turned/parallax/across/video.mp4
    [ "$(ffprobe -v error -show_entries stream=width,height -of csv=p=0 $v)" = 120,160 ] || fail "the video is not upright"
    # the film of the photos as they are, turned by ffmpeg, shows the same
    make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=t EFFECT=across video >log 2>&1 || { cat log; fail "make"; }
    db=$(ffmpeg -v info -i $v -i out/t/parallax/across/video.mp4 -filter_complex '[1:v]transpose=clock[b];[0:v][b]psnr' -frames:v 1 -f null - 2>&1 | sed -nE 's/.*average:([0-9]+).*/\1/p')
    [ "${db:-0}" -ge 30 ] || fail "PSNR against the turned video is ${db:-none} dB"
}

a_full_disk_fails_and_the_run_resumes()
{
    [ "$(id -u)" = 0 ] || skip "mounting a small tmpfs needs root"
    mkdir -p small out/full
    mount -t tmpfs -o size=600k none out/full 2>/dev/null || skip "a tmpfs cannot be mounted here"
    small full
    rc=0
    make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=full >log 2>&1 || rc=$?
    whole=0 broken=
    for f in out/full/views/*.exr out/full/depth/*.exr; do
        [ -e "$f" ] || continue
        if "$B/bin/verify" --file "$f" 2>/dev/null; then whole=$((whole + 1)); else broken="$broken $f"; fi
    done
    mount -o remount,size=200m out/full
    rc2=0
    make -s DEPS=manual SCENE=full video >log2 2>&1 || rc2=$?
    made=$(ls out/full/parallax/*/video.mp4 2>/dev/null)
    umount out/full
    [ "$rc" -ne 0 ] || fail "a full disk went unnoticed"
    grep -qi 'no space left' log || { cat log; fail "no message about the space"; }
    [ -z "$broken" ] || fail "half-made:$broken"
    [ "$rc2" = 0 ] && [ -n "$made" ] || { cat log2; fail "the run does not resume when there is space"; }
}

photos_of_different_sizes_and_formats()
{
    # through COLMAP itself, as a user would; one photo is another size, one a PNG
    photos sized --views 4 --size 320x240 >/dev/null
    photos half --views 4 --size 280x210 >/dev/null
    cp half/photos/photo_4.jpg sized/photos/photo_4.jpg
    ffmpeg -v error -i sized/photos/photo_2.jpg sized/photos/photo_2.png
    rm sized/photos/photo_2.jpg
    small sized
    make -s DEPS=manual PHOTOS=sized/photos SCENE=sized video >log 2>&1 || { tail -n 30 log; fail "make"; }
    [ "$(awk '!/^#/ { print $3, $4 }' out/sized/sfm/0/cameras.txt | sort -u | wc -l)" = 2 ] || fail "two sizes of cameras were expected"
    [ -e out/sized/views/photo_2.exr ] || fail "the PNG became no view"
}

photos_that_do_not_overlap_are_refused_with_a_reason()
{
    rm -rf flat; mkdir flat
    # with other bytes at their ends: of photos that are alike one is left out
    for i in 1 2 3; do { cat "$root"/tests/fuzz/corpus/photo/grey.jpg; echo $i; } >"flat/p$i.jpg"; done
    if make -s DEPS=manual PHOTOS=flat SCENE=flat >log 2>&1; then fail "it was accepted"; fi
    grep -qiE 'features|overlap|texture' log || { tail log; fail "the message gives no reason"; }
    [ ! -e out/flat/sfm/models.txt ] || fail "a model was left"
}

for t in truncated_photo empty_photo not_a_photo cmyk_photo two_bad_photos_are_both_named no_photo one_photo no_folder a_model_without_its_script_is_refused_before_any_work \
    unreadable_photo odd_photo_names odd_folder_names photos_held_upright_give_an_upright_video a_killed_stage_leaves_no_product_and_is_run_again a_full_disk_fails_and_the_run_resumes photos_of_different_sizes_and_formats \
    photos_that_do_not_overlap_are_refused_with_a_reason; do run "$t"; done
