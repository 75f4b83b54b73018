# the walls suggested for a real house, from its true depth and from its photographs alone, against its layout (only where
# a developer has the data)
. tests/lib.sh
data=$root/../shared/data/zind-open
project suggest_house

# house SCENE: the photos with true depth, the true cameras, and the layout's frame, which is that of the cameras
house()
{
    mkdir -p photos
    for f in "$data"/truth/depth/*.exr; do ln -s "$data/photos/$(basename "$f" .exr).jpg" photos/; done
    make -s DEPS=manual QUALITY=draft SCENE="$1" PHOTOS=photos SFM="$data/sfm" DEPTH="$data/truth/depth" points >log 2>&1 || { cat log; fail "make points"; }
    printf '%s\n' 'remodel-axes 1' 'rotation 1 0 0 0' 'translation 0 0 0' 'scale 1 metres' 'ceiling 2.33' 'thickness none' \
        'error tilt 0.1' 'error heading 0.1' 'error floor 0.01' 'error ceiling 0.01' 'error scale 0.01' >axes.txt
    "$root/$B/bin/suggest_model" --views "out/$1+draft/views" --depth "out/$1+draft/depth" --points "out/$1+draft/points/points.ply" \
        --axes axes.txt --out suggested.txt 2>err.txt || { cat err.txt; fail "suggest_model"; }
}

# No true depth shows the kitchen, which has three of the thirteen walls.
three_quarters_of_the_walls_are_found()
{
    [ -e "$data/layout.json" ] || skip "the data of the house is not here"
    house house
    awk -f "$root/tests/long/suggest_score.awk" "$data/layout.json" axes.txt suggested.txt >table.tsv
    cat table.tsv
    awk -F'\t' '$8 == "yes" { found++ } $8 == "no" { missed++ } END { exit !(found >= 3 * missed && found) }' table.tsv || fail "$(tail -n 1 table.tsv)"
    "$root/$B/bin/build_model" --script suggested.txt --axes axes.txt --out built 2>err.txt || { cat err.txt; fail "the script does not build"; }
}

# Blank walls have few points: most of what is found comes from straight edges.
four_fifths_of_the_walls_are_found_from_photographs_alone()
{
    [ -e "$data/layout.json" ] || skip "the data of the house is not here"
    make -s DEPS=manual QUALITY=draft SCENE=empty PHOTOS="$data/photos" SFM="$data/sfm" suggest >log 2>&1 || { cat log; fail "make suggest"; }
    local model=out/empty+draft/model
    awk -f "$root/tests/long/suggest_score.awk" "$data/layout.json" $model/axes.txt $model/suggested.txt >table.tsv
    cat table.tsv
    awk -F'\t' '$8 == "yes" { found++ } $8 == "no" { missed++ } END { exit !(found >= 4 * missed && found) }' table.tsv || fail "$(tail -n 1 table.tsv)"
}

run three_quarters_of_the_walls_are_found
run four_fifths_of_the_walls_are_found_from_photographs_alone
