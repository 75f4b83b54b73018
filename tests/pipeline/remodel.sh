# PRODUCTS = remodel: plain make draws the edits and their page, in the scene's settings or on the command line
. tests/lib.sh
project remodel
photos set --views 4 --size 96x72 >/dev/null
# room SCENE PRODUCTS: an empty room, and one edit, which puts a chest into it
room()
{
    boxed "$1" "$2"
    rm "scenes/$1/edits/bare.txt"
    printf '[bake_outdoors]\nheight = 32\n' >>"scenes/$1/scene.cfg"
    printf 'remodel-script 1\n# A blue chest.\nbox chest from -4 6 to 4 12 top 3\ncolour box/chest 0.1 0.2 0.8\n' >"scenes/$1/edits/chest.txt"
}
m() { make -s DEPS=manual SFM=set/model "$@" >log 2>&1 || { cat log; fail "make $*"; }; }
# linked PAGE ADDRESS: PAGE links to ADDRESS, which exists
linked()
{
    grep -qF "<a href=\"$2\">" "$1" || fail "$1 does not link to $2"
    [ -s "${1%/*}/$2" ] || fail "there is no ${1%/*}/$2"
}

a_scene_of_edits_has_their_pictures_and_pages()
{
    room t remodel
    m SCENE=t
    local v
    for v in out/t/views/*.exr; do
        v=${v##*/}; [ -s "out/t/remodel/chest/pictures/${v%.exr}.txt" ] || fail "there is no picture of ${v%.exr} after the edit"
    done
    grep -lqE '^changed ([1-9]|0\.[0-9]*[1-9])' out/t/remodel/chest/pictures/*.txt || fail "the edit changes no view"
    grep -q 'A blue chest.' out/t/remodel/index.html && grep -q 'class="ba"' out/t/remodel/index.html || fail "the page does not show the edit"
    linked out/t/index.html remodel/index.html
    linked out/t/remodel/index.html ../index.html
    [ -z "$(find out/t -name '*.mp4')" ] || fail "a film was made, too"
    find out/t \( -name '*.html' -o -path '*/pictures/*' \) -printf '%p %T@\n' | LC_ALL=C sort >before
    m SCENE=t
    find out/t \( -name '*.html' -o -path '*/pictures/*' \) -printf '%p %T@\n' | LC_ALL=C sort | diff before - || fail "a second make made something again"
}

# a scene of other products: make remodel makes the page of edits alone, which then has nothing to link to
the_command_line_asks_for_edits()
{
    room u model
    m SCENE=u remodel
    [ ! -e out/u/index.html ] || fail "the page of the scene was made, too"
    [ -s out/u/remodel/index.html ] || fail "there is no page"
    ! grep -q '\.\./index.html' out/u/remodel/index.html || fail "the page links to one that does not exist"
    m SCENE=u PRODUCTS=remodel
    linked out/u/index.html remodel/index.html
    linked out/u/remodel/index.html ../index.html
}

for t in a_scene_of_edits_has_their_pictures_and_pages the_command_line_asks_for_edits; do run "$t"; done
