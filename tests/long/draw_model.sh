# draw_model, at length: all tests of the page in the room of tests/browser/room.js; the model of loft, drawn from nothing, against
# the truth, where that scene was made (make SCENE=loft QUALITY=draft)
. tests/lib.sh
loft=$root/out/loft+draft
project draw

absent()
{
    command -v node >/dev/null || { echo "node is absent"; return; }
    command -v chromium >/dev/null || { echo "chromium is absent"; return; }
    bash common/run/deps.sh manual draw >/dev/null 2>&1 || echo "what make draw builds with is absent (clang, lld, wasi-libc)"
}
wasm()
{
    local why; why=$(absent)
    [ -z "$why" ] || skip "$why"
    (cd "$root" && make -s PHASE=build DEPS=manual SCENES= FLAVOR="$FLAVOR" -j2 wasm-build) >log 2>&1 || { cat log; fail "make wasm-build"; }
}
verdicts() { cat said.txt; ! grep -q '^not ok' said.txt || fail "$(grep -m1 '^not ok' said.txt)"; grep -q '^ok' said.txt || fail "the browser ended"; }

a_room_is_drawn_in_all_ways()
{
    wasm
    mkdir -p empty
    node "$root/tests/browser/room.js" room
    "$B/bin/draw_model" --name room --scene empty --views room/views --axes room/model/axes.txt --points room/points/points.ply --lines room/lines \
        --photos room/photos --records room/records --wasm "$B/wasm/build_model.wasm" --page stages/draw_model/page --out page
    local part
    for part in draw draw_marks draw_refusals; do
        node "$root/tests/browser/$part.js" "$PWD/page" >said.txt 2>&1 || { cat said.txt; fail "the browser ended"; }
        verdicts
    done
}

# without a scale, a ceiling and points: what is refused, and offered
a_room_without_a_scale_is_drawn()
{
    wasm
    mkdir -p empty
    node "$root/tests/browser/room.js" bare bare
    "$B/bin/draw_model" --name bare --scene empty --views bare/views --axes bare/model/axes.txt --lines bare/lines \
        --photos bare/photos --records bare/records --wasm "$B/wasm/build_model.wasm" --page stages/draw_model/page --out barepage
    node "$root/tests/browser/draw_bare.js" "$PWD/barepage" >said.txt 2>&1 || { cat said.txt; fail "the browser ended"; }
    verdicts
}

loft_is_drawn_from_nothing()
{
    wasm
    [ -e "$loft/points/points.ply" ] || skip "out/loft+draft has no points; run make SCENE=loft QUALITY=draft"
    mkdir -p empty
    "$B/bin/draw_model" --name loft --scene empty --views "$loft/views" --axes "$loft/model/axes.txt" --points "$loft/points/points.ply" --lines "$loft/lines" \
        --photos "${loft%+draft}/hdr" --records "${loft%+draft}/photos" --wasm "$B/wasm/build_model.wasm" --page stages/draw_model/page --out page
    node "$root/tests/browser/draw_loft.js" "$PWD/page" "$root/scenes/loft/model.txt" "$root/scenes/loft/scene.txt" >said.txt 2>&1 || { cat said.txt; fail "the browser ended"; }
    verdicts
}

furniture_of_loft_has_its_surfaces()
{
    wasm
    [ -e "$loft/things/volume.exr" ] || skip "out/loft+draft has no furniture; run make SCENE=loft QUALITY=draft things"
    mkdir -p empty
    "$B/bin/draw_model" --name loft --scene empty --views "$loft/views" --axes "$loft/model/axes.txt" --things "$loft/things" \
        --photos "${loft%+draft}/hdr" --records "${loft%+draft}/photos" --wasm "$B/wasm/build_model.wasm" --page stages/draw_model/page --out page
    node "$root/tests/browser/shapes.js" page "$loft/things/things.txt" >said.txt 2>&1 || { cat said.txt; fail "the surfaces are not those of the things"; }
    cat said.txt
}

the_module_makes_the_bytes_of_loft_and_its_edits()
{
    wasm
    [ -e "$loft/points/points.ply" ] || skip "out/loft+draft has no points; run make SCENE=loft QUALITY=draft"
    mkdir -p of/views of/model of/points made
    cp "$loft"/views/*.txt of/views/; cp "$loft/model/axes.txt" of/model/; ln -s "$loft/points/points.ply" of/points/
    ln -s "$root/scenes/loft" scenes/loft
    node "$root/tests/browser/live_model.js" "$B/wasm/build_model.wasm" of scenes/loft || fail "the module does not run"
    local e edit count=0
    for e in model $(basename -s .txt scenes/loft/edits/*.txt); do
        edit=(); [ "$e" = model ] || edit=(--edit "scenes/loft/edits/$e.txt" --scene scenes/loft --base made/model/model.txt)
        "$B/bin/build_model" --script scenes/loft/model.txt --things scenes/loft/things.txt --axes of/model/axes.txt --views of/views --points of/points/points.ply \
            "${edit[@]}" --out "made/$e" 2>err.txt || { cat err.txt; fail "$e"; }
        same_model "made/$e" "of/live/$e"
    done
    [ $count = 64 ] || fail "compared $count files, wanted 64: 4 of the model, 6 of each of ten edits"
}

make_draw_makes_the_page_and_follows_what_people_write()
{
    wasm
    photos set --views 6 --size 320x240 >/dev/null
    mkdir -p scenes/t
    printf '[segment_depth]\nplanes = 48\npasses = 1\nrounds = 0\nneighbours = 3\n' >scenes/t/scene.cfg
    make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=t draw >log 2>&1 || { cat log; fail "make draw"; }
    [ -s out/t/draw/index.html ] && [ -s out/t/draw/points.js ] || fail "files are missing"
    [ "$(ls out/t/draw/photos/*.js | wc -l)" = 6 ] || fail "photos are missing"
    make -s DEPS=manual SCENE=t draw >log 2>&1; touch before
    make -s DEPS=manual SCENE=t draw >log 2>&1 || { cat log; fail "make draw again"; }
    [ ! out/t/draw/index.html -nt before ] || fail "the page was made again"
    printf 'remodel-script 1\nbox b from 0 0 to 1 1 top 1\n' >scenes/t/model.txt
    make -s DEPS=manual SCENE=t draw >log 2>&1 || { cat log; fail "make draw after model.txt"; }
    grep -q 'box b from 0 0' out/t/draw/scene.js || fail "model.txt is not in the page"
}

for t in make_draw_makes_the_page_and_follows_what_people_write a_room_is_drawn_in_all_ways a_room_without_a_scale_is_drawn loft_is_drawn_from_nothing furniture_of_loft_has_its_surfaces the_module_makes_the_bytes_of_loft_and_its_edits; do run $t; done
