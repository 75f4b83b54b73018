# keyframed films through make and plan_path: dependencies and error messages
. tests/lib.sh
project keyframes
photos set --views 3 --size 160x120 >/dev/null
small t
sed -i 's/^planes = .*/planes = 32\nrounds = 0/; s/^seconds = .*/seconds = 0.25/; s/^max_side = .*/max_side = 96/; s/^renderer = .*/renderer = fast/' scenes/t/scene.cfg
film=scenes/t/keyframes/film.txt
made=out/t/parallax
a_film() { make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=t EFFECT="${effect:-film}" "$@" >log 2>&1; }
write_film()
{
    mkdir -p scenes/t/keyframes
    cat >$film <<TEXT
remodel-keyframes 1
key 0 view $1
key 0.2 view $2 focal x1.5
join 0.1
move establishing_dolly
move establishing_dolly reversed seconds 0.1
remodel-effects 1
layer grey saturation
region all
key 0 1
key 0.2 $3
TEXT
}
frames() { sed -n 's/^frames //p' "$1/path.txt"; }
views() { sed -n 's/^.* \([^ ]*\)\.exr$/\1/p' out/t/views/images.txt; }

a_film_joins_keys_and_planned_moves()
{
    effect=establishing_dolly a_film views || { cat log; fail "views"; }
    set -- $(views)
    write_film "$1" "$2" 0
    a_film frames || { cat log; fail "make"; }
    n=$(frames $made/establishing_dolly) fps=$(sed -n 's/^fps //p' $made/film/path.txt)
    want=$(awk -v n="$n" -v fps="$fps" 'BEGIN { r = int(0.1 * fps + 0.5); print int(0.2 * fps + 0.5) + 1 + r - 1 + n + (r > 2 ? r : 2) }')
    [ "$(frames $made/film)" = "$want" ] || fail "$(frames $made/film) frames, wanted $want"
    [ "$(ls $made/film/frames | wc -l)" = "$want" ] || fail "$(ls $made/film/frames)"
    grep -q '^layer grey saturation' $made/film/effects.txt || fail "no layer"
    [ ! -e $made/establishing_dolly/frames ] || fail "the chained move was rendered too"
}

only_stale_products_are_made_again()
{
    snapshot out/t >before.txt
    a_film frames || { cat log; fail "make"; }
    snapshot out/t | cmp - before.txt || fail "something was stale"
    touch before; sleep 0.1
    set -- $(views)
    write_film "$1" "$2" 0.5
    a_film path || { cat log; fail "make"; }
    [ $made/film/path.txt -nt before ] || fail "the film was not planned again"
    [ before -nt $made/establishing_dolly/path.txt ] || fail "the move was planned again"
    sed -i '/^layer/,$d' $film
    a_film path || { cat log; fail "make without layers"; }
    ! grep -q layer $made/film/effects.txt || fail "layers were left"
}

bad_films_are_refused_with_file_and_line()
{
    cp $film good.txt
    echo 'key 0 nowhere' >>$film
    ! a_film path && grep -q "$film:[0-9]*: found .*, wanted" log || { cat log; fail "no file and line"; }
    cp good.txt scenes/t/keyframes/other.txt
    cp good.txt $film; echo 'move other' >>$film
    ! a_film path && grep -q 'chains other, a film of keys' log || { cat log; fail "a film in a film"; }
    cp good.txt $film; rm scenes/t/keyframes/other.txt
    echo 'move dolly_inn' >>$film
    ! a_film views && grep -q 'did you mean dolly_in?' log && grep -q "$film chains it" log || { cat log; fail "a move of no name"; }
    cp good.txt $film
    for name in dolly_in all; do
        cp good.txt scenes/t/keyframes/$name.txt
        ! effect=$name a_film path && grep -q "keyframes/$name.txt: $name means something else" log || { cat log; fail "a film called $name"; }
        rm scenes/t/keyframes/$name.txt
    done
    rc=0; "$B/bin/plan_path" --views out/t/views --effect establishing_dolly --out made 2>err.txt || rc=$?
    [ "$rc" = 2 ] && grep -q 'wanted --depth with --validity' err.txt || { cat err.txt; fail "no --depth: exit $rc"; }
    rc=0; "$B/bin/plan_path" --views out/t/views --keyframes $film --effect film --out made 2>err.txt || rc=$?
    [ "$rc" = 1 ] && grep -q "$film:[0-9]*: the move establishing_dolly cannot be found" err.txt || { cat err.txt; fail "no --moves: exit $rc"; }
    [ -z "$(find made -type f 2>/dev/null)" ] || fail "something was left"
}

for t in a_film_joins_keys_and_planned_moves only_stale_products_are_made_again bad_films_are_refused_with_file_and_line; do run "$t"; done
