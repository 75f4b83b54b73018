# make remodel, tour, exports: pictures, films and files of a synthetic scene's edits; threads; given cameras; errors
. tests/lib.sh
project remodel
photos set >/dev/null
boxed t textures
printf 'remodel-script 1\n# A blue chest, in an empty room.\nbase bare\nbox chest from -4 6 to 4 12 top 3\ncolour box/chest 0.1 0.2 0.8\nmaterial box/chest ward 0.05 0.2\nlamp ceiling off\nclear hall\n' >scenes/t/edits/chest.txt
printf '[bake_outdoors]\nheight = 64\n[plan_tour]\nwidth = 64\nheight = 48\nfps = 4\nspeed = 8\nclearance = 0.5\nhold = 0.25\n' >>scenes/t/scene.cfg
m() { make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=t "$@" >log 2>&1 || { cat log; fail "make $*"; }; }
refused() # WORD ARGUMENT...
{
    local word=$1; shift
    ! make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=t "$@" >log 2>&1 || fail "make $* was accepted"
    grep -qF -- "$word" log || { cat log; fail "make $*: nothing says '$word'"; }
}
m remodel
O=out/t
view=$(ls $O/views/*.exr | sed -n 1p); view=$(basename "$view" .exr)
drawn=(--axes "$O/model/axes.txt" --views "$O/views" --vdta "$O/vdta" --vita "$O/vita" --ids "$O/ids" --depth "$O/depth" --outdoors "$O/outdoors/outdoors.exr")
edited=(--model "$O/remodel/chest/model.txt" --base "$O/model/model.txt" --map "$O/remodel/chest/texture.txt" "${drawn[@]}")

every_edit_has_a_record_of_each_view()
{
    local n; n=$(ls $O/views/*.exr | wc -l)
    for e in bare chest; do
        [ "$(ls $O/remodel/$e/pictures/*.txt | wc -l)" = "$n" ] || fail "$e: wanted $n records"
        "$B/bin/verify" --file $O/remodel/$e/texture.txt || fail "$e: texture.txt is not whole"
    done
    awk '$1 == "changed" { most = $2 > most ? $2 : most } END { exit !(most > 1) }' $O/remodel/chest/pictures/*.txt || fail "the chest changes no view"
    for f in "$O"/remodel/chest/pictures/*.jpg; do [ -s "${f%.jpg}-sources.png" ] || fail "$f has no picture of its sources"; done
    ! grep -rqF "$PWD" $O/remodel/*/pictures || fail "a product names a folder of this machine"
    [ -s $O/remodel/index.html ] || fail "there is no page"
    grep -q 'A blue chest, in an empty room.' $O/remodel/index.html || fail "the page does not say what the edit is"
}

a_second_run_makes_nothing()
{
    find $O -type f -printf '%p %T@\n' | grep -vE '/log/|/.lock ' | LC_ALL=C sort >before
    m remodel
    find $O -type f -printf '%p %T@\n' | grep -vE '/log/|/.lock ' | LC_ALL=C sort | diff before - || fail "something was made again"
}

the_edit_below_makes_those_on_it_again()
{
    touch before
    echo '# another comment' >>scenes/t/edits/bare.txt
    m model
    [ $O/remodel/chest/model.txt -nt before ] || fail "chest stands on bare, but was not made again"
    m remodel
}

