# make walk: the page to walk through the rooms of a small scene; its scripts without a browser; what the browser draws
. tests/lib.sh
project walk
photos set --views 4 --size 96x72 >/dev/null
boxed t textures
printf 'remodel-script 1\n# A blue chest, in an empty room.\nbase bare\nbox chest from -4 6 to 4 12 top 3\ncolour box/chest 0.1 0.2 0.8\n' >scenes/t/edits/chest.txt
printf '[bake_outdoors]\nheight = 32\n[plan_tour]\nwidth = 64\nheight = 48\nfps = 4\nspeed = 8\nclearance = 0.5\nhold = 0.25\n' >>scenes/t/scene.cfg
m() { make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=t "$@" >log 2>&1 || { cat log; fail "make $*"; }; }
O=out/t

the_page_and_its_data_are_made()
{
    m walk
    for f in index.html scene.js vita.js outdoors.js pictures.js; do [ -s $O/walk/$f ] || fail "there is no $O/walk/$f"; done
    [ "$(ls $O/walk/texture-*.js | wc -l)" = 4 ] && [ "$(ls $O/walk/photo-*.js | wc -l)" = 4 ] || fail "not every photo has its files"
    ! matches -E '<script src|<link' <$O/walk/index.html || fail "the page has parts outside of it"
    ! grep -rqF "$PWD" $O/walk || fail "a file names a folder of this machine"
    grep -qF 'A blue chest, in an empty room.' $O/walk/scene.js || fail "the page does not say what the edit is"
    find $O -type f -printf '%p %T@\n' | grep -vE '/log/|/.lock ' | LC_ALL=C sort >before
    m walk
    find $O -type f -printf '%p %T@\n' | grep -vE '/log/|/.lock ' | LC_ALL=C sort | diff before - || fail "a second make made something again"
}

bytes_do_not_depend_on_threads()
{
    local n words; words=$(grep -oE -- '--name .*' $O/graph/walk.mk | sed 's/--out .*//')
    for n in 1 2; do
        # shellcheck disable=SC2086 # words of a rule
        "$B/bin/walk" $words --config $O/slice/walk.cfg --threads $n --out two/$n 2>err.txt || { cat err.txt; fail "walk"; }
    done
    diff -rq two/1 two/2 || fail "one and two threads differ"
    diff -rq two/1 $O/walk || fail "the command alone makes something else"
}

a_damaged_atlas_leaves_the_page()
{
    local photo; photo=$(ls $O/vdta | sed -n 1p)
    cp -r $O/vdta/$photo kept; cp $O/walk/index.html page.html
    echo "viewpoint again" >>$O/vdta/$photo/atlas.txt
    ! make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=t walk >log 2>&1 || fail "the atlas was accepted"
    grep -q "atlas.txt:[0-9]*:" log || { cat log; fail "nothing names the line of the damaged atlas"; }
    cmp page.html $O/walk/index.html || fail "the page changed"
    rm -r "${O:?}/vdta/$photo"; cp -rp kept $O/vdta/$photo
}

scripts_are_right_without_a_browser()
{
    command -v node >/dev/null || skip "node is not installed (Debian: nodejs)"
    node "$root/tests/browser/walk_model.js" "$root/stages/walk/page" || fail "see above"
}

the_browser_draws_what_render_model_draws()
{
    command -v node >/dev/null || skip "node is not installed (Debian: nodejs)"
    node -e "process.exit(require('$root/tests/browser/chromium.js').Chromium.find() ? 0 : 1)" || skip "chromium is not installed"
    node "$root/tests/browser/walk_page.js" "$O/walk" || fail "see above"
    node "$root/tests/browser/access.js" "$PWD/$O/walk/index.html" "$PWD/profile" "document.getElementById('wait').hidden" >said.txt 2>&1 || { cat said.txt; fail "the browser ended"; }
    cat said.txt
    ! grep -q '^not ok' said.txt || fail "$(grep -m1 '^not ok' said.txt)"
}

for t in the_page_and_its_data_are_made bytes_do_not_depend_on_threads a_damaged_atlas_leaves_the_page \
    scripts_are_right_without_a_browser the_browser_draws_what_render_model_draws; do run "$t"; done
