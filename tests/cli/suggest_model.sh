# suggest_model: errors name file and reason; a failure leaves no script
. tests/lib.sh
project suggest
photos set --views 6 --size 320x240 >/dev/null
mkdir -p scenes/t
printf '[segment_depth]\nplanes = 48\n' >scenes/t/scene.cfg
make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=t axes >log 2>&1 || { cat log; fail "make axes"; }

# suggest CODE WORD ARGUMENT...: runs suggest_model; checks its exit status and a word on standard error
suggest()
{
    local code=$1 word=$2 rc=0; shift 2
    rm -rf made
    "$B/bin/suggest_model" --views "${views:-out/t/views}" --depth out/t/depth --points "${points:-out/t/points/points.ply}" --axes "${axes:-out/t/model/axes.txt}" --out made/suggested.txt "$@" >out.txt 2>err.txt </dev/null || rc=$?
    [ "$rc" = "$code" ] || { cat err.txt; fail "$*: exit $rc, wanted $code"; }
    grep -qF -- "$word" err.txt || { cat err.txt; fail "$*: nothing says '$word'"; }
    [ "$code" = 0 ] || grep -q 'suggest_model: error: .*[.?]$' err.txt || { cat err.txt; fail "$*: no sentence"; }
    [ "$code" = 0 ] || [ ! -e made/suggested.txt ] || fail "$*: a suggestion was left"
}

invalid_inputs_are_refused()
{
    suggest 1 'write the script by hand' # a floor and one wall
    grep -qF 'points.ply: no ' err.txt || { cat err.txt; fail "the file is not named"; }
    suggest 2 cell --set cell=2
    head -c 3000 out/t/points/points.ply >cut.ply
    points=cut.ply suggest 1 cut.ply
    points=nowhere.ply suggest 1 nowhere.ply
    sed 's/^rotation.*/rotation 1 1 0 0/' out/t/model/axes.txt >bent.txt
    axes=bent.txt suggest 1 bent.txt:
    views=nowhere suggest 1 nowhere
}

make_reports_why_there_is_no_suggestion()
{
    ! make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=t suggest >log 2>&1 || { cat log; fail "a plan of one wall"; }
    grep -q 'write the script by hand' log || { cat log; fail "no reason"; }
    [ ! -e out/t/model/suggested.txt ] || fail "a suggestion was left"
}

run invalid_inputs_are_refused
run make_reports_why_there_is_no_suggestion
