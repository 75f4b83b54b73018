# fit_materials: regions on the walls of a room; threads; errors name file and line; what make makes again
. tests/lib.sh
project materials
photos set >/dev/null
boxed t textures
m() { make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=t "$@" >log 2>&1 || { cat log; fail "make $*"; }; }
printf '[bake_outdoors]\nheight = 64\n[fit_materials]\npoints = 40\nviews = 4\nmax_clutter = 1\nedge = 0\n' >>scenes/t/scene.cfg
O=out/t

marks() { printf 'remodel-marked-materials 1\n%s\n' "$1" >marks.txt; }

first_view() { view=$(ls $O/views/*.exr | sed -n 1p); view=${view##*/}; view=${view%.exr}; }

# fit CODE WORD ARGUMENT...: runs fit_materials; checks its exit status and a word on standard error
fit()
{
    local code=$1 word=$2 rc=0; shift 2
    rm -rf made
    "$B/bin/fit_materials" --marks marks.txt --model $O/model/model.txt --axes $O/model/axes.txt --views $O/views --ids $O/ids \
        --vita $O/vita --outdoors $O/outdoors/outdoors.exr --out made \
        --set points=40 --set views=4 --set max_clutter=1 --set edge=0 "$@" >out.txt 2>err.txt </dev/null || rc=$?
    [ "$rc" = "$code" ] || { cat err.txt; fail "$*: exit $rc, wanted $code"; }
    grep -qF -- "$word" err.txt || { cat err.txt; fail "$*: nothing says '$word'"; }
    [ "$code" = 0 ] || grep -q 'fit_materials: error: .*[.?]$' err.txt || { cat err.txt; fail "$*: no sentence"; }
    [ "$code" = 0 ] || [ ! -e made ] || [ -z "$(find made -type f ! -path 'made/materials/*')" ] || fail "$*: a product was left"
}

without_marks_make_says_so()
{
    m materials
    grep -q 'There is no scenes/t/materials.txt' log || { cat log; fail "no sentence"; }
}

make_fits_marked_regions()
{
    first_view
    printf 'remodel-marked-materials 1\nmaterial paint in %s 20 20 140 20 140 100 20 100\n' "$view" >scenes/t/materials.txt
    m materials
    grep -q '^material paint [a-z]* ' $O/lights/materials.txt || { cat $O/lights/materials.txt; fail "no material"; }
    ! grep -qiE 'nan|inf' $O/lights/materials.txt || fail "a number is not finite"
    ! grep -qF "$PWD" $O/lights/materials.txt || fail "the product names a folder of this machine"
    [ -s $O/lights/materials/paint.jpg ] && [ -s $O/lights/materials/samples.txt ] || fail "no picture or no samples"
    find $O/lights -type f -printf '%p %T@\n' >before
    m materials
    find $O/lights -type f -printf '%p %T@\n' | diff before - || fail "a second make made it again"
}

bytes_do_not_depend_on_threads()
{
    cp scenes/t/materials.txt marks.txt
    for n in 1 2; do
        fit 0 'material paint: ' --threads $n
        rm -rf "made$n"; mv made "made$n"
    done
    diff -r made1 made2
}

a_declared_model_is_fitted_or_refused_with_the_reason()
{
    first_view
    marks "material paint in $view 20 20 140 20 140 100 20 100 model lambert"
    fit 0 'declared'
    grep -q '^material paint lambert' made/materials.txt || fail "not the declared model"
    marks "material paint in $view 80 60 81 60 81 61 model ward"
    fit 1 'marks.txt:2: '
}

errors_say_what_is_wrong()
{
    first_view
    marks "material paint in nowhere 20 20 140 20 140 100"
    fit 1 "marks.txt:2: found \"nowhere\", wanted a photo's id or a view's name"
    marks "material paint in $view 20 20 1400 20 140 100"
    fit 1 'marks.txt:2: the corner 1400 20 is not inside the photo'
    marks "material paint in $view 20 20 140 20"
    fit 1 'three corners or more'
    marks "material paint in $view 20 20 140 20 140 100"
    fit 1 'no-such' --lights no-such.txt
    fit 1 'no view shows material paint free of clutter' --set min_angle=89
    fit 2 'points' --set points=0
}

for t in without_marks_make_says_so make_fits_marked_regions bytes_do_not_depend_on_threads a_declared_model_is_fitted_or_refused_with_the_reason errors_say_what_is_wrong; do run "$t"; done
