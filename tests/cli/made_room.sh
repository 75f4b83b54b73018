# made_room: seeds make scenes, one of each shape, that `simulate` photographs, also edited; the same seed makes the same bytes
. tests/lib.sh
made() { "$B/tests/bench/made_room" --seed "$1" --out "$2" 2>"$scratch/err" || { cat "$scratch/err"; fail "seed $1 made no room"; }; }
# a photo of a few pixels: SCENE OPTIONS...
shot()
{
    local scene=$1; shift
    "$B/bin/simulate" --scene "$scene" --out "$scratch/shots" --photo v00 --set scale=0.05 --set samples=1 "$@" 2>"$scratch/err" || { cat "$scratch/err"; fail "$scene $*"; }
}

every_file_is_written()
{
    local f s n
    for s in 1 2; do
        made "$s" "$scratch/room$s"
        for f in scene scene-bare scene-moved cameras model scale things lights scene-window edits/bare edits/moved edits/window; do [ -s "$scratch/room$s/$f.txt" ] || fail "there is no $f.txt"; done
        [ -s "$scratch/room$s/scene.mk" ] && [ -s "$scratch/room$s/scene.cfg" ] || fail "there are no settings"
        n=$(grep -c '^photo ' "$scratch/room$s/cameras.txt")
        [ "$n" -ge 20 ] && [ "$n" -le 26 ] || fail "$n photos, wanted 20 to 26"
    done
    ! cmp -s "$scratch/room1/scene.txt" "$scratch/room2/scene.txt" || fail "two seeds made the same room"
}

a_seed_repeats()
{
    made 3 "$scratch/a/room"; made 3 "$scratch/b/room"
    diff -r "$scratch/a" "$scratch/b" || fail "the same seed made other bytes"
}

rooms_are_photographed_before_and_after_edits()
{
    local s
    for s in 1 2 3; do # two rooms, a rectangle, an L
        made "$s" "$scratch/room$s"
        shot "$scratch/room$s"
        [ -s "$scratch/shots/photos/v00_e2.jpg" ] || fail "there is no photo"
        shot "$scratch/room$s" --edit bare
        shot "$scratch/room$s" --edit moved
        shot "$scratch/room$s" --edit window
        [ -s "$scratch/shots/truth/edited-window/hdr/v00.exr" ] && [ -s "$scratch/shots/truth/edited-bare/hdr/v00.exr" ] && [ -s "$scratch/shots/truth/edited-moved/hdr/v00.exr" ] || fail "there is no edited picture"
    done
}

a_folder_needs_a_name()
{
    local rc=0
    "$B/tests/bench/made_room" --seed 1 --out "$scratch/" 2>"$scratch/err" || rc=$?
    [ "$rc" = 2 ] || fail "exit $rc, wanted 2"
    grep -q 'ends in a slash' "$scratch/err" || { cat "$scratch/err"; fail "another message"; }
}

for t in every_file_is_written a_seed_repeats rooms_are_photographed_before_and_after_edits a_folder_needs_a_name; do run "$t"; done
