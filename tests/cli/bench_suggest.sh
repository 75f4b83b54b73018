# what the bench of suggested models measures: a plan against a true one
. tests/lib.sh
cd "$scratch" || exit 1
score() { "$root/$B/tests/bench/plan_score" "$@" 2>err.txt || { cat err.txt; fail "plan_score failed"; }; }
says() { grep -qx "$1" score.txt || { cat score.txt; fail "not printed: $1"; }; } # LINE

# A room of 4 by 3 m with a window and a passage; its west wall is OFF beyond its place, and its window UP.
plan() # OFF UP
{
    awk -v off="$1" -v up="$2" 'BEGIN {
        print "remodel-plan 2"
        printf "wall south normal 0 1 at 0 thickness 0.3 from %g to 4 foot 0 top 2.5 start corner east end corner west\n", -off
        print "wall east normal -1 0 at -4 thickness 0.3 from 0 to 3 foot 0 top 2.5 start corner north end corner south"
        printf "wall north normal 0 -1 at -3 thickness 0.3 from %g to 4 foot 0 top 2.5 start corner west end corner east\n", -off
        printf "wall west normal 1 0 at %g thickness 0.3 from 0 to 3 foot 0 top 2.5 start corner south end corner north\n", -off
        printf "window window1 on south from 1 %g to 2 %g closed\n", 1 + up, 2 + up
        print "passage door1 on east from 1 0 to 2 2 open"
        printf "room room1 floor 0 ceiling 2.5 0 0 south 4 0 east 4 3 north %g 3 west %g 0\n", -off, -off
    }'
}

a_plan_agrees_with_itself()
{
    plan 0 0 >true.txt
    score --truth true.txt --plan true.txt >score.txt
    says "walls 1"; says "walls_error 0"; says "rooms_found 1"; says "doors_found 1"; says "windows_found 1"; says "openings_error 0"; says "ceiling_error 0"
}

# The west wall, of 3 m, is 6 cm off: of 14 m there are 11 in both plans, and 17.12 in one or the other.
a_wall_that_is_off_counts_on_neither_side()
{
    plan 0 0 >true.txt
    plan 0.06 0 >off.txt
    score --truth true.txt --plan off.txt >score.txt
    says "walls 0.6425"; says "rooms_found 1"; says "doors_found 1"
    plan 0.04 0 >near.txt
    score --truth true.txt --plan near.txt >score.txt
    says "walls 0.9943"
}

# Half a metre up, a third of the rectangles' union is in both; a third of a metre up, half of it.
a_window_is_found_by_half_of_its_area()
{
    plan 0 0 >true.txt
    plan 0 0.5 >high.txt
    score --truth true.txt --plan high.txt >score.txt
    says "windows_found 0"; says "windows_suggested 1"; says "doors_found 1"
    plan 0 0.3 >higher.txt
    score --truth true.txt --plan higher.txt >score.txt
    says "windows_found 1"
}

# A quarter turn and a shift take the house's plan to the model's frame, where the same room is x from 0 to 4, y from 0 to 3.
the_plan_of_a_house_is_taken_to_the_frame_of_the_model()
{
    plan 0 0 >found.txt
    printf '%s\n' 'ceiling 2.5' 'room 0 -4 3 0' 'wall 0 -4.1 3 -4.1 0.20' 'door 1 -4.1 2 -4.1 0 2 open' 'window -0.1 -2 -0.1 -1 1 2' >house.txt
    printf '%s\n' 'remodel-axes 1' 'rotation 0.70710678118654757 0 0 0.70710678118654757' 'translation 0 0 0.01' 'scale 1 metres' 'ceiling 2.5' \
        'thickness none' 'error tilt 0.1' 'error heading 0.1' 'error floor 0.01' 'error ceiling 0.01' 'error scale 0.01' >axes.txt
    score --truth house.txt --axes axes.txt --plan found.txt >score.txt
    says "walls 1"; says "rooms_found 1"; says "windows_found 1"; says "doors_found 1"; says "floor_error 0.01"
}

run a_plan_agrees_with_itself
run a_wall_that_is_off_counts_on_neither_side
run a_window_is_found_by_half_of_its_area
run the_plan_of_a_house_is_taken_to_the_frame_of_the_model
