# suggest_model: errors name file and reason; a failure leaves no script
. tests/lib.sh
project suggest
photos set --views 6 --size 320x240 >/dev/null
mkdir -p scenes/t
printf '[segment_depth]\nplanes = 48\npasses = 1\nrounds = 0\nneighbours = 3\n' >scenes/t/scene.cfg
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
    suggest 2 cell --set cell=2
    head -c 3000 out/t/points/points.ply >cut.ply
    points=cut.ply suggest 1 cut.ply
    points=nowhere.ply suggest 1 nowhere.ply
    sed 's/^rotation.*/rotation 1 1 0 0/' out/t/model/axes.txt >bent.txt
    axes=bent.txt suggest 1 bent.txt:
    views=nowhere suggest 1 nowhere
}

# builds FILE: build_model accepts the script
builds() { "$B/bin/build_model" --script "$1" --axes out/t/model/axes.txt --out built 2>err.txt || { cat err.txt; fail "$1 does not build"; }; }

make_suggests_what_there_is() # a floor and one wall
{
    make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=t suggest >log 2>&1 || { cat log; fail "make suggest"; }
    local script=out/t/model/suggested.txt
    [ "$(head -n 1 $script)" = 'remodel-script 1' ] || fail "the first line is not the script's"
    grep -q '^wall .* from ' $script || { cat $script; fail "the wall is missing"; }
    grep -q '^# .*: confidence 0\.[0-9]*; .* was seen' $script || { cat $script; fail "no confidence"; }
    grep -q '^# the start of .* is joined to nothing' $script || { cat $script; fail "the missing join is not mentioned"; }
    grep -q '^# room1, .* is not closed' $script || { cat $script; fail "the open room is not mentioned"; }
    ! grep -q '^room ' $script || fail "a room of one wall"
    [ "$(grep -n '^# Made by' $script | cut -d: -f1)" -gt "$(grep -n '^wall' $script | tail -n 1 | cut -d: -f1)" ] || fail "the provenance is not last"
    [ "$(tail -n 1 out/t/model/suggested.svg)" = '</svg>' ] || fail "the picture is not whole"
    grep -q 'class="wall"' out/t/model/suggested.svg || fail "the picture has no wall"
    grep -q 'class="doubt"' out/t/model/suggested.svg || fail "the picture has no doubt"
    builds $script
}

# empty FILE: points.ply without points
empty()
{
    local header
    header=$(grep -a -n -m 1 '^end_header' out/t/points/points.ply | cut -d: -f1)
    head -n "$header" out/t/points/points.ply | sed 's/^element vertex .*/element vertex 0/' >"$1"
}

without_points_there_is_a_script_of_comments()
{
    empty none.ply
    points=none.ply suggest 0 '0 walls'
    grep -q '^# Nothing was found: points.ply has no points' made/suggested.txt || { cat made/suggested.txt; fail "no reason"; }
    ! grep -qv -e '^#' -e '^set ' -e '^remodel-script 1' -e '^$' made/suggested.txt || { cat made/suggested.txt; fail "more than comments"; }
}

the_same_bytes_for_any_number_of_threads()
{
    for n in 1 3; do
        suggest 0 walls --threads $n --picture made/plan.svg
        mkdir -p kept/$n; mv made/suggested.txt made/plan.svg kept/$n
    done
    cmp kept/1/suggested.txt kept/3/suggested.txt && cmp kept/1/plan.svg kept/3/plan.svg || fail "other bytes"
}

run invalid_inputs_are_refused
run make_suggests_what_there_is
run without_points_there_is_a_script_of_comments
run the_same_bytes_for_any_number_of_threads
