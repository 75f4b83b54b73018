# made_room: seeds make scenes, one of each shape, that `simulate` photographs, also edited and small; a seed repeats its bytes
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

# the same room in 12 or more of the photos, of 288 x 192 pixels, with marks in these, and walls by lines
small_rooms_have_fewer_and_smaller_photos()
{
    local s n
    for s in 1 2 3; do
        made "$s" "$scratch/room$s"
        "$B/tests/bench/made_room" --seed "$s" --small --out "$scratch/small$s" 2>"$scratch/err" || { cat "$scratch/err"; fail "seed $s made no small room"; }
        cmp "$scratch/room$s/scene.txt" "$scratch/small$s/scene.txt" || fail "seed $s made another room"
        [ "$(grep -v '^photo ' "$scratch/small$s/cameras.txt")" = "$(grep -v '^photo ' "$scratch/room$s/cameras.txt")" ] || fail "another lens"
        sed -n 's/^photo v[0-9]* //p' "$scratch/room$s/cameras.txt" >"$scratch/all"
        sed -n 's/^photo v[0-9]* //p' "$scratch/small$s/cameras.txt" | grep -vxFf "$scratch/all" && fail "a photo is none of the room's"
        n=$(grep -c '^photo ' "$scratch/small$s/cameras.txt")
        [ "$n" -ge 12 ] && [ "$n" -le 18 ] || fail "$n photos, wanted 12 to 18"
        grep -qx 'scale = 0.3' "$scratch/small$s/scene.cfg" && grep -qx 'camera_params = 128.000000000' "$scratch/small$s/scene.cfg" || { cat "$scratch/small$s/scene.cfg"; fail "another size"; }
        [ "$(grep -cE '^wall [a-z]+ (foot|top) in v' "$scratch/small$s/model.txt")" = "$(grep -c '^wall ' "$scratch/room$s/model.txt")" ] || { cat "$scratch/small$s/model.txt"; fail "a wall has no line"; }
        awk -v n="$n" '{ for (i = 1; i <= NF; i++) if ($i ~ /^v[0-9][0-9]$/) { if (substr($i, 2) + 0 >= n) bad = 1
            for (k = 1; k <= 4 && $(i + k) ~ /^[0-9.]+$/; k++) if (!($(i + k) > 0 && $(i + k) < (k % 2 ? 288 : 192))) bad = 1 } } END { exit bad }' \
            "$scratch/small$s"/{model,things,scale,lights}.txt || { cat "$scratch/small$s"/{model,things,lights}.txt; fail "a mark is outside of its photo"; }
    done
}

a_folder_needs_a_name()
{
    local rc=0
    "$B/tests/bench/made_room" --seed 1 --out "$scratch/" 2>"$scratch/err" || rc=$?
    [ "$rc" = 2 ] || fail "exit $rc, wanted 2"
    grep -q 'ends in a slash' "$scratch/err" || { cat "$scratch/err"; fail "another message"; }
}

for t in every_file_is_written a_seed_repeats rooms_are_photographed_before_and_after_edits small_rooms_have_fewer_and_smaller_photos a_folder_needs_a_name; do run "$t"; done
