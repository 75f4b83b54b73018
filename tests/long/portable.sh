# everything built without AVX2 makes the same products: films, a morph, a modelled room and its edit
. tests/lib.sh

everything_is_built_without_avx2()
{
    make -s DEPS=manual FLAVOR=portable PHASE=build -j"$(nproc)" build >"$scratch/log" 2>&1 || { tail -n 20 "$scratch/log"; fail "the build without AVX2"; }
}

# made FLAVOR: all products, in a project of that name
made()
{
    project "$1"; photos set >/dev/null
    mkdir pair; cp set/photos/photo_[23].jpg pair/
    tiny film; sed -i 's/^renderer = fast/renderer = offline/' scenes/film/scene.cfg
    echo 'subject photo_2 76 58 108 94' >scenes/film/subjects.txt
    tiny pair; printf '[morph_views]\nseconds = 0.1\nmax_side = 96\n' >>scenes/pair/scene.cfg
    boxed room 'model textures remodel relight'
    printf '[bake_outdoors]\nheight = 64\n[update_vita]\nspacing = 0.1\nfinest = 0.05\nrays = 128\ntolerance = 0.05\n[relight]\ntarget_error = 0.2\nrays = 256\n' >>scenes/room/scene.cfg
    m() { make -s DEPS=manual FLAVOR="$f" "$@" >log 2>&1 || { cat log; fail "make $* FLAVOR=$f"; }; }
    local f=$1
    m SCENE=film PHOTOS=set/photos SFM=set/model EFFECT='establishing_dolly dolly_in dolly_in+narrow_dof dolly_in+dim'
    m SCENE=pair PHOTOS=pair SFM=
    m SCENE=room PHOTOS=set/photos SFM=set/model EDIT=bare RELIT_VIEWS=photo_1
}

all_products_are_the_same()
{
    (made release) && (made portable) || exit 1
    cd "$scratch" || exit 1
    # the graph names the programs of its build, and sfm_points.txt has a second line with the checksum of one
    diff -rq -x build -x graph -x log -x '*.html' -x '.*' -x sfm_points.txt release/out portable/out >different || true
    local s; for s in film room; do
        cmp <(sed -n 1p "release/out/$s/stamp/sfm_points.txt") <(sed -n 1p "portable/out/$s/stamp/sfm_points.txt") >>different 2>&1 || true
    done
    [ ! -s different ] || { cat different; fail "$(wc -l <different) products differ"; }
    local n; n=$(find release/out -name '*.exr' | wc -l)
    [ "$n" -ge 50 ] || fail "only $n pictures were compared"
    echo "# $n pictures"
}

for t in everything_is_built_without_avx2 all_products_are_the_same; do run "$t"; done
