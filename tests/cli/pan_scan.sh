# pan_scan: bad arguments and unusable views; any split of the frames gives the same bytes; make pan_scan
. tests/lib.sh
project pan
photos set --views 3 --size 160x120 >/dev/null
small t
sed -i 's/^planes = .*/planes = 32\nrounds = 0/; s/^seconds = .*/seconds = 0.5/; s/^max_side = .*/max_side = 96/' scenes/t/scene.cfg
make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=t path >log 2>&1 || { cat log; fail "make"; }
move=out/t/parallax/establishing_dolly

# pan CODE WORD ARGUMENT...: runs pan_scan; checks exit status, a word on standard error, and that a failure leaves no file
pan()
{
    local code=$1 word=$2 rc=0; shift 2
    rm -rf made
    "$B/bin/pan_scan" --views "${views:-out/t/views}" --path "${path:-$move}" --frames "${frames:-1}" --out made "$@" >out.txt 2>err.txt </dev/null || rc=$?
    [ "$rc" = "$code" ] || { cat err.txt; fail "$*: exit $rc, wanted $code"; }
    grep -qF -- "$word" err.txt || { cat err.txt; fail "$*: nothing says '$word'"; }
    [ "$code" = 0 ] || grep -q 'pan_scan: error: .*[.]$' err.txt || { cat err.txt; fail "$*: no sentence"; }
    [ "$code" = 0 ] || [ -z "$(find made -type f 2>/dev/null)" ] || fail "$*: a frame was left"
}

bad_arguments_are_refused_with_a_sentence()
{
    frames=0 pan 2 'wanted frame numbers'
    frames=1:999 pan 2 'wanted frame numbers'
    pan 2 'has no view of this name; its first is photo_' --view nobody
    pan 2 tolerance --set tolerance=0
}

unreadable_files_are_named()
{
    pan 1 nowhere --depth nowhere
    rm -rf bad; cp -r out/t/views bad
    rm bad/photo_2.exr
    views=bad pan 1 bad/photo_2.exr --view photo_2
    head -c 500 out/t/views/photo_2.exr >bad/photo_2.exr
    views=bad pan 1 bad/photo_2.exr --view photo_2
    rm -rf bad; cp -r $move bad
    sed -i '/^2 PINHOLE/s/PINHOLE \([0-9]* [0-9]*\) [^ ]*/PINHOLE \1 0/' bad/path/cameras.txt
    path=bad pan 1 focal
    grep -qE 'bad/path(/|\.txt).*:[0-9]+: ' err.txt || { cat err.txt; fail "no file and line"; }
}

depth_maps_replace_missing_points()
{
    rm -rf bad; cp -r out/t/views bad
    : >bad/points3D.txt
    sed -i -E '/^[0-9]+ .*\.exr$/!{/^#/!s/.*//}' bad/images.txt
    views=bad pan 1 'points to fit a crop to'
    views=bad pan 0 'the first frame shows' --depth out/t/depth
}

# for any number of threads
ranges_give_the_same_bytes()
{
    n=$(awk '$1 == "frames" { print $2 }' $move/path.txt)
    [ "$n" -ge 3 ] || fail "$n frames"
    frames=1:$n pan 0 '' --depth out/t/depth; (cd made && sha256sum -- *.exr) >whole.txt
    [ "$(wc -l <whole.txt)" = "$n" ] || fail "not $n frames"
    rm -rf parts; mkdir parts
    frames=2:$n pan 0 '' --depth out/t/depth --threads=1; mv made/*.exr parts/
    frames=1 pan 0 '' --depth out/t/depth; mv made/*.exr parts/
    (cd parts && sha256sum -- *.exr) | cmp - whole.txt || fail "the bytes differ"
}

a_crop_at_the_border_of_the_photograph_causes_a_warning()
{
    rm -rf bad; cp -r $move bad # first camera far to the side
    sed -i -E 's/^(1 [^ ]* [^ ]* [^ ]* [^ ]*) ([^ ]*) (.* 0001\.exr)$/\1 -2.5 \3/' bad/path/images.txt
    path=bad pan 0 'held at the border of view' --depth out/t/depth
    "$B/bin/verify" --file made/0001.exr || fail "no frame"
}

# make pan_scan builds its inputs too, the page shows the result from then on, and a second run does nothing
make_builds_it_and_the_page_shows_it()
{
    make -s DEPS=manual SCENE=t pan_scan >log 2>&1 || { cat log; fail "make pan_scan"; }
    grep -q 'video  out/t/parallax/establishing_dolly/pan_scan/video.mp4' log || { cat log; fail "the run does not end with the video's path"; }
    n=$(ffprobe -v error -count_frames -select_streams v -show_entries stream=nb_read_frames -of csv=p=0 $move/pan_scan/video.mp4)
    [ "$n" = "$(ls $move/pan_scan/frames | wc -l)" ] || fail "$n frames in the video"
    [ ! -e $move/frames ] || fail "it rendered the move itself"
    make -s DEPS=manual SCENE=t >log 2>&1 || { cat log; fail "make"; }
    grep -q 'the same move in 2D' out/t/page/numbers.html || fail "the page does not show it"
    grep -q 'Pan and zoom over one photograph' out/t/page/numbers.html || fail "the page has no video of it"
    snapshot out/t >a
    make -s DEPS=manual SCENE=t >log 2>&1 || { cat log; fail "make again"; }
    snapshot out/t >b
    cmp a b || { changed a b; fail "a second make did something"; }
    # another view changes the 2D frames, their video and the page
    printf '[pan_scan]\nview = photo_1\n' >>scenes/t/scene.cfg
    make -s DEPS=manual SCENE=t >log 2>&1 || { cat log; fail "make with another view"; }
    snapshot out/t >c
    changed b c | grep -vE '^(index.html|parallax/establishing_dolly/pan_scan/(video.mp4|frames/[0-9]*.exr))$' && fail "more was made again"
    [ "$(changed b c | wc -l)" = $((n + 2)) ] || { changed b c; fail "not everything was made again"; }
    grep -q '<code>photo_1</code>' out/t/page/numbers.html || fail "the page shows another view"
}

for t in bad_arguments_are_refused_with_a_sentence unreadable_files_are_named depth_maps_replace_missing_points ranges_give_the_same_bytes \
    a_crop_at_the_border_of_the_photograph_causes_a_warning make_builds_it_and_the_page_shows_it; do run "$t"; done
