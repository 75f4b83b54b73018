# judge_photos and make doctor: a sharp set passes, a blurred, a white, a dark and a stray photo are named
. tests/lib.sh
photos "$scratch/set" --views 6 --size 480x360 >/dev/null
cd "$scratch" || exit 1
export PATH=$root/$B/bin:$PATH
given=(--photos set/photos --records records --features features --matches matches)

# judge: the judgement of set/photos anew, in the file said
judge()
{
    rm -rf records features matches
    import_photos --photos set/photos --out records 2>err || { cat err; fail "import"; }
    local p all
    all=$(sed -n 's/^\([^# ][^ ]*\) .*/\1/p' records/list.txt | grep photo)
    for p in $all; do extract_features --photos set/photos --records records --photo "$p" --out "features/$p.txt" 2>err || { cat err; fail "features"; }; done
    choose_pairs --records records --features features --out pairs.txt 2>err || { cat err; fail "pairs"; }
    for p in $all; do match_photos --pairs pairs.txt --features features --photo "$p" --out "matches/$p.txt" 2>err || { cat err; fail "matches"; }; done
    judge_photos "${given[@]}" --out judgement.txt 2>said || { cat said; fail "judge_photos"; }
}
# change PHOTO FILTER: by ffmpeg
change() { cp "set/photos/$1.jpg" "keep.$1.jpg"; ffmpeg -loglevel error -y -i "keep.$1.jpg" -vf "$2" -q:v 2 "set/photos/$1.jpg" || fail "ffmpeg"; }

a_good_set_has_no_warnings()
{
    judge
    ! grep warning said || fail "a warning about a good photo"
    grep -q '6 photos that overlap give a film with parallax (make video); 8 to 15 give a better one' said || { cat said; fail "no advice"; }
    grep -q 'EXIF does not state the lens' said || { cat said; fail "nothing about the lens"; }
    [ "$(grep -c '^photo photo_[1-6] 480 360 ' judgement.txt)" = 6 ] || { cat judgement.txt; fail "no row for each photo"; }
}

a_blurred_photo_is_named()
{
    change photo_2 gblur=sigma=3
    judge
    grep -q 'warning: photo_2 is blurred: its sharper edges are [4-9.]* px wide, those of the middle photo [12.]' said || { cat said judgement.txt; fail "it is not named"; }
    [ "$(grep -c 'is blurred' said)" = 1 ] || { cat said; fail "others are named"; }
    grep -q '^warn photo_2 "is blurred' judgement.txt || fail "the file does not say it"
    mv keep.photo_2.jpg set/photos/photo_2.jpg
}

white_and_dark_photos_are_named()
{
    change photo_1 'format=rgb24,lutrgb=r=min(255\,val*6):g=min(255\,val*6):b=min(255\,val*6)'
    change photo_3 'lutyuv=y=val*0.02'
    judge
    grep -q 'warning: photo_1 is too bright: [0-9]* % of it is white' said || { cat said judgement.txt; fail "the bright one is not named"; }
    grep -q 'warning: photo_3 is too dark' said || { cat said judgement.txt; fail "the dark one is not named"; }
    for p in photo_1 photo_3; do mv keep.$p.jpg set/photos/$p.jpg; done
}

a_photo_of_something_else_is_named()
{
    cp set/photos/photo_6.jpg keep.jpg
    ffmpeg -loglevel error -y -f lavfi -i mandelbrot=size=480x360 -frames:v 1 set/photos/photo_6.jpg || fail "ffmpeg"
    judge
    grep -Eq 'warning: photo_6 (overlaps no other photo|has [0-9]* features)' said || { cat said; fail "it is not named"; }
    grep -q '5 of 6 photos overlap as one group' said || { cat said; fail "the groups are not counted"; }
    mv keep.jpg set/photos/photo_6.jpg
}

