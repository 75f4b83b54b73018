# made_house: seeds make houses of any number of rooms, whose rooms can all be reached, and that `simulate` photographs
. tests/lib.sh
made() { "$B/tests/bench/made_house" "$@" >"$scratch/made" 2>"$scratch/err" || { cat "$scratch/err"; fail "no house of $*"; }; }
# refused WORDS OPTION...: exit status 2, and a sentence with these words
refused()
{
    local words=$1 rc=0; shift
    "$B/tests/bench/made_house" --seed 1 --out "$scratch/no" "$@" >/dev/null 2>"$scratch/err" || rc=$?
    [ "$rc" = 2 ] || fail "exit $rc, wanted 2: $*"
    grep -q -- "$words" "$scratch/err" || { cat "$scratch/err"; fail "another sentence: $*"; }
    [ ! -e "$scratch/no" ] || fail "a folder was left behind"
}

houses_of_all_sizes_have_what_was_asked()
{
    local rooms
    for rooms in 1 5 30; do
        made --seed 2 --rooms "$rooms" --views $((rooms * 6)) --out "$scratch/h$rooms"
        [ "$(grep -c '^room room' "$scratch/h$rooms/scene.txt")" = "$rooms" ] || fail "not $rooms rooms"
        [ "$(grep -c '^photo ' "$scratch/h$rooms/cameras.txt")" = $((rooms * 6)) ] || fail "not $((rooms * 6)) photos"
        "$B/bin/simulate" --scene "$scratch/h$rooms" --out "$scratch/s$rooms" --common --set irradiance_points=0 2>"$scratch/err" || { cat "$scratch/err"; fail "simulate refuses $rooms rooms"; }
    done
}
the_house_of_the_thesis_can_be_made()
{
    made --seed 1 --rooms 8 --views 460 --size 720x480 --exposures 3 --out "$scratch/thesis"
    [ "$(grep -c '^photo ' "$scratch/thesis/cameras.txt")" = 460 ] || fail "not 460 photos"
    [ ! -s "$scratch/err" ] || ! grep -q warning "$scratch/err" || { cat "$scratch/err"; fail "a warning"; }
}
# from the first room through doors and passages, by plan.txt
every_room_can_be_reached()
{
    local seed
    for seed in 1 2 3; do
        made --seed $seed --rooms 12 --views 2 --out "$scratch/r$seed"
        awk '
            $1 == "room" { n++; x0[n] = $2; y0[n] = $3; x1[n] = $4; y1[n] = $5 }
            $1 == "door" { d++; x[d] = ($2 + $4) / 2; y[d] = ($3 + $5) / 2 }
            END {
                reached[1] = 1
                for (pass = 1; pass <= n; pass++) for (k = 1; k <= d; k++) {
                    c = 0
                    for (i = 1; i <= n; i++) if (x[k] > x0[i] - 0.2 && x[k] < x1[i] + 0.2 && y[k] > y0[i] - 0.2 && y[k] < y1[i] + 0.2) of[++c] = i
                    if (c == 2 && (reached[of[1]] || reached[of[2]])) reached[of[1]] = reached[of[2]] = 1
                }
                for (i = 1; i <= n; i++) if (!reached[i]) { print "room " i " cannot be reached"; exit 1 }
            }' "$scratch/r$seed/plan.txt" || fail "seed $seed"
    done
}
photos_stand_in_rooms()
{
    made --seed 3 --rooms 8 --views 112 --out "$scratch/p"
    awk 'FNR == NR { if ($1 == "room") { n++; x0[n] = $2; y0[n] = $3; x1[n] = $4; y1[n] = $5 } else if ($1 == "door" || $1 == "bay") { n++; x0[n] = $2 - 0.8; y0[n] = $3 - 0.8; x1[n] = $4 + 0.8; y1[n] = $5 + 0.8 } next }
        $1 == "photo" { in_one = 0; for (i = 1; i <= n; i++) in_one = in_one || ($4 > x0[i] && $4 < x1[i] && $5 > y0[i] && $5 < y1[i]); if (!in_one) { print; exit 1 } }' \
        "$scratch/p/plan.txt" "$scratch/p/cameras.txt" || fail "a photo is taken in a wall"
}
a_seed_repeats()
{
    made --seed 4 --rooms 5 --views 20 --out "$scratch/a/house"; made --seed 4 --rooms 5 --views 20 --out "$scratch/b/house"
    diff -r "$scratch/a" "$scratch/b" || fail "the same seed made other bytes"
    made --seed 5 --rooms 5 --views 20 --out "$scratch/c/house"
    ! cmp -s "$scratch/a/house/scene.txt" "$scratch/c/house/scene.txt" || fail "two seeds made the same house"
}
a_house_is_photographed()
{
    made --seed 6 --rooms 3 --views 9 --size 64x64 --exposures 1 --out "$scratch/t"
    "$B/bin/simulate" --scene "$scratch/t" --out "$scratch/shots" --photo v000 --set samples=1 2>"$scratch/err" || { cat "$scratch/err"; fail "no photo"; }
    [ -s "$scratch/shots/photos/v000.jpg" ] || fail "simulate wrote no photo"
}
wrong_numbers_are_refused()
{
    refused '--rooms 31: wanted 1 to 30' --rooms 31
    refused '--views 1: wanted at least 2' --views 1
    refused '--exposures 2: wanted 1 or 3' --exposures 2
    refused '--size 720: wanted WIDTHxHEIGHT' --size 720
}

for t in houses_of_all_sizes_have_what_was_asked the_house_of_the_thesis_can_be_made every_room_can_be_reached photos_stand_in_rooms \
    a_seed_repeats a_house_is_photographed wrong_numbers_are_refused; do run $t; done
