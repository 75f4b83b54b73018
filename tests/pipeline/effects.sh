# EFFECT: several names, auto and all, on a scene with marked subjects; and the films that two photos give
. tests/lib.sh
project effects
photos set --views 4 >/dev/null

near='subject photo_2 76 58 108 94' far='subject photo_2 20 20 56 48' # the box, the wall
m() { make -s DEPS=manual PHOTOS=set/photos SFM=set/model "$@" >log 2>&1; }
# made SCENE [FILE]: the films that have FILE, by default a video
made() { (cd "out/$1/parallax" && ls -d -- */"${2:-video.mp4}" 2>/dev/null | sed 's|/.*||' | LC_ALL=C sort); }
establishing='establishing_dolly establishing_dolly_out'
# the films of one subject: each move alone, and with a depth of field or a tone
of_one()
{
    for move in dolly_in dolly_out dolly_zoom dolly_zoom_in; do
        echo $move
        for image in narrow_dof widen_dof saturate desaturate brighten dim; do echo "$move+$image"; done
    done
}
of_two() { printf 'dolly\ndolly+narrow_dof\ndolly+pull_focus\ndolly+widen_dof\n'; }
# a few films of two subjects that stand for all: without subject, move alone, depth of field, tone, two subjects, focus
few='establishing_dolly dolly_in dolly_in+narrow_dof dolly_out+dim dolly dolly+pull_focus'
# are_made SCENE [FILE]: standard input names exactly the films that have FILE
are_made() { LC_ALL=C sort | diff - <(made "$@") || fail "wrong films"; }
score() { awk -v n="$3" '$1 == "score" && $2 == n { print $3 }' "out/$1/parallax/$2/path.txt"; }

all_effects_of_one_subject()
{
    tiny one; echo "$near" >scenes/one/subjects.txt
    m SCENE=one EFFECT=all depth || { cat log; fail "make depth"; }
    [ ! -e out/one/parallax ] || fail "films were chosen for make depth"
    make -n -s DEPS=manual SCENE=one EFFECT=all >log 2>&1 || { cat log; fail "make -n"; }
    grep -q 'which films EFFECT=all makes' log && grep -q 'run_stage.* choose_effects' log && ! grep 'run_stage.* plan_path' log || { cat log; fail "make -n before the choice"; }
    m SCENE=one EFFECT=all || { cat log; fail "make"; }
    { of_one; printf '%s\n' $establishing; } | are_made one
    [ "$(grep -c '^video ' log)" = 30 ] || { cat log; fail "the run does not name 30 videos"; }
    [ "$(ls out/one/parallax/*/validity.txt | wc -l)" = 6 ] || fail "the image effects of a move do not share its valid viewpoints"
    [ "$(ls out/one/log/render_views.*.log | wc -l)" = 30 ] || fail "the films' logs overwrite each other"
    for e in $(made one); do
        [ "$(awk '$1 == "effect" { print $2 }' "out/one/parallax/$e/path.txt")" = "$e" ] || fail "path.txt of $e names another effect"
        [ "$(ls "out/one/parallax/$e/frames" | wc -l)" = 3 ] || fail "$e does not have three frames"
    done
    for e in dolly_zoom dolly_zoom_in; do
        awk -v x="$(score one $e subject_size_error)" 'BEGIN { exit !(x < 0.01) }' || fail "$e: the subject's size is off by $(score one $e subject_size_error)"
    done
    grep -q '^ *region outside' out/one/parallax/dolly_in+dim/effects.txt || fail "dolly_in+dim has no layer"
    ! cmp -s out/one/parallax/dolly_in/frames/0003.exr out/one/parallax/dolly_in+dim/frames/0003.exr || fail "nothing was dimmed"
    for e in $(made one | grep -E 'narrow_dof|widen_dof'); do
        open=$(awk '$1 == "frame" { printf "%d", ($4 > 0) }' "out/one/parallax/$e/path.txt")
        case $open:$e in
        011:*narrow_dof | 110:*widen_dof) opened=1 ;;
        000:*) grep -q 'the aperture cannot open' "out/one/log/plan_path.$e.log" || fail "no warning that the aperture of $e stays shut" ;;
        *) fail "the apertures of $e: $open" ;;
        esac
    done
    [ "${opened-}" ] || fail "no film has a depth of field"
}

the_next_make_does_nothing()
{
    snapshot out/one >a
    m SCENE=one EFFECT=all || { cat log; fail "make"; }
    snapshot out/one >b
    diff a b || fail "a second make remade something"
    make -s DEPS=manual SCENE=one EFFECT=all why | matches 'Nothing is stale' || fail "make why finds stale products"
    m SCENE=one EFFECT="dolly_in dolly_zoom+dim establishing_dolly_out dolly_in" || { cat log; fail "make of some films"; }
    snapshot out/one >b
    diff a b || fail "make of some films remade something"
}

