# draw_model: build_model as WebAssembly makes the same bytes as the program; the page is drawn in by a headless browser. What the
# page's goal needs is installed only when it is asked for, so these tests skip where it is absent.
. tests/lib.sh
project draw
made=
node "$root/tests/browser/room.js" room 2>/dev/null && made=yes
mkdir -p scenes/room/edits

# why the tests cannot run here
absent()
{
    command -v node >/dev/null || { echo "node is absent"; return; }
    bash common/run/deps.sh manual draw >/dev/null 2>&1 || echo "what make draw builds with is absent (clang, lld, wasi-libc)"
}
wasm() # builds it, once
{
    local why; why=$(absent)
    [ -z "$why" ] || skip "$why"
    [ -n "$made" ] || fail "the room was not made"
    (cd "$root" && make -s PHASE=build DEPS=manual SCENES= FLAVOR="$FLAVOR" -j2 wasm-build) >log 2>&1 || { cat log; fail "make wasm-build"; }
}
page()
{
    local texts=${1:-scenes/room}
    "$B/bin/draw_model" "${@:2}" --name room --scene "$texts" --views room/views --axes room/model/axes.txt --points room/points/points.ply \
        --lines room/lines --photos room/photos --records room/records --wasm "$B/wasm/build_model.wasm" --page stages/draw_model/page \
        --out page 2>err.txt || { cat err.txt; fail "draw"; }
}

the_module_makes_the_bytes_of_the_program()
{
    wasm
    printf '%s\n' 'remodel-script 1' 'wall south in p0 200 120 440 300' 'wall east in p1 200 120 440 300' 'wall north foot in p2 102.5 365.25 531 366' \
        'wall west in p3 200.5 120 440 300.25' 'join south east north west south' 'room main south east north west' \
        'window sunny on north in p2 150.5 110 420.25 280' 'box chest in p0 301.5 380 402 430.5 top 0.8' >scenes/room/model.txt
    printf 'remodel-script 1\nresize sunny left 0.2\ncolour box/chest 0.2 0.3 0.4\nmove east by 0.5\n' >scenes/room/edits/wide.txt
    printf 'remodel-script 1\nremove sunny\nclear main\n' >scenes/room/edits/bare.txt
    printf 'remodel-script 1\nresize sunny left 9\n' >scenes/room/edits/far.txt
    node "$root/tests/browser/live_model.js" "$B/wasm/build_model.wasm" room scenes/room || fail "the module does not run"
    local e count=0
    for e in model wide bare far; do
        local edit=(); [ "$e" = model ] || edit=(--edit "scenes/room/edits/$e.txt" --scene scenes/room --base native/model/model.txt)
        if ! "$B/bin/build_model" --script scenes/room/model.txt --axes room/model/axes.txt --views room/views --points room/points/points.ply \
            "${edit[@]}" --out "native/$e" 2>err.txt; then
            grep -qxF "build_model: error: $(cat "room/live/$e/refused.txt")" err.txt || { cat err.txt "room/live/$e/refused.txt"; fail "$e is refused in other words"; }
            count=$((count + 1)); continue
        fi
        same_model "native/$e" "room/live/$e"
    done
    [ $count = 17 ] || fail "compared $count files, wanted 17"
}

inputs_that_are_missing_are_named()
{
    wasm
    rm -rf page
    local rc=0
    "$B/bin/draw_model" "${@:2}" --name room --scene scenes/room --views room/views --axes room/model/axes.txt --photos room/photos --records room/records \
        --wasm nowhere.wasm --page stages/draw_model/page --out page 2>err.txt || rc=$?
    [ $rc = 1 ] && grep -q 'nowhere.wasm is missing.*run make draw' err.txt || { cat err.txt; fail "exit $rc"; }
    [ ! -e page/index.html ] || fail "a page was left"
}

verdicts()
{
    cat said.txt
    grep -q '^ok the_console_has_no_error' said.txt || fail "$(grep -m1 '^not ok' said.txt || echo "the tests did not end")"
    ! grep -q '^not ok' said.txt || fail "$(grep -m1 '^not ok' said.txt)"
}

# Points of the page, as points.js has them, against the file: within half of a step, normals within a degree.
points_are_small_and_near_their_places()
{
    wasm
    page scenes/room
    node "$root/tests/browser/points.js" page room/points/points.ply >said.txt 2>&1 || { cat said.txt; fail "the points differ"; }
    cat said.txt
    page scenes/room --set max_points=1000
    node "$root/tests/browser/points.js" page room/points/points.ply 1000 >said.txt 2>&1 || { cat said.txt; fail "the thinned points differ"; }
}

the_page_is_drawn_in()
{
    wasm
    command -v chromium >/dev/null || skip "chromium is absent"
    mkdir -p empty; page empty
    timeout 100 node "$root/tests/browser/draw.js" "$PWD/page" the_room_is_drawn_from_nothing keys_draw_as_the_pointer_does >said.txt 2>&1 || { cat said.txt; fail "the browser ended"; }
    verdicts
    timeout 100 node "$root/tests/browser/draw_marks.js" "$PWD/page" the_draft_shows_the_edited_room what_is_saved_is_in_the_folder >said.txt 2>&1 || { cat said.txt; fail "the browser ended"; }
    verdicts
    timeout 100 node "$root/tests/browser/draw_pictures.js" "$PWD/page" >said.txt 2>&1 || { cat said.txt; fail "the browser ended"; }
    verdicts
    node "$root/tests/browser/access.js" "$PWD/page/index.html" "$PWD/profile" app.ready >said.txt 2>&1 || { cat said.txt; fail "the browser ended"; }
    cat said.txt
    ! grep -q '^not ok' said.txt || fail "$(grep -m1 '^not ok' said.txt)"
}

for t in the_module_makes_the_bytes_of_the_program inputs_that_are_missing_are_named points_are_small_and_near_their_places the_page_is_drawn_in; do run $t; done
