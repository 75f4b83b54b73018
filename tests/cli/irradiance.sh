# gather_irradiance: points, a face and a view of a synthetic room; lamps; glossy materials; the absolute scale; threads; errors; make irradiance
. tests/lib.sh
project irradiance
photos set --size 128x96 >/dev/null
boxed t textures
m() { make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=t "$@" >log 2>&1 || { cat log; fail "make $*"; }; }
printf '[bake_outdoors]\nheight = 64\nedge = 1\nmax_clutter = 1\n[gather_irradiance]\nestimator = hemicube\nhemicube = 16\n' >>scenes/t/scene.cfg
m textures outdoors
O=out/t
view=$(ls $O/views/*.exr | sed -n 1p); view=$(basename "$view" .exr)
inputs=(--model "$O/model/model.txt" --axes "$O/model/axes.txt" --vita "$O/vita" --outdoors "$O/outdoors/outdoors.exr" --set estimator=hemicube --set hemicube=16)

# gather CODE WORD ARGUMENT...: runs gather_irradiance; checks its exit status and a word on standard error
gather()
{
    local code=$1 word=$2 rc=0; shift 2
    rm -rf made
    "$B/bin/gather_irradiance" "$@" >out.txt 2>err.txt </dev/null || rc=$?
    [ "$rc" = "$code" ] || { cat err.txt; fail "$*: exit $rc, wanted $code"; }
    grep -qF -- "$word" err.txt || { cat err.txt; fail "$*: nothing says '$word'"; }
    [ "$code" = 0 ] || grep -q 'gather_irradiance: error: .*[.?]$' err.txt || { cat err.txt; fail "$*: no sentence"; }
    [ "$code" = 0 ] || [ ! -e made ] || [ -z "$(find made -type f)" ] || fail "$*: a product was left"
}
floor=$(sed -nE "s/^face ([0-9]+) [^ ]*floor[^ ]* 0 0 1 .*/\1/p" $O/model/model.txt | sed -n 1p)

a_face_gets_points_at_a_step()
{
    gather 0 'mean shares of the light' "${inputs[@]}" --face "$floor" --step 4 --out two/face
    [ "$(grep -vc '^#' two/face/irradiance/face-"$floor".txt)" -gt 3 ] || fail "too few points"
    [ "$(grep -vc '^#' two/face/irradiance/face-"$floor".txt)" = "$(grep -vc '^#' two/face/irradiance/face-"$floor"-parts.txt)" ] || fail "another number of parts"
    ! grep -qE 'nan|inf' two/face/irradiance/*.txt || fail "a number is none"
    awk '!/^#/ { s = 0; for (i = 7; i <= 13; i++) s += $i; if ((s - 1) ^ 2 > 1e-9 && s != 0) exit 1 }' two/face/irradiance/face-"$floor"-parts.txt || fail "shares do not sum to 1"
    grep -v '^#' two/face/irradiance/face-"$floor".txt | cut -d' ' -f1-6 >points.txt
}

points_of_a_file_have_what_the_face_had()
{
    gather 0 'points' "${inputs[@]}" --points points.txt --out two/points
    awk 'NR == FNR { if (!/^#/) was[++n] = $8; next } !/^#/ { i++; if (!(($8 - was[i]) ^ 2 <= (1e-3 * was[i]) ^ 2)) exit 1 }' \
        two/face/irradiance/face-"$floor".txt two/points/irradiance.txt || fail "the same points have another irradiance"
}

bytes_do_not_depend_on_threads()
{
    printf 'remodel-lights 1\ndisk lamp 0 0 8 0 0 -1 3 500 500 500 50 1\n' >lamps.txt
    for n in 1 2; do
        gather 0 points "${inputs[@]}" --points points.txt --out two/$n --threads $n
        gather 0 points "${inputs[@]}" --set hemicube=4 --set target_error=0 --view "$view" --views $O/views --out two/$n --threads $n
        for e in rays cache; do
            gather 0 points "${inputs[@]}" --set estimator=$e --set target_error=0.3 --view "$view" --views $O/views --lights lamps.txt --out two/$n/$e --threads $n
        done
    done
    diff -r two/1 two/2
    ! grep -rqF "$PWD" two/1 || fail "a product names a folder of this machine"
    "$B/bin/verify" --file two/1/irradiance/"$view".exr || fail "the picture is not whole"
}

a_lamp_adds_light_and_is_reported()
{
    gather 0 '0.0 % lamps' "${inputs[@]}" --points points.txt --out two/dark
    awk '/^#/ { next } { x += $1; y += $2; z += $3; n++ } END { print x / n, y / n, z / n }' two/dark/irradiance.txt >middle.txt
    printf 'remodel-lights 1\ndisk lamp 0 0 8 0 0 -1 3 500 500 500 90 0\n' >lights.txt
    gather 0 '% lamps' "${inputs[@]}" --points points.txt --lights lights.txt --out two/lit
    ! grep -q ' 0.0 % lamps' err.txt || { cat err.txt; fail "the lamp lights nothing"; }
    awk 'NR == FNR { if (!/^#/) was[++n] = $8; next } !/^#/ { i++; if ($8 < was[i] * 0.999) exit 1; more += $8 > was[i] } END { exit !more }' \
        two/dark/irradiance.txt two/lit/irradiance.txt || fail "a lamp takes light away"
}

people_get_pictures_and_a_record()
{
    for name in two/points/irradiance two/face/irradiance/face-"$floor"; do
        grep -q '^shares none ' $name.light.txt || { cat $name.light.txt; fail "no shares"; }
        for n in 1 2 3; do "$B/bin/verify" --file $name.hemicube$n.jpg || fail "a picture of a hemicube is not whole"; done
    done
    for kind in white level unknown; do "$B/bin/verify" --file two/1/irradiance/"$view".$kind.jpg || fail "no picture $kind"; done
    grep -q '^level ' two/1/irradiance/"$view".light.txt || fail "the range of the colours is not stated"
    gather 0 points "${inputs[@]}" --points points.txt --hemicubes 0 --out made
    [ -z "$(find made -name '*.jpg')" ] || fail "pictures that nobody wanted"
    gather 2 'wanted a number from 0 to 9' "${inputs[@]}" --points points.txt --hemicubes 10 --out made
}

the_page_shows_the_light()
{
    local page=("$B/bin/report" --scene t --folder "$O" --shared "$O" --photos set/photos --stages gather_irradiance)
    rm -rf $O/relight
    "${page[@]}" --out dark/index.html
    ! grep -q 'id="light"' dark/page/numbers.html || fail "a section about light that is not there"
    cp -r two/1 $O/relight
    cp two/points/irradiance* $O/relight
    "${page[@]}" --out lit/index.html
    rm -rf $O/relight
    grep -q '<h4>View '"$view"'</h4>' lit/page/numbers.html && grep -q '<h4>Chosen points</h4>' lit/page/numbers.html || fail "the page lacks the light"
    grep -q 'Where this light comes from' lit/page/numbers.html || fail "the page lacks the shares"
}

# materials MODEL...: one, in the middle of the photo of the view, as fit_materials writes it
materials() { printf 'remodel-materials 1\nmaterial shiny %s\nregion shiny %s 48 32 80 32 80 64 48 64\n' "$1" "$view" >materials.txt; }

glossy_materials_reflect_and_bytes_do_not_depend_on_threads()
{
    local fast=(--set hemicube=4 --set target_error=0.3 --set rays=64)
    for e in 'phong 0.1 0.1 0.1 0.05 1' 'ward 0.1 0.1 0.1 0.3 0.05' 'phong 0.1 0.1 0.1 500 5000'; do
        materials "$e"
        for n in 1 2; do
            rm -rf two/gloss$n
            gather 0 'material shiny: ' "${inputs[@]}" --materials materials.txt --views $O/views "${fast[@]}" --view "$view" --specular --out two/gloss$n --threads $n
            grep -q ' pixels show a glossy material, [1-9]' err.txt || { cat err.txt; fail "nothing is glossy"; }
            gather 0 'mean share of glossy materials: ' "${inputs[@]}" --materials materials.txt --views $O/views "${fast[@]}" --points points.txt --out two/gloss$n --threads $n
        done
        diff -r two/gloss1 two/gloss2
        ! grep -qE 'nan|inf' two/gloss1/irradiance.txt || fail "$e: a number is none"
        "$B/bin/verify" --file two/gloss1/irradiance/"$view".exr || fail "$e: the picture is not whole"
        grep -qa 'specular.R' two/gloss1/irradiance/"$view".exr || fail "$e: no channel specular.R"
    done
    grep -q '^# input materials.txt ' two/gloss1/irradiance.txt || fail "the materials are not among the inputs"
}

materials_without_gloss_change_no_number()
{
    gather 0 points "${inputs[@]}" --points points.txt --out two/plain
    for e in 'lambert 0.1 0.1 0.1 0 0' 'phong 0.1 0.1 0.1 0 20'; do
        materials "$e"
        gather 0 'material shiny: ' "${inputs[@]}" --points points.txt --materials materials.txt --views $O/views --out two/dull
        cmp <(grep -v '^#' two/plain/irradiance.txt) <(grep -v '^#' two/dull/irradiance.txt) || fail "$e changes the light"
    done
}

make_gathers_at_points_and_views()
{
    m irradiance GATHER_POINTS=points.txt GATHER_VIEWS="$view"
    gather 0 points "${inputs[@]}" --things $O/things --points points.txt --out made
    cmp <(grep -v '^#' $O/relight/irradiance.txt) <(grep -v '^#' made/irradiance.txt) || fail "make gathers something else"
    grep -q '^# input things/volume.exr' $O/relight/irradiance.txt || fail "furniture does not reach the gather"
    [ -s $O/relight/irradiance/"$view".exr ] || fail "no picture"
    [ -s $O/relight/irradiance/"$view".light.txt ] || fail "no record of the light"
    find $O/relight -type f -printf '%p %T@\n' | LC_ALL=C sort >before
    m irradiance GATHER_POINTS=points.txt GATHER_VIEWS="$view"
    find $O/relight -type f -printf '%p %T@\n' | LC_ALL=C sort | diff before - || fail "a second make made something again"
    ! grep -q '^# input lights' $O/relight/irradiance.txt || fail "lights.txt was read, which nobody asked for"
    echo 'remodel-lamps 1' >scenes/t/lights.txt
    m irradiance GATHER_POINTS=points.txt
    grep -q '^# input lights' $O/relight/irradiance.txt || fail "marked lamps do not reach the gather"
    printf '[fit_materials]\npoints = 40\nviews = 4\nmax_clutter = 1\nedge = 0\n' >>scenes/t/scene.cfg
    printf 'remodel-marked-materials 1\nmaterial paint in %s 16 16 112 16 112 80 16 80\n' "$view" >scenes/t/materials.txt
    m irradiance GATHER_POINTS=points.txt GATHER_VIEWS="$view"
    grep -q '^# input lights/materials.txt' $O/relight/irradiance.txt || fail "marked materials do not reach the gather"
    grep -qa 'specular.R' $O/relight/irradiance/"$view".exr || fail "the view has no specular channels"
}

# calibrate CODE WORD LUX-LINE...: measurements of lux.txt in the room; a word on standard error
calibrate()
{
    local code=$1 word=$2 rc=0; shift 2
    { echo 'remodel-lux 1'; printf '%s\n' "$@"; } >lux.txt
    rm -f made.txt
    "$B/bin/calibrate_light" --records $O/photos --views $O/views "${inputs[@]:0:8}" --set estimator=hemicube --set hemicube=16 --marks lux.txt --out made.txt 2>err.txt || rc=$?
    [ "$rc" = "$code" ] || { cat err.txt; fail "$*: exit $rc, wanted $code"; }
    grep -qF -- "$word" err.txt || { cat err.txt; fail "$*: nothing says '$word'"; }
    [ "$code" = 0 ] || [ ! -e made.txt ] || fail "$*: a product was left"
}
scale_is() { awk -v wanted="$1" '/^scale / { exit !($2 / wanted > 0.999999 && $2 / wanted < 1.000001) }' made.txt || { cat made.txt; fail "the scale is not $1"; }; }

light_gets_an_absolute_scale()
{
    local face=floor photo light
    face=$(sed -nE "s/^face [0-9]+ ([^ ]*floor[^ ]*) 0 0 1 .*/\1/p" $O/model/model.txt | sed -n 1p)
    photo=$(awk -v v="$view" '$1 == v { print $2 }' $O/views/lenses.txt)
    m luminance
    grep -q '^from unknown' $O/lux/scale.txt || { cat $O/lux/scale.txt; fail "photos without exposures have a scale"; }
    calibrate 0 'from measurements' "illuminance floor 100 on $face"
    light=$(awk '/^measurement/ { print $5 }' made.txt)
    scale_is "$(awk -v l="$light" 'BEGIN { printf "%.12g", 100 / l }')"
    calibrate 0 'from measurements' "illuminance floor 250 on $face" "luminance wall $(awk -v l="$light" 'BEGIN { printf "%.12g", 250 / l }') in $photo 40 40 60 50 within 0"
    light=$(awk '/^measurement wall/ { print $5 }' made.txt)
    calibrate 0 'from measurements' "luminance wall $(awk -v l="$light" 'BEGIN { printf "%.12g", 77 * l }') in $photo 40 40 60 50"
    scale_is 77
    calibrate 0 'from measurements' "illuminance p 100 in $photo 50 60"
    calibrate 1 "lux.txt:2: the model has no face ${face}x; did you mean $face" "illuminance a 100 on ${face}x"
    calibrate 1 'lux.txt:2: pixel 4000 5 is not inside the photo' "illuminance a 100 in $photo 4000 5"
    calibrate 1 'lux.txt:2: found "nowhere"' "luminance a 100 in nowhere 4 5"
    ! "$B/bin/calibrate_light" --records $O/photos --views $O/views --vita $O/vita --out made.txt 2>err.txt || fail "a VITA without its model was accepted"
    grep -qF -- '--vita needs --model and --axes' err.txt || { cat err.txt; fail "nothing says what --vita needs"; }
    # make: a file of measurements that came is read, and read again when it changes
    printf 'remodel-lux 1\nilluminance floor 100 on %s\n' "$face" >scenes/t/lux.txt
    m luminance
    grep -q '^from measurements' $O/lux/scale.txt || { cat $O/lux/scale.txt; fail "lux.txt does not reach the scale"; }
    rm scenes/t/lux.txt
    m luminance
    grep -q '^from unknown' $O/lux/scale.txt || { cat $O/lux/scale.txt; fail "the scale kept what lux.txt said"; }
}

what_is_wrong_is_named()
{
    gather 2 'give one of --points FILE, --view NAME and --face ID' "${inputs[@]}" --out made
    gather 2 'needs --step' "${inputs[@]}" --face "$floor" --out made
    gather 2 'wanted a number above 0' "${inputs[@]}" --face "$floor" --step -1 --out made
    gather 2 'the model has no such face' "${inputs[@]}" --face 99999 --step 1 --out made
    gather 1 'give a larger step' "${inputs[@]}" --face "$floor" --step 1e-9 --out made
    gather 1 'has no view nowhere' "${inputs[@]}" --view nowhere --views $O/views --out made
    gather 2 'needs --views' "${inputs[@]}" --view "$view" --out made
    gather 2 '--materials needs --views' "${inputs[@]}" --points points.txt --materials materials.txt --out made
    gather 2 '--specular needs --view and --materials' "${inputs[@]}" --view "$view" --views $O/views --specular --out made
    printf 'remodel-materials 1\nmaterial a phong 1 1 1 1 9\nregion a nowhere 1 1 9 1 9 9\n' >elsewhere.txt
    gather 1 'elsewhere.txt:3: found "nowhere"' "${inputs[@]}" --points points.txt --materials elsewhere.txt --views $O/views --out made
    gather 2 'is odd' "${inputs[@]}" --set hemicube=31 --points points.txt --out made
    gather 1 'no-such' "${inputs[@]}" --points no-such.txt --out made
    gather 1 'no-such' "${inputs[@]}" --points points.txt --lights no-such.txt --out made
    echo '1 2 3 0 0 0' >bad.txt
    gather 1 'bad.txt:1' "${inputs[@]}" --points bad.txt --out made
    : >empty.txt
    gather 1 'has no points' "${inputs[@]}" --points empty.txt --out made
    gather 1 'orthogonal' --model $O/model/model.txt --axes $O/model/axes.txt --vita "$(dirname "$(ls $O/vdta/*/atlas.txt | sed -n 1p)")" --points points.txt --out made
    ! make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=t irradiance GATHER_POINTS=no-such >log 2>&1 || fail "GATHER_POINTS=no-such was accepted"
    ! make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=t irradiance >nothing 2>&1 || fail "irradiance of nothing was made"
    grep -qF 'There is nothing to gather' nothing || { cat nothing; fail "nothing says what to give"; }
    grep -qF 'GATHER_POINTS=no-such is no file' log || { cat log; fail "nothing names GATHER_POINTS"; }
}

for t in a_face_gets_points_at_a_step points_of_a_file_have_what_the_face_had bytes_do_not_depend_on_threads a_lamp_adds_light_and_is_reported people_get_pictures_and_a_record the_page_shows_the_light glossy_materials_reflect_and_bytes_do_not_depend_on_threads materials_without_gloss_change_no_number make_gathers_at_points_and_views light_gets_an_absolute_scale what_is_wrong_is_named; do run "$t"; done
