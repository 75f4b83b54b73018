# EFFECT: several names, auto and all, on a scene whose subjects are drawn; and which films two photos get
. tests/lib.sh
project effects
photos set --views 4 --size 160x120 >/dev/null

near='subject photo_2 76 58 108 94' far='subject photo_2 20 20 56 48' # the box, the wall
m() { make -s DEPS=manual PHOTOS=set/photos SFM=set/model "$@" >log 2>&1; }
made() { (cd "out/$1/parallax" && ls -d -- */video.mp4 2>/dev/null | sed 's|/video.mp4||' | LC_ALL=C sort); }
# of one subject; tones and depths of field with each of its moves
establishing='establishing_dolly establishing_dolly_out'
of_one()
{
    for move in dolly_in dolly_out dolly_zoom dolly_zoom_in; do
        echo $move
        for image in narrow_dof widen_dof saturate desaturate brighten dim; do echo "$move+$image"; done
    done
}
of_two() { printf 'dolly\ndolly+narrow_dof\ndolly+pull_focus\ndolly+widen_dof\n'; }
stands() { LC_ALL=C sort | diff - <(made "$1") || fail "wrong films"; }
score() { awk -v n="$3" '$1 == "score" && $2 == n { print $3 }' "out/$1/parallax/$2/path.txt"; }

all_effects_of_one_subject()
{
    tiny one; echo "$near" >scenes/one/subjects.txt
    m SCENE=one EFFECT=all depth || { cat log; fail "make depth"; }
    [ ! -e out/one/parallax ] || fail "films were chosen though nobody needed them"
    make -n -s DEPS=manual SCENE=one EFFECT=all >log 2>&1 || { cat log; fail "make -n"; }
    grep -q 'which films EFFECT=all makes' log && grep -q 'run_stage.* choose_effects' log && ! grep 'run_stage.* plan_path' log || { cat log; fail "make -n before the choice"; }
    m SCENE=one EFFECT=all || { cat log; fail "make"; }
    { of_one; printf '%s\n' $establishing; } | stands one
    [ "$(grep -c '^video ' log)" = 30 ] || { cat log; fail "the run does not name 30 videos"; }
    [ "$(ls out/one/parallax/*/validity.txt | wc -l)" = 6 ] || fail "the image effects of a move do not share its valid viewpoints"
    [ "$(ls out/one/log/render_views.*.log | wc -l)" = 30 ] || fail "the films' logs overwrite each other"
    for e in $(made one); do
        [ "$(awk '$1 == "effect" { print $2 }' "out/one/parallax/$e/path.txt")" = "$e" ] || fail "$e calls itself something else"
        [ "$(ls "out/one/parallax/$e/frames" | wc -l)" = 3 ] || fail "$e has not three frames"
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
        000:*) grep -q 'the aperture cannot open' "out/one/log/plan_path.$e.log" || fail "nothing says that the aperture of $e stays shut" ;;
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
    diff a b || fail "a second make made something again"
    make -s DEPS=manual SCENE=one EFFECT=all why | matches 'Nothing is stale' || fail "make why sees something stale"
    ! make -n -s DEPS=manual SCENE=one EFFECT=all | grep run_stage || fail "make -n wants to run something"
    for e in dolly_in dolly_zoom+dim "dolly_in establishing_dolly_out dolly_in"; do
        m SCENE=one "EFFECT=$e" || { cat log; fail "make EFFECT=$e"; }
        snapshot out/one >b
        diff a b || fail "EFFECT=$e made something again"
    done
}

