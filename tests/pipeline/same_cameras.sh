# the same photographs give the same cameras: for any number of cores, in another folder, after a kill, and after a photo came
# and went. Only what a photo is in is compared again.
. tests/lib.sh
project here
photos set --views 5 --size 160x120 >/dev/null
photos more --views 6 --size 160x120 --change 5 >/dev/null
m() { make -s DEPS=manual PHOTOS=set/photos SCENE=t "$@" >log 2>&1; }
# cameras: hashes of everything from the features to the cameras of the views
cameras() { (cd out/t && find features matches pairs.txt sfm views -type f -name '*.txt' | LC_ALL=C sort | xargs sha256sum); }

cameras_are_the_same_for_any_number_of_cores()
{
    m CORES=2 sfm || { cat log; fail "make sfm"; }
    cameras >first
    [ "$(grep -c ' features/' first)" = 5 ] && grep -q ' views/images.txt' first || { cat first; fail "products are missing"; }
    grep -q '^# input colmap-[0-9]' out/t/sfm/models.txt || fail "the provenance does not name COLMAP's version"
    grep -q '^# input matches/photo_5.txt ' out/t/sfm/models.txt || fail "the provenance does not name the matches"
    rm -r out/t
    m CORES=1 sfm || { cat log; fail "make sfm with one core"; }
    cameras | diff first - || fail "other bytes with one core"
}

cameras_are_the_same_in_another_folder()
{
    project there
    cp -r ../here/set .
    m -j1 sfm || { cat log; fail "make sfm"; }
    cameras | diff ../here/first - || fail "other bytes in another folder"
}

cameras_are_the_same_after_a_kill()
{
    rm -r out/t
    kill_at out/t/matches/photo_2.txt make -s DEPS=manual PHOTOS=set/photos SCENE=t sfm
    kill_at out/t/sfm.work/colmap-3.log make -s DEPS=manual PHOTOS=set/photos SCENE=t sfm
    m sfm || { cat log; fail "make sfm"; }
    cameras | diff first - || fail "other bytes after a kill"
}

a_photo_that_comes_and_goes_costs_its_own_pairs()
{
    (cd out/t && stat -c '%n %y' features/*.txt) >before
    cp more/photos/photo_6.jpg set/photos/
    m sfm || { cat log; fail "make sfm with another photo"; }
    (cd out/t && stat -c '%n %y' features/photo_[1-5].txt) | diff before - || fail "the features of other photos were found again"
    grep -h 'matched with' out/t/log/match_photos.photo_1.log | matches 'matched with 1 photos, kept 4' || fail "pairs of other photos were matched again"
    awk '/photos are placed/ && $2 == 6 { found = 1 } END { exit !found }' log || { cat log; fail "the new photo was not placed"; }
    rm set/photos/photo_6.jpg
    m sfm || { cat log; fail "make sfm without it"; }
    cameras | grep -v photo_6 | diff first - || fail "other bytes after the photo went"
}

# COLMAP's own start is made to see two photos only
another_start_places_the_other_photos()
{
    mkdir -p fake; printf 'photo_1.jpg\nphoto_2.jpg\n' >two.txt
    cat >fake/colmap <<END
#!/bin/sh
case "\$*" in *init_image_id1*) ;; mapper*) set -- "\$@" --image_list_path $PWD/two.txt ;; esac
exec $(command -v colmap) "\$@"
END
    chmod +x fake/colmap
    rm -r out/t/sfm
    PATH=$PWD/fake:$PATH m sfm || { cat log; fail "make sfm"; }
    matches '2 of the 5 photos with verified matches are placed; mapping again' <out/t/log/sfm.all.log || fail "it did not start again"
    awk '/photos are placed/ && $2 == 5 { found = 1 } END { exit !found }' log || { cat log; fail "the other photos were not placed"; }
    rm -r out/t/sfm
    m sfm || { cat log; fail "make sfm without the change"; }
    [ -s out/t/log/sfm.all.log ] || fail "the log is missing"
    ! grep -q 'mapping again' out/t/log/sfm.all.log || fail "it started again though all photos were placed"
}

# a mapper that fails does not say how many photos match
a_number_that_is_not_known_is_not_stated()
{
    mkdir -p fails
    printf '#!/bin/sh\n[ "$1" != mapper ] || exit 1\nexec %s "$@"\n' "$(command -v colmap)" >fails/colmap
    chmod +x fails/colmap
    rm -r out/t/sfm
    if PATH=$PWD/fails:$PATH m sfm; then fail "make did not fail"; fi
    grep -q 'COLMAP placed none of the 5 photos. They may all be taken from one spot' log || { cat log; fail "wrong message"; }
}

# COLMAP alone drops every model of a small set that lacks a photo; a mask leaves photo_5 a few matches
a_photo_that_cannot_be_placed_costs_no_other()
{
    mkdir -p scenes/t/masks
    ffmpeg -v error -f lavfi -i color=black:s=160x120 -vf drawbox=x=40:y=40:w=50:h=40:color=white:t=fill -frames:v 1 -y scenes/t/masks/photo_5.png
    m sfm || { cat log; fail "make sfm"; }
    grep -q 'connected 5' out/t/sfm/colmap-3.log || fail "photo_5 has no verified matches"
    grep -q '4 of 5 photos are placed' log || { cat log; fail "the other photos were not placed"; }
    rm -r scenes/t/masks
}

for t in cameras_are_the_same_for_any_number_of_cores cameras_are_the_same_in_another_folder cameras_are_the_same_after_a_kill \
    a_photo_that_comes_and_goes_costs_its_own_pairs another_start_places_the_other_photos \
    a_number_that_is_not_known_is_not_stated a_photo_that_cannot_be_placed_costs_no_other; do run "$t"; done