the_same_bytes_for_any_number_of_threads()
{
    judge
    for n in 1 3; do judge_photos "${given[@]}" --out t$n.txt --threads $n 2>/dev/null || fail "threads $n"; done
    cmp t1.txt t3.txt || fail "other bytes"
}

one_command_looks_at_machine_and_photos()
{
    cp -r set "$scratch/kept"
    project doctor
    mkdir scenes/d; : >scenes/d/scene.cfg
    make -s DEPS=manual SCENE=d PHOTOS="$scratch/kept/photos" doctor >log 2>&1 || { cat log; fail "make doctor"; }
    grep -q '6 photos that overlap' log && grep -q '^ok    COLMAP' log && grep -q '^list   out/d/judgement.txt' log || { cat log; fail "something is not said"; }
    grep -Eq '^ok    a film of these 6 photos takes about [0-9]+ s to [0-9]+ (s|min) on [0-9]+ cores?, [0-9]+ MiB of memory and [0-9]+ MiB of disk$' log || { cat log; fail "it does not say what a film takes"; }
    grep -q '^ok    make plan SCENE=d says more' log || { cat log; fail "make plan is not named"; }
    [ ! -e out/d/sfm ] || fail "it went on to poses"
    make -s DEPS=manual doctor >log 2>&1 || { cat log; fail "make doctor without a scene"; }
    ! grep judge log || fail "photos without a scene"
    # photos whose cameras are given are not matched, so that nothing judges them
    photos given --views 3 --size 64x48 >/dev/null
    make -s DEPS=manual SCENE=g PHOTOS=given/photos SFM=given/model doctor >log 2>&1 || { cat log; fail "make doctor with given cameras"; }
    grep -q '^note  the cameras are given' log && ! grep -q judgement log || { cat log; fail "it names a list that was not made"; }
}

# two panoramas that overlap: twelve views of two places
panoramas_are_places()
{
    mkdir -p pano/features pano/matches pano/records pano/photos
    local p k other
    ffmpeg -loglevel error -y -f lavfi -i testsrc2=size=512x256 -frames:v 1 pano/photos/a.png || fail "ffmpeg"
    ffmpeg -loglevel error -y -f lavfi -i testsrc=size=512x256 -frames:v 1 pano/photos/b.png || fail "ffmpeg"
    import_photos --photos pano/photos --frames pano/frames --out pano/records --set panoramas=yes 2>err || { cat err; fail "import"; }
    for p in $(cut -d' ' -f1 pano/records/list.txt); do extract_features --photos pano/frames --records pano/records --photo "$p" --out "pano/features/$p.txt" 2>err || { cat err; fail "features"; }; done
    choose_pairs --records pano/records --features pano/features --out pano/pairs.txt 2>err || { cat err; fail "pairs"; }
    for p in $(cut -d' ' -f1 pano/records/list.txt); do match_photos --pairs pano/pairs.txt --features pano/features --photo "$p" --out "pano/matches/$p.txt" 2>err || { cat err; fail "matches"; }; done
    judge_photos --photos pano/frames --records pano/records --features pano/features --matches pano/matches --out pano/j.txt 2>said || { cat said; fail "judge_photos"; }
    grep -q 'The lens of 12 views of panoramas is known' said || { cat said; fail "the lens is taken as unknown"; }
    ! grep -q 'EXIF does not state' said || { cat said; fail "a lens is missed"; }
    [ "$(grep -c 'a_yaw000 and the other views of its panorama overlap no other photo' said)" = 1 ] || { cat said; fail "a panorama apart is not named"; }
    [ "$(grep -c "warning: .*overlap" said)" = 2 ] || { cat said; fail "other warnings"; }
}

for t in a_good_set_has_no_warnings a_blurred_photo_is_named white_and_dark_photos_are_named a_photo_of_something_else_is_named \
    the_same_bytes_for_any_number_of_threads panoramas_are_places one_command_looks_at_machine_and_photos; do run "$t"; done
