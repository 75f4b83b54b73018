# what a first command writes for a new scene, and what it says; no stage runs
. tests/lib.sh
project new
mkdir photos
first() { env REMODEL_PHOTOS=photos REMODEL_PASSED='PHOTOS EXCLUDE SFM' REMODEL_PRODUCTS="${PRODUCTS-parallax}" "$@"; }
refused() # WORDS ARGUMENT...
{
    local words=$1 rc=0; shift
    make -s DEPS=manual "$@" >log 2>&1 || rc=$?
    [ "$rc" != 0 ] && grep -qF -- "$words" log || { cat log; fail "make $*: exit $rc, nothing says '$words'"; }
}

the_first_command_names_the_lens()
{
    first REMODEL_LENS=EQUISOLID common/run/new_scene.sh scenes/fish axes >/dev/null
    sed -n 1,2p scenes/fish/scene.cfg | diff - <(printf '[sfm]\ncamera_model = EQUISOLID\n')
    "$B/bin/sfm" --print-config --config scenes/fish/scene.cfg | matches '^camera_model = EQUISOLID$' || fail "sfm does not read the lens"
    first common/run/new_scene.sh scenes/plain axes >/dev/null
    ! grep -q '^[^#]' scenes/plain/scene.cfg || { cat scenes/plain/scene.cfg; fail "a scene without a lens has settings"; }
    refused 'LENS=OPENCV is for a new scene, but scenes/fish/scene.cfg exists' axes SCENE=fish LENS=OPENCV
    refused 'LENS=fish eye: wanted a camera model' axes SCENE=fish 'LENS=fish eye'
    make -s DEPS=manual axes PHOTOS=photos SCENE=other LENS=EQUISOLID -n >log 2>&1 || { cat log; fail "make -n of a new scene"; }
    grep -q 'would create scenes/other/scene.mk and scene.cfg' log || { cat log; fail "nothing says what would be created"; }
}

messages_name_the_quality()
{
    mkdir -p scenes/room
    printf 'PHOTOS := photos\n' >scenes/room/scene.mk
    refused 'make suggest SCENE=room QUALITY=draft writes a first one, out/room+draft/model/suggested.txt' model SCENE=room QUALITY=draft
    refused 'make suggest SCENE=room writes a first one, out/room/model/suggested.txt' model SCENE=room
    refused 'make PHOTOS=DIR SCENE=none QUALITY=draft' depth SCENE=none QUALITY=draft
}

nothing_is_created_for_what_cannot_be_photos()
{
    : >set.zip; : >one.JPG
    refused 'PHOTOS=set.zip is an archive. Unpack it' PHOTOS=set.zip SCENE=wrong
    refused 'PHOTOS=one.JPG is one photo. Give the folder' PHOTOS=one.JPG SCENE=wrong
    [ ! -e scenes/wrong ] || fail "a scene was created"
}

plain_make_of_a_room_makes_its_products()
{
    local goal
    for goal in axes suggest model relight; do
        rm -rf scenes/room
        first common/run/new_scene.sh scenes/room $goal >/dev/null
        grep -qx 'PRODUCTS := model textures remodel tour relight' scenes/room/scene.mk || { cat scenes/room/scene.mk; fail "a room that began with make $goal has other products"; }
    done
    for goal in all report frames depth points; do
        rm -rf scenes/room
        first common/run/new_scene.sh scenes/room $goal >/dev/null
        grep -qx 'PRODUCTS := parallax' scenes/room/scene.mk || { cat scenes/room/scene.mk; fail "a scene that began with make $goal has other products"; }
    done
    PRODUCTS='model remodel' first common/run/new_scene.sh scenes/room axes >/dev/null
    grep -qx 'PRODUCTS := model remodel' scenes/room/scene.mk || fail "products that were given are not kept"
}

for t in plain_make_of_a_room_makes_its_products the_first_command_names_the_lens messages_name_the_quality nothing_is_created_for_what_cannot_be_photos; do run "$t"; done
