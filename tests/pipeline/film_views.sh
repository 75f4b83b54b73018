# films of a cluster of views: all stages of a move use it, and only a new choice makes films again
. tests/lib.sh
project film_views
photos set >/dev/null
small t
run_scene() { make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=t CORES=2 "$@"; }
film=out/t/parallax/establishing_dolly
choice=out/t/parallax/views.txt

a_scene_with_a_direction_is_filmed_from_all_views()
{
    run_scene frames >log 2>&1 || { cat log; fail "make frames"; }
    grep -qx all "$choice" || { cat "$choice"; fail "views were chosen"; }
    ! grep -q 'views.txt' $film/validity.txt $film/path.txt || fail "a choice that changes nothing is an input"
    snapshot out/t >a
    run_scene frames >log 2>&1
    snapshot out/t >b
    diff a b || fail "a second make remade something"
}

the_same_choice_makes_no_film_again()
{
    snapshot out/t >a
    echo 'subject photo_2 76 58 108 94' >scenes/t/subjects.txt # which does not matter where all views are used
    run_scene frames >log 2>&1 || { cat log; fail "make with a subject"; }
    grep -q subjects.txt out/t/stamp/drawn.txt || fail "the views were not chosen again"
    snapshot out/t >b
    diff a b || fail "films were made again for the same choice"
    rm scenes/t/subjects.txt
}

a_cluster_is_an_input_of_every_stage_of_the_move()
{
    printf '[choose_views]\naround = photo_3\nmin_shared = 0.97\n' >>scenes/t/scene.cfg
    run_scene frames subjects >log 2>&1 || { cat log; fail "make frames of a cluster"; }
    local n; n=$(grep -c '^view ' "$choice")
    [ "$n" -gt 1 ] && [ "$n" -lt 6 ] && grep -qx 'view photo_3' "$choice" || { cat "$choice"; fail "$n views were chosen"; }
    for f in out/t/parallax/subjects.txt $film/validity.txt $film/path.txt; do
        grep -q '^# input parallax/views.txt' $f || fail "$f does not name the choice"
    done
    [ "$(grep -c '^# input depth/photo_.*[.]exr ' $film/validity.txt)" = "$n" ] || fail "depth of other views was read"
    grep -aq 'parallax/views.txt' $film/frames/0003.exr || fail "the frames do not name the choice"
    snapshot out/t >a
    run_scene frames >log 2>&1
    snapshot out/t >b
    diff a b || fail "a second make remade something"
}

a_lost_choice_is_made_again_with_the_same_bytes()
{
    products t >want
    rm "$choice"
    run_scene frames subjects >log 2>&1 || { cat log; fail "make after a lost choice"; }
    products t | diff want - || fail "other bytes"
}

for t in a_scene_with_a_direction_is_filmed_from_all_views the_same_choice_makes_no_film_again a_cluster_is_an_input_of_every_stage_of_the_move \
    a_lost_choice_is_made_again_with_the_same_bytes; do run "$t"; done
