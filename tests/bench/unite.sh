# unite.sh - time of the union of walls into one mesh, by their number: a house of equal rooms with a window in each
# wall.
#
# `axes`: walls along the axes; `turned`: the house rotated by 30.3 degrees, so that all planes but floors are oblique.
# Only the union is timed, in one thread. Error: relative error of the volume. BENCH_WALLS ("100 300 1000 3000") sets
# others.
title="build_model: union of walls"
note="Four boxes per wall, around its window."
line=series label=walls
x=walls x_label="Walls" y=seconds y_label="Time of the union (s)"
timed="check_s triangulate_s"
slope="walls"

settings()
{
    printf 'series\twalls\n'
    for n in ${BENCH_WALLS:-100 300 1000 3000}; do printf 'axes\t%s\nturned\t%s\n' "$n" "$n"; done
}

prepare()
{
    [ -x "$B/tests/bench/unite" ] || missing "there is no program $B/tests/bench/unite; this revision cannot unite walls."
}

sample() # SERIES WALLS
{
    local turned=0
    [ "$1" = axes ] || turned=30.3
    measured "$B/tests/bench/unite" --walls "$2" --turned "$turned" | grep -v '^walls '
}
