# built without AVX2, the operations on vectors keep their rules, and the stages of a film make the same bytes
. tests/lib.sh
portable=out/build/portable
build()
{
    make -C "$root" -s DEPS=manual FLAVOR=portable PHASE=build -j"$(nproc)" "$@" >"$scratch/build.log" 2>&1 || { tail -n 20 "$scratch/build.log"; fail "the build without AVX2"; }
}

the_operations_keep_their_rules()
{
    build $portable/tests/unit/common/math/lanes
    $portable/tests/unit/common/math/lanes 2>&1 || fail "see above"
}

# made BUILD FOLDER: a photo's view, its depth map, and frames of a film, by the programs of BUILD
made()
{
    local o=out/t f; mkdir -p "$2/views" "$2/depth" "$2/fast" "$2/offline"
    {
        "$1/bin/rectify" --config $o/slice/rectify.cfg --photo photo_2 --photos set/photos --records $o/photos --views $o/views --out "$2/views" &&
            "$1/bin/segment_depth" --config $o/slice/segment_depth.cfg --view photo_2 --views $o/views --records $o/photos --before $o/depth/round0 --out "$2/depth/photo_2.exr" &&
            for f in fast offline; do
                "$1/bin/render_views" --set renderer=$f --views $o/views --depth $o/depth --path $o/parallax/establishing_dolly --frames 1:3 --out "$2/$f" || fail "render_views of $2"
            done
    } 2>err.txt || { cat err.txt; fail "a stage of $2"; }
}

the_stages_of_a_film_make_the_same_bytes()
{
    build $portable/bin/rectify $portable/bin/segment_depth $portable/bin/render_views
    [ "$(uname -m)" != x86_64 ] || ! objdump -d $portable/bin/segment_depth | matches '%ymm' || fail "segment_depth still uses AVX"
    project portable; photos set >/dev/null
    tiny t; sed -i 's/^rounds = 0/rounds = 1/' scenes/t/scene.cfg
    make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=t frames >log 2>&1 || { cat log; fail "make frames"; }
    made "$root/$portable" portable
    made "$root/$B" "${B##*/}"
    diff -r portable "${B##*/}" || fail "other bytes without AVX2"
    [ "$(find portable -name '*.exr' | wc -l)" = 8 ] || fail "$(find portable -name '*.exr' | wc -l) pictures, wanted 8"
}

for t in the_operations_keep_their_rules the_stages_of_a_film_make_the_same_bytes; do run "$t"; done