what_is_lost_or_changed_redoes_its_film_alone()
{
    for p in dolly_in+dim/frames/0002.exr dolly_out/path.txt dolly_zoom/validity.png dolly_zoom+brighten/video.mp4; do
        sum=$(sha256sum <"out/one/parallax/$p")
        rm "out/one/parallax/$p"
        snapshot out/one >a
        m SCENE=one EFFECT=all || { cat log; fail "make without $p"; }
        [ "$(sha256sum <"out/one/parallax/$p")" = "$sum" ] || fail "$p has other bytes"
        snapshot out/one >b
        changed a b >c
        case $p in
        *validity.png) want='dolly_zoom([+][a-z_]*)?' ;; # all that the move's viewpoints serve
        *) want=${p%%/*}; want=${want//+/[+]} ;;
        esac
        ! grep -vE "^(index.html|parallax/$want/.*)$" c || fail "without $p too much was made again"
        grep -qx "parallax/${p%%/*}/video.mp4" c || { cat c; fail "without $p the video was not made again"; }
    done
    rm out/one/parallax/dolly_in+dim/frames/0002.exr
    make -n -s DEPS=manual SCENE=one EFFECT=all >log
    ! grep run_stage log | grep -vE 'render_views dolly_in[+]dim-|encode_video dolly_in[+]dim |report page ' || fail "make -n is not exact"
    [ "$(grep -c run_stage log)" = 3 ] || { cat log; fail "make -n does not tell all"; }
    make -s DEPS=manual SCENE=one EFFECT=all why | matches 'dolly_in+dim/frames/0002.exr: it does not exist' || fail "make why does not name the frame"
    m SCENE=one EFFECT=all || { cat log; fail "make"; }
}

auto_draws_one_that_suits()
{
    snapshot out/one >a
    m SCENE=one EFFECT=auto || { cat log; fail "make"; }
    e=$(sed -n 's/^EFFECTS := //p' out/one/parallax/auto-effects.mk)
    { of_one | grep -vE '[+](de)?saturate|brighten|dim'; } | matches -xF "$e" || fail "'$e' was drawn"
    snapshot out/one >b
    [ "$(changed a b | grep -v '^index.html$')" = parallax/auto-effects.mk ] || { changed a b; fail "films were made again"; }
    tiny none; : >scenes/none/subjects.txt
    m SCENE=none EFFECT=auto video || { cat log; fail "make without a subject"; }
    [ "$(made none | wc -l)" = 1 ] && printf '%s\n' $establishing | matches -xF "$(made none)" || { made none; fail "wrong film without a subject"; }
    m SCENE=none EFFECT=auto video || { cat log; fail "make again"; }
    [ "$(made none | wc -l)" = 1 ] || fail "another one was drawn"
    for s in 1 2 3 4 5 6; do "$B/bin/choose_effects" --subjects out/none/parallax/subjects.txt --effect auto --set seed=$s --out drawn.mk 2>/dev/null; grep EFFECTS drawn.mk; done | sort -u | wc -l | matches -x 2 || fail "other seeds draw nothing else"
}

a_subject_more_adds_the_moves_for_two()
{
    m SCENE=none EFFECT=all video || { cat log; fail "make without a subject"; }
    printf '%s\n' $establishing | stands none
    printf '%s\n%s\n' "$near" "$far" >scenes/one/subjects.txt
    snapshot out/one >a
    m SCENE=one EFFECT=all CORES=2 || { cat log; fail "make"; }
    { of_one; of_two; printf '%s\n' $establishing; } | stands one
    snapshot out/one >b
    ! changed a b | grep 'establishing' || fail "moves without a subject were made again"
    awk -v size="$(score one dolly subject_size_error)" -v place="$(score one dolly subject_place_error)" 'BEGIN { exit !(size < 0.01 && place < 1) }' || fail "the subjects are not as promised"
}

the_same_bytes_for_any_cores()
{
    products one | grep -v /auto-effects >want
    rm -r out/one/parallax
    m SCENE=one EFFECT=all CORES=1 FRAMES_PER_JOB=2 || { cat log; fail "one core"; }
    products one | diff want - || fail "one core gives other bytes"
}

what_does_not_suit_is_refused()
{
    for c in "dolly_in|needs 1 subject" "dolly|needs 2 subjects" "dolly_in+dim|needs 1 subject"; do
        ! m SCENE=none "EFFECT=${c%|*}" path || fail "${c%|*} was planned"
        grep -q "${c#*|}" log || { cat log; fail "${c%|*}: no sentence"; }
        [ ! -e "out/none/parallax/${c%|*}/path.txt" ] || fail "${c%|*}: a path was left"
    done
    # two subjects of one depth: focus cannot tell them apart
    printf '%s\n%s\n' "$near" "$near" >scenes/none/subjects.txt
    ! m SCENE=none EFFECT=dolly+pull_focus path || fail "focus was pulled between equal depths"
    grep -q "depths differ by a factor of 1," log || { cat log; fail "no sentence"; }
    m SCENE=none EFFECT=all path || { cat log; fail "make"; }
    [ -e out/none/parallax/dolly/path.txt ] && [ ! -e out/none/parallax/dolly+pull_focus/path.txt ] || fail "wrong films of two at one depth"
}

a_killed_run_goes_on()
{
    rm -r out/one/parallax
    for wait in 2 4 6; do
        setsid make -s DEPS=manual SCENE=one EFFECT=all >log 2>&1 &
        p=$!
        sleep "$wait"
        kill -9 -- "-$p" 2>/dev/null || true
        wait "$p" 2>/dev/null || true
    done
    m SCENE=one EFFECT=all || { cat log; fail "make"; }
    products one | diff want - || fail "a resumed run gives other bytes"
}

pan_scan_of_several()
{
    m SCENE=one "EFFECT=dolly_in dolly_out" pan_scan || { cat log; fail "make pan_scan"; }
    [ "$(ls out/one/parallax/*/pan_scan/video.mp4 | wc -l)" = 2 ] || fail "not both in 2D"
    m SCENE=one EFFECT=all || { cat log; fail "make"; }
    snapshot out/one >a
    m SCENE=one EFFECT=all || { cat log; fail "make again"; }
    snapshot out/one >b
    diff a b || fail "a second make made something again"
}

