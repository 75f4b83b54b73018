# relit pages: pictures in the light of edits come onto both pages; films and given cameras; a second run makes nothing
. tests/lib.sh
project relit_pages
photos set >/dev/null
boxed t textures
printf 'remodel-script 1\n# A blue chest, in an empty room.\nbase bare\nbox chest from -4 6 to 4 12 top 3\ncolour box/chest 0.1 0.2 0.8\nmaterial box/chest ward 0.05 0.2\nlamp ceiling off\nclear hall\n' >scenes/t/edits/chest.txt
mkdir -p scenes/t/objects
printf 'v 0 0 0\nv 8 0 0\nv 8 8 0\nv 0 8 0\nv 4 4 8\nf 4 3 2 1\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n' >scenes/t/objects/tent.obj
printf 'remodel-script 1\n# The room as it is, with a tent in it.\nobject tent objects/tent.obj at -4 4 0 matt 0.6 0.2 0.1\n' >scenes/t/edits/tent.txt
printf '[bake_outdoors]\nheight = 64\n[plan_tour]\nwidth = 64\nheight = 48\nfps = 2\nspeed = 8\nclearance = 0.5\nhold = 0.5\n[update_vita]\nspacing = 0.1\nfinest = 0.05\nrays = 128\ntolerance = 0.05\n[relight]\ntarget_error = 0.2\nrays = 256\n' >>scenes/t/scene.cfg
m() { make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=t "$@" >log 2>&1 || { cat log; fail "make $*"; }; }
m remodel
O=out/t
view=$(ls $O/views/*.exr | sed -n 1p); view=$(basename "$view" .exr)
times() { find $O -type f -printf '%p %T@\n' | grep -vE '/log/|/.lock |/jobs/' | LC_ALL=C sort; }

make_relight_adds_the_light_to_the_page_of_edits()
{
    ! grep -q 'In the new light' $O/remodel/index.html || fail "the page shows what was not made"
    m relight RELIT_VIEWS="$view"
    [ -s "$O/relight/chest/$view.txt" ] && [ -s "$O/relight/bare/$view.txt" ] || fail "wanted the view after each edit"
    grep -q 'In the new light' $O/remodel/index.html || fail "the page of edits does not show the light"
    times >before
    m relight RELIT_VIEWS="$view"
    times | diff before - || fail "something was made again"
}

light_that_an_object_changes_is_shown()
{
    m relight RELIT_VIEWS="$view" EDIT=tent
    awk '$1 == "changed" { exit !($2 > 0) }' "$O/relight/tent/$view.txt" || fail "the tent changes no light"
    ! grep -q 'The light of no picture changes\|a relit picture is left out' $O/remodel/index.html || fail "the page does not show the light about an object"
}

plain_make_shows_it_on_both_pages()
{
    m all PRODUCTS="model remodel relight" RELIT_VIEWS="$view"
    grep -q 'In the new light' $O/index.html && grep -q 'Light of changes' $O/page/numbers.html || fail "the pages of the scene do not show the light"
    grep -q 'In the new light' $O/remodel/index.html || fail "the page of edits does not show the light"
    times >before
    m all PRODUCTS="model remodel relight" RELIT_VIEWS="$view"
    times | diff before - || fail "something was made again"
}

films_and_given_cameras_are_relit()
{
    mkdir -p cams
    cp $O/views/cameras.txt $O/views/images.txt cams/; : >cams/points3D.txt
    m relight EDIT=chest CAMERAS=cams
    grep -q "^picture $view\$" $O/relight/chest/cameras/pictures.txt || fail "no list of pictures"
    "$B/bin/verify" --file "$O/relight/chest/cameras/$view.exr" || fail "a picture is not whole"
    m relit-tour EDIT=chest
    [ -s $O/relight/chest/tour/video.mp4 ] || fail "there is no film"
    [ "$(ls $O/relight/chest/tour/frames/*.exr | wc -l)" = "$(grep -c '^frame ' $O/remodel/chest/tour/pairs.txt)" ] || fail "frames are missing"
    m relit-tour EDIT=chest
    ! grep -q relight log || { cat log; fail "frames were made again"; }
    "$B/bin/evaluate" --folder $O --shared $O --out metrics.tsv 2>err.txt || { cat err.txt; fail "evaluate"; }
    awk -F'\t' '$1 == "edited.chest.flicker95" { n++; bad += $2 > 5 } END { exit n != 1 || bad }' metrics.tsv || { grep flicker metrics.tsv; fail "the film flickers, or was not measured"; }
}

the_browser_compares_before_and_after()
{
    command -v node >/dev/null || skip "node is not installed (Debian: nodejs)"
    node -e "process.exit(require('$root/tests/browser/chromium.js').Chromium.find() ? 0 : 1)" || skip "chromium is not installed"
    node "$root/tests/browser/report_page.js" "$O" || fail "see above"
    local page
    for page in index.html page/numbers.html; do
        node "$root/tests/browser/access.js" "$PWD/$O/$page" "$PWD/profile" >said.txt 2>&1 || { cat said.txt; fail "the browser ended"; }
        cat said.txt
        ! grep -q '^not ok' said.txt || fail "$page: $(grep -m1 '^not ok' said.txt)"
    done
}

for t in make_relight_adds_the_light_to_the_page_of_edits light_that_an_object_changes_is_shown plain_make_shows_it_on_both_pages the_browser_compares_before_and_after films_and_given_cameras_are_relit; do run "$t"; done