a_lost_product_redoes_only_its_own_film()
{
    products one >want
    rm out/one/parallax/dolly_in+dim/frames/0002.exr
    make -n -s DEPS=manual SCENE=one EFFECT=all >log
    ! grep run_stage log | grep -vE 'render_views dolly_in[+]dim-|encode_video dolly_in[+]dim |report page ' || fail "make -n would run too much"
    [ "$(grep -c run_stage log)" = 3 ] || { cat log; fail "make -n leaves something out"; }
    make -s DEPS=manual SCENE=one EFFECT="dolly_in dolly_in+dim" why | matches 'dolly_in+dim/frames/0002.exr: it does not exist' || fail "make why does not name the frame"
    lost='dolly_in+dim/frames/0002.exr dolly_out/path.txt dolly_zoom/validity.png establishing_dolly/video.mp4'
    (cd out/one/parallax && rm -f $lost)
    snapshot out/one >a
    m SCENE=one EFFECT=all || { cat log; fail "make without $lost"; }
    products one | diff want - || fail "without $lost other bytes came out"
    snapshot out/one >b
    changed a b >c
    # the valid viewpoints of dolly_zoom serve all its films
    ! grep -vE '^(index.html|parallax/(dolly_in[+]dim/(frames/0002.exr|video.mp4)|dolly_out/.*|dolly_zoom([+][a-z_]*)?/.*|establishing_dolly/video.mp4))$' c || fail "too much was remade"
    ! grep '^parallax/dolly_out/validity' c || fail "the valid viewpoints of dolly_out were remade"
    for e in dolly_in+dim dolly_out dolly_zoom dolly_zoom+brighten establishing_dolly; do
        grep -qx "parallax/$e/video.mp4" c || { cat c; fail "the video of $e was not remade"; }
    done
}

auto_draws_a_film_that_suits_the_subjects()
{
    snapshot out/one >a
    m SCENE=one EFFECT=auto || { cat log; fail "make"; }
    e=$(sed -n 's/^EFFECTS := //p' out/one/parallax/auto-effects.mk)
    { of_one | grep -vE '[+](de)?saturate|brighten|dim'; } | matches -xF "$e" || fail "'$e' was drawn"
    snapshot out/one >b
    [ "$(changed a b | grep -v '^index.html$')" = parallax/auto-effects.mk ] || { changed a b; fail "films were remade"; }
    tiny none; : >scenes/none/subjects.txt
    m SCENE=none EFFECT=auto video || { cat log; fail "make without a subject"; }
    [ "$(made none | wc -l)" = 1 ] && printf '%s\n' $establishing | matches -xF "$(made none)" || { made none; fail "wrong film without a subject"; }
    m SCENE=none EFFECT=auto video || { cat log; fail "make again"; }
    [ "$(made none | wc -l)" = 1 ] || fail "the second run drew another film"
    for s in 1 2 3 4 5 6; do "$B/bin/choose_effects" --subjects out/none/parallax/subjects.txt --effect auto --set seed=$s --out drawn.mk 2>/dev/null; grep EFFECTS drawn.mk; done | sort -u | wc -l | matches -x 2 || fail "other seeds draw the same film"
}

