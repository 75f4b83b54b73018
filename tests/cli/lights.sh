# fit_lights: windows, marked lamps, what make makes again; threads; errors
. tests/lib.sh
project lights
photos set >/dev/null
boxed t model
m() { make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=t "$@" >log 2>&1 || { cat log; fail "make $*"; }; }
printf '[bake_outdoors]\nheight = 64\nedge = 1\nmax_clutter = 1\n' >>scenes/t/scene.cfg
O=out/t
{ echo 'set glass 0.1'; for w in south west; do echo "window in-$w on $w from -25 0.2 to 25 18"; done; } >>scenes/t/model.txt
inputs=(--model "$O/model/model.txt" --plan "$O/model/plan.txt" --axes "$O/model/axes.txt" --views "$O/views" --ids "$O/ids" --vita "$O/vita")

# fit CODE WORD ARGUMENT...: runs fit_lights; checks its exit status and a word on standard error
fit()
{
    local code=$1 word=$2 rc=0; shift 2
    rm -rf made
    "$B/bin/fit_lights" "${inputs[@]}" --out made "$@" >out.txt 2>err.txt </dev/null || rc=$?
    [ "$rc" = "$code" ] || { cat err.txt; fail "$*: exit $rc, wanted $code"; }
    grep -qF -- "$word" err.txt || { cat err.txt; fail "$*: nothing says '$word'"; }
    [ "$code" = 0 ] || grep -q 'fit_lights: error: .*[.?]$' err.txt || { cat err.txt; fail "$*: no sentence"; }
    [ "$code" = 0 ] || [ ! -e made/lights.txt ] || fail "$*: a product was left"
}
# first_photo: the id of a photo
first_photo() { sed -nE 's/^([^ #]+) ([^ ]+) .*/\2/p' $O/views/lenses.txt | grep -v '^[0-9]*$' | sed -n 1p; }
# marked LINE...: the marks of a scene
marked() { { echo 'remodel-lamps 1'; printf '%s\n' "$@"; } >marks.txt; }

windows_let_daylight_in_unless_they_are_shut()
{
    m lights
    [ "$(grep -c '^opening in-' $O/lights/lights.txt)" = 2 ] || { cat $O/lights/lights.txt; fail "not two openings"; }
    "$B/bin/verify" --file $O/lights/lights.txt || fail "the product is not whole"
    ! grep -qF "$PWD" $O/lights/lights.txt || fail "the product names a folder of this machine"
    printf 'remodel-lamps 1\nshut in-west\nwindow in-south reference lri_1\n' >scenes/t/lights.txt
    m lights
    [ "$(grep -c '^opening' $O/lights/lights.txt)" = 1 ] || fail "the shut window is still there"
    grep -q '^opening in-south .* reference lri_1$' $O/lights/lights.txt || fail "the reference image is lost"
    find $O/lights -type f -printf '%p %T@\n' >before
    m lights
    find $O/lights -type f -printf '%p %T@\n' | diff before - || fail "a second make made it again"
    rm scenes/t/lights.txt
    m lights
    [ "$(grep -c '^opening' $O/lights/lights.txt)" = 2 ] || fail "a removed file of marks still counts"
}

marked_lamps_are_placed()
{
    photo=$(first_photo)
    marked "disk spot in $photo 100 60 rim 104 60 beta 30 radiance 9 8 7" "area panel in $photo 60 60 80 60 80 75 60 75 radiance 1 1 1"
    fit 0 '2 lamps, 2 openings' --lamps marks.txt
    grep -q '^disk spot .* 9 8 7 30 0$' made/lights.txt || { cat made/lights.txt; fail "no disk"; }
    grep -q '^quad panel .* 1 1 1 90 0$' made/lights.txt || fail "no quad"
    [ -s made/spot.jpg ] && [ -s made/panel.jpg ] || { ls made; fail "no pictures of the lamps"; }
    "$B/bin/verify" --file made/spot.jpg || fail "the picture of a lamp is not whole"
    for n in 1 2; do "$B/bin/fit_lights" "${inputs[@]}" --lamps marks.txt --threads $n --out two/$n; done
    cmp two/1/lights.txt two/2/lights.txt
    cmp two/1/fit.txt two/2/fit.txt
    cmp two/1/spot.jpg two/2/spot.jpg
}

given_indirect_light_is_for_the_points_that_are_listed()
{
    photo=$(first_photo)
    marked "disk spot in $photo 100 60 rim 104 60 radiance 9 8 7" "lit spot in $photo 90 60 95 64" "unlit spot in $photo 60 60"
    "$B/bin/fit_lights" "${inputs[@]}" --lamps marks.txt --list points --out points.txt
    [ "$(grep -vc '^#' points.txt)" = 26 ] || { cat points.txt; fail "not 26 points"; }
    sed '/^#/d; s/$/ 1 1 1/' points.txt >given.txt
    fit 0 '1 lamps, 2 openings' --lamps marks.txt --indirect given.txt
    grep -q '^material spot .* lit 25 unlit 1$' made/fit.txt || { cat made/fit.txt; fail "no material"; }
    [ "$(grep -c '^point .* lamp spot$' made/fit.txt)" = 26 ] || fail "points do not name their lamp"
    sed 1d given.txt >fewer.txt
    fit 1 'fewer.txt:1: ' --lamps marks.txt --indirect fewer.txt
    sed '$d' given.txt >fewer.txt
    fit 1 '26 points, one for each that was listed' --lamps marks.txt --indirect fewer.txt
}

# unknown WORD LINE...: the marks of a lamp that stays as photographed; a window's light still comes in
unknown()
{
    local word=$1; shift
    marked "$@"
    fit 0 "$word" --lamps marks.txt
    [ "$(grep -c '^opening in-' made/lights.txt)" = 2 ] || { cat made/lights.txt; fail "$*: the openings are lost"; }
}

what_is_wrong_with_a_mark_is_said_and_the_rest_goes_on()
{
    photo=$(first_photo)
    unknown 'marks.txt:2: found "nothing", wanted a photo' 'disk spot in nothing 1 1 rim 2 2'
    unknown 'is not inside the photo' "disk spot in $photo 1e5 1 rim 2 2"
    unknown 'has no area' "disk spot in $photo 100 60 rim 100 60 radiance 1 1 1"
    unknown 'the edge of the cone of the lamp spot was not found' "disk spot in $photo 100 60 rim 101 60 beta fit radiance 1 1 1"
    unknown '1 lamps, 2 openings' "disk spot in $photo 100 60 rim 104 60" "lit spot in $photo 100 90"
}

errors_say_what_is_wrong()
{
    photo=$(first_photo)
    fit 1 'no-such.txt' --lamps no-such.txt
    marked 'window none'; fit 1 'marks.txt:2: found none, wanted the name of an opening' --lamps marks.txt
    marked "disk spot in $photo 100 60 rim 104 60 beta 30" "line spot in $photo 90 60 95 64"; fit 1 'write beta fit there' --lamps marks.txt
    fit 2 'hemicube = 33 is odd' --set hemicube=33
}

for t in windows_let_daylight_in_unless_they_are_shut marked_lamps_are_placed given_indirect_light_is_for_the_points_that_are_listed what_is_wrong_with_a_mark_is_said_and_the_rest_goes_on errors_say_what_is_wrong; do run "$t"; done