# by itself the film of two photos is their morph; a move that is named is planned
two_photos_get_a_morph_or_the_move_that_is_named()
{
    mkdir pair; cp set/photos/photo_[23].jpg pair/; tiny pair
    awk '/^#/ { print; next } { n++; if (n % 2) keep = /photo_[23][.]jpg$/; if (keep) print }' set/model/images.txt >images.tmp
    cp -r set/model pair-model; mv images.tmp pair-model/images.txt
    : >pair-model/points3D.txt
    awk '/^#/ { print; next } { n++; print n % 2 ? $0 : "" }' pair-model/images.txt >images.tmp && mv images.tmp pair-model/images.txt
    printf '[morph_views]\nseconds = 0.1\nmax_side = 96\n' >>scenes/pair/scene.cfg
    p() { make -s DEPS=manual PHOTOS=pair SFM=pair-model SCENE=pair "$@" >log 2>&1; }
    p || { cat log; fail "make"; }
    [ "$(made pair)" = morph ] && [ ! -e out/pair/depth ] || fail "by itself: $(made pair)"
    p EFFECT=auto || { cat log; fail "make EFFECT=auto"; }
    [ "$(made pair)" = morph ] || fail "auto: $(made pair)"
    p EFFECT=establishing_dolly || { cat log; fail "make EFFECT=establishing_dolly"; }
    [ "$(made pair)" = "establishing_dolly
morph" ] || fail "a move that is named: $(made pair)"
    snapshot out/pair >a
    p EFFECT=establishing_dolly || { cat log; fail "make again"; }
    snapshot out/pair >b
    diff a b || fail "a second make made something again"
}

for t in all_effects_of_one_subject the_next_make_does_nothing what_is_lost_or_changed_redoes_its_film_alone auto_draws_one_that_suits \
    a_subject_more_adds_the_moves_for_two the_same_bytes_for_any_cores what_does_not_suit_is_refused a_killed_run_goes_on pan_scan_of_several \
    two_photos_get_a_morph_or_the_move_that_is_named; do run "$t"; done
