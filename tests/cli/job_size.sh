# how a job array is cut: from the stage's estimate, or as it always was where there is none
. tests/lib.sh
size() { common/run/job_size.sh "$@"; }
is() { [ "$1" = "$2" ] || fail "found \"$1\", wanted \"$2\": $3"; }

without_an_estimate_four_pieces_make_a_task_and_nothing_is_asked()
{
    is "$(size 1 '')" "4 0 0" "no estimate"
    is "$(size 1 9)" "9 0 0" "the user's number"
}
a_task_takes_ten_minutes()
{
    is "$(size 1 '' 10000 200000 100 0 20)" "30 256 31" "30 pieces of 20 s; three times ten minutes, and one"
    is "$(size 2 '' 10000 200000 100 0 20)" "60 256 31" "on two cores"
    is "$(size 1 '' 10000 9000000 100 0 900)" "1 256 46" "a piece that takes longer is a task"
}
a_small_job_is_spread()
{
    is "$(size 1 '' 9 9 100 0 1)" "4 256 10" "nine pieces"
    is "$(size 1 '' 160 160 100 0 1)" "10 256 10" "a sixteenth"
}
the_users_number_of_pieces_counts() { is "$(size 1 7 10000 200000 100 0 20)" "7 256 10" "VIEWS_PER_JOB=7"; }
the_longest_piece_sets_the_limit() { is "$(size 1 '' 10000 200000 100 0 100)" "30 256 151" "one of 100 s"; }
memory_is_that_of_the_largest_piece_and_a_quarter() { is "$(size 1 4 4 4 1000 0 1)" "4 1314 10" "1000 MiB"; }

for t in without_an_estimate_four_pieces_make_a_task_and_nothing_is_asked a_task_takes_ten_minutes a_small_job_is_spread \
    the_users_number_of_pieces_counts the_longest_piece_sets_the_limit memory_is_that_of_the_largest_piece_and_a_quarter; do run "$t"; done