a_second_subject_adds_the_moves_for_two()
{
    m SCENE=none EFFECT=all video || { cat log; fail "make without a subject"; }
    printf '%s\n' $establishing | are_made none
    printf '%s\n%s\n' "$near" "$far" >scenes/one/subjects.txt
    snapshot out/one >a
    m SCENE=one EFFECT=all path CORES=2 || { cat log; fail "make path"; }
    { of_one; of_two; printf '%s\n' $establishing; } | are_made one path.txt
    m SCENE=one EFFECT="$few" CORES=2 || { cat log; fail "make"; }
    snapshot out/one >b
    changed a b >c
    ! grep 'establishing' c || fail "moves without a subject were remade"
    for e in $few; do [[ $e == establishing* ]] || grep -qxF "parallax/$e/video.mp4" c || fail "$e was not remade"; done
    awk -v size="$(score one dolly subject_size_error)" -v place="$(score one dolly subject_place_error)" 'BEGIN { exit !(size < 0.01 && place < 1) }' || fail "dolly does not keep size and place of its subjects"
    rm out/one/parallax/*-effects.mk
    for e in $(made one path.txt); do [[ " $few dolly_out " == *" $e "* ]] || rm -r "out/one/parallax/$e"; done
    find out/one/parallax/dolly_out -mindepth 1 -maxdepth 1 ! -name 'validity.*' -exec rm -r {} + # the few need only its viewpoints
    products one >want
}

the_same_bytes_for_any_number_of_cores()
{
    rm -r out/one/parallax
    m SCENE=one EFFECT="$few" CORES=1 FRAMES_PER_JOB=2 || { cat log; fail "one core"; }
    products one | diff want - || fail "one core gives other bytes"
}

films_that_do_not_suit_the_subjects_are_refused()
{
    refused='dolly_in dolly dolly_in+dim'
    ! m SCENE=none EFFECT="$refused" -k path || fail "they were planned"
    for c in "dolly_in needs 1 subject" "dolly needs 2 subjects"; do
        grep -q "$c" log || { cat log; fail "no message '$c'"; }
    done
    for e in $refused; do [ ! -e "out/none/parallax/$e/path.txt" ] || fail "$e: a path was left"; done
    # two subjects at one depth: focus cannot tell them apart
    printf '%s\n%s\n' "$near" "$near" >scenes/none/subjects.txt
    ! m SCENE=none EFFECT=dolly+pull_focus path || fail "focus was pulled between equal depths"
    grep -q "depths differ by a factor of 1;" log || { cat log; fail "no message about the depths"; }
    m SCENE=none EFFECT=all path || { cat log; fail "make"; }
    [ -e out/none/parallax/dolly/path.txt ] && [ ! -e out/none/parallax/dolly+pull_focus/path.txt ] || fail "wrong films of two subjects at one depth"
}

a_killed_run_resumes_to_the_same_bytes()
{
    rm -r out/one/parallax
    for file in dolly/validity.txt dolly_in+narrow_dof/frames/0001.exr '*/video.mp4'; do
        kill_at "out/one/parallax/$file" make -s DEPS=manual SCENE=one EFFECT="$few"
    done
    m SCENE=one EFFECT="$few" || { cat log; fail "make"; }
    products one | diff want - || fail "a resumed run gives other bytes"
}

pan_scan_of_several_films()
{
    m SCENE=one "EFFECT=dolly_in dolly_out" pan_scan || { cat log; fail "make pan_scan"; }
    [ "$(ls out/one/parallax/*/pan_scan/video.mp4 | wc -l)" = 2 ] || fail "not both in 2D"
    m SCENE=one "EFFECT=dolly_in dolly_out" || { cat log; fail "make"; }
    snapshot out/one >a
    m SCENE=one "EFFECT=dolly_in dolly_out" || { cat log; fail "make again"; }
    snapshot out/one >b
    diff a b || fail "a second make remade something"
}

# the default film of two photos is their morph; a move is made if it is named
two_photos_give_a_morph_or_a_named_move()
{
    mkdir pair; cp set/photos/photo_[23].jpg pair/; tiny pair
    awk '/^#/ { print; next } { n++; if (n % 2) keep = /photo_[23][.]jpg$/; if (keep) print }' set/model/images.txt >images.tmp
    cp -r set/model pair-model; mv images.tmp pair-model/images.txt
    : >pair-model/points3D.txt
    awk '/^#/ { print; next } { n++; print n % 2 ? $0 : "" }' pair-model/images.txt >images.tmp && mv images.tmp pair-model/images.txt
    printf '[morph_views]\nseconds = 0.1\nmax_side = 96\n' >>scenes/pair/scene.cfg
    p() { make -s DEPS=manual PHOTOS=pair SFM=pair-model SCENE=pair "$@" >log 2>&1; }
    p || { cat log; fail "make"; }
    [ "$(made pair)" = morph ] && [ ! -e out/pair/depth ] || fail "by default: $(made pair)"
    p EFFECT=auto || { cat log; fail "make EFFECT=auto"; }
    [ "$(made pair)" = morph ] || fail "auto: $(made pair)"
    p EFFECT=establishing_dolly || { cat log; fail "make EFFECT=establishing_dolly"; }
    [ "$(made pair)" = "establishing_dolly
morph" ] || fail "a named move: $(made pair)"
    snapshot out/pair >a
    p EFFECT=establishing_dolly || { cat log; fail "make again"; }
    snapshot out/pair >b
    diff a b || fail "a second make remade something"
}

for t in all_effects_of_one_subject the_next_make_does_nothing a_lost_product_redoes_only_its_own_film auto_draws_a_film_that_suits_the_subjects \
    a_second_subject_adds_the_moves_for_two the_same_bytes_for_any_number_of_cores films_that_do_not_suit_the_subjects_are_refused \
    a_killed_run_resumes_to_the_same_bytes pan_scan_of_several_films two_photos_give_a_morph_or_a_named_move; do run "$t"; done
