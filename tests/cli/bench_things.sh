# the bench of rooms that a seed decides: its rooms are described once, and its photos are spread over the walk
. tests/lib.sh
project rooms
B=$root/$B

# the functions of the bench, in its own project
bench()
{
    work=$scratch/work fast=$scratch/work
    mkdir -p "$work"
    # shellcheck disable=SC2317 # the bench calls it
    missing() { cat "$work/messages"; fail "$*"; }
    . "$root/tests/bench/things.sh"
    mkdir -p "$project/scenes"
}
times() { find "$project/scenes" -type f -printf '%P %T@\n' | LC_ALL=C sort; }

a_room_is_described_once()
{
    bench
    describe 1 made1
    [ -s "$project/scenes/made1/edits/moved.txt" ] || fail "there is no edit"
    grep -q '^PHOTOS := out/made1/simulated/photos$' "$project/scenes/made1/scene.mk" || { cat "$project/scenes/made1/scene.mk"; fail "the scene has another name"; }
    times >"$scratch/before"
    describe 1 made1
    times | cmp - "$scratch/before" || fail "the same room was written again"
    describe 2 made1
    ! times | cmp -s - "$scratch/before" || fail "another room was not written"
}

photos_are_at_even_steps()
{
    bench
    mkdir -p "$project/scenes/t"
    for i in 0 1 2 3 4 5 6 7; do echo "photo v$i fisheye 1 1 1.5  2 2 1"; done >"$project/scenes/t/cameras.txt"
    [ "$(photos_of t)" = "v0 v2 v4 v6 " ] || fail "photos: $(photos_of t)"
    [ "$(BENCH_PHOTOS=3 photos_of t)" = "v0 v2 v5 " ] || fail "three photos: $(BENCH_PHOTOS=3 photos_of t)"
}

every_edit_has_a_row_for_each_light()
{
    BENCH_SEEDS="1 7" bench
    [ "$(settings | wc -l)" = 9 ] || { settings; fail "wanted a line of names and eight rows"; }
    [ "$(settings | sed -n 6p)" = $'clear all\tmade7\told' ] || { settings; fail "another row"; }
    [ "$(edit_of 'clear all') $(edit_of moved)" = "bare moved" ] || fail "rows are of other edits"
}

for t in a_room_is_described_once photos_are_at_even_steps every_edit_has_a_row_for_each_light; do run "$t"; done