all_pictures_have_one_exposure()
{
    local all; all=$(awk '$1 == "exposure" { print $2 }' $O/remodel/*/pictures/*.txt | sort -u)
    [ "$(wc -l <<<"$all")" = 1 ] || fail "pictures have several exposures: ${all//$'\n'/ }"
    awk -v e="$all" '$1 == "exposure" { found = ($2 / e - 1) ^ 2 < 1e-12 } END { exit !found }' $O/exposure.txt || fail "pictures have exposure $all, not that of $O/exposure.txt"
    grep -q 'pictures of the rooms have exposure' $O/log/choose_exposure.all.log || { cat $O/log/choose_exposure.all.log; fail "the log does not say the exposure"; }
    # views that change, but not what cameras would choose, redo no picture
    cp -p $O/exposure.txt same.txt
    "$B/bin/choose_exposure" --config $O/slice/choose_exposure.cfg --views $O/views --out $O/exposure.txt 2>err.txt || { cat err.txt; fail "choose_exposure"; }
    [ ! $O/exposure.txt -nt same.txt ] || fail "the exposure is written again although it is the same"
    "$B/bin/render_model" "${edited[@]}" --exposure $O/exposure.txt --view "$view" --set exposure=0.25 --out given 2>err.txt || { cat err.txt; fail "render_model"; }
    grep -q '^exposure 0.25$' "given/$view.txt" || fail "a given exposure is not that of the picture"
}

a_standing_wall_shows_its_paint()
{
    printf 'remodel-script 1\npaint wall/south/in 0.8 0.2 0.1\ncolour wall/north/in 0.1 0.7 0.2\n' >scenes/t/edits/paint.txt
    m model
    "$B/bin/render_model" --model $O/remodel/paint/model.txt --base $O/model/model.txt --map $O/remodel/paint/texture.txt "${drawn[@]}" \
        --view "$view" --set clutter=none --out painted 2>err.txt || { cat err.txt; fail "render_model"; }
    rm -r scenes/t/edits/paint.txt $O/remodel/paint
    awk '$1 == "changed" { changed = $2 } $1 == "made" && $2 == "colour" { colour = $3 } END { exit !(changed > 5 && colour > 5) }' "painted/$view.txt" ||
        { cat "painted/$view.txt"; fail "the photo still shows the wall without its paint"; }
}

bytes_do_not_depend_on_threads()
{
    for n in 1 2; do
        "$B/bin/render_model" "${edited[@]}" --view "$view" --set radiance=yes --out two/$n --threads $n 2>err.txt || { cat err.txt; fail "render_model"; }
    done
    diff -r two/1 two/2
}

pixels_that_the_edit_leaves_alone_are_the_photos_own()
{
    "$B/bin/render_model" --model $O/model/model.txt "${drawn[@]}" --view "$view" --set radiance=yes --out same 2>err.txt || { cat err.txt; fail "render_model"; }
    grep -q '^changed 0$' "same/$view.txt" || fail "the unedited model changes its own photo"
    [ ! -e "same/$view.jpg" ] || fail "a picture of nothing new was written"
}

given_cameras_are_drawn_in_any_frame_and_lens()
{
    mkdir -p cams
    cp $O/views/cameras.txt $O/views/images.txt cams/; : >cams/points3D.txt
    find $O/views $O/depth $O/vita -type f -printf '%p %T@\n' | LC_ALL=C sort >before
    m remodel CAMERAS=cams EDIT=chest
    find $O/views $O/depth $O/vita -type f -printf '%p %T@\n' | LC_ALL=C sort | diff before - || fail "given cameras made the scene again"
    [ -s $O/remodel/chest/cameras/pictures.txt ] || fail "no list of pictures"
    [ -s "$O/model/cameras/$view.jpg" ] || fail "no picture of the unedited rooms to compare with"
    "$B/bin/verify" --file "$O/remodel/chest/cameras/$view.exr" || fail "a picture is not whole"
    m remodel CAMERAS=cams CAMERAS_FRAME=truth TRUTH=cams EDIT=chest
    mkdir -p wide; printf '1 OPENCV_FISHEYE 64 48 30 30 32 24 0 0 0 0\n' >wide/cameras.txt
    awk '!/^#/ && NF == 10 && !n++ { $9 = 1; $10 = "wide.jpg"; print; print "" }' cams/images.txt >wide/images.txt
    m remodel CAMERAS=wide EDIT=chest
    grep -q '^picture wide$' $O/remodel/chest/cameras/pictures.txt || fail "the fisheye was not drawn"
}

a_tour_has_frames_and_a_film()
{
    m tour EDIT=chest
    [ -s $O/remodel/chest/tour/video.mp4 ] || fail "there is no film"
    [ "$(grep -c '^frame ' $O/remodel/chest/tour/pairs.txt)" = "$(ls $O/remodel/chest/tour/frames/*.exr | wc -l)" ] || fail "frames and pairs differ in number"
    printf 'remodel-tour 1\nroom hal\n' >scenes/t/tour.txt
    refused 'tour.txt:2: found "hal", wanted a room of the model; did you mean hall?' tour
    rm scenes/t/tour.txt
}

exports_are_written_and_the_same_each_time()
{
    m exports
    for f in obj mtl glb ifc; do [ -s $O/remodel/chest/export/model.$f ] || fail "there is no model.$f"; done
    cp -r $O/remodel/chest/export first; rm -r $O/remodel/chest/export
    m exports
    diff -r first $O/remodel/chest/export || fail "another run gives other bytes"
}

errors_say_what_is_wrong()
{
    refused 'EDIT=none: there is no scenes/t/edits/none.txt' remodel EDIT=none
    refused 'has no images.txt' remodel CAMERAS=nowhere
    refused 'wanted scene, model or truth' remodel CAMERAS=cams CAMERAS_FRAME=moon
    refused 'wants TRUTH=DIR' remodel CAMERAS=cams CAMERAS_FRAME=truth
    local rc=0
    "$B/bin/render_model" "${edited[@]}" --view nobody --out made 2>err.txt || rc=$?
    { [ $rc = 2 ] && grep -q 'there is no view nobody' err.txt; } || { cat err.txt; fail "an unknown view was accepted"; }
    ! "$B/bin/render_model" "${edited[@]}" --out made 2>err.txt || fail "no view was accepted"
    grep -q 'wanted one of --view, --cameras and --path' err.txt || { cat err.txt; fail "no sentence"; }
    printf 'remodel-script 1\nbase circle\n' >scenes/t/edits/circle.txt
    refused 'base circle goes in a circle' model
    printf 'remodel-script 1\nbase nothing\n' >scenes/t/edits/circle.txt
    refused 'there is no scenes/t/edits/nothing.txt' model
    rm scenes/t/edits/circle.txt
}

for t in every_edit_has_a_record_of_each_view a_second_run_makes_nothing the_edit_below_makes_those_on_it_again all_pictures_have_one_exposure a_standing_wall_shows_its_paint bytes_do_not_depend_on_threads \
    pixels_that_the_edit_leaves_alone_are_the_photos_own given_cameras_are_drawn_in_any_frame_and_lens a_tour_has_frames_and_a_film \
    exports_are_written_and_the_same_each_time errors_say_what_is_wrong; do run "$t"; done
