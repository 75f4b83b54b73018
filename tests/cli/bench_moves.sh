# the bench of camera moves: ends of moves with their parallax and cost, and its table
. tests/lib.sh
project moves

made=$scratch/made
value() { awk -v k="$1" '$1 == k { print $2 }' "$scratch/out"; }
holds() { awk "BEGIN { exit !($1) }" || { cat "$scratch/out"; fail "$2: not $1"; }; }
make_layers() { [ -d "$made" ] || "$B/tests/bench/made_layers" --out "$made" --views 7 --width 96 --height 64 --side 8 2>"$scratch/err" || { cat "$scratch/err"; fail "no depth maps were made"; }; }
sampled() { make_layers; mkdir -p "$scratch/v"; "$B/bin/sample_validity" --views "$made/views" --depth "$made/depth" --effect establishing_dolly --out "$scratch/v" --set check_cells=0 --set grid=6 2>"$scratch/err" || { cat "$scratch/err"; fail "no valid viewpoints"; }; }
pairs() { "$B/tests/bench/move_pairs" --views "$made/views" --depth "$made/depth" --validity "$scratch/v/validity.txt" "$@" >"$scratch/out" 2>"$scratch/err" || { cat "$scratch/err"; return 1; }; }

ends_are_compared()
{
    sampled
    pairs --all; all=$(value chosen)
    for k in seconds core_s renders pairs; do holds "0$(value "$k") > 0" "$k"; done
    holds "$(value best) >= $all" "the best pair, regardless of its path"
    pairs --set refine=no; longest=$(value chosen); few=$(value pairs)
    pairs
    holds "$(value chosen) >= $all && $(value chosen) >= $longest && $few <= 12 && $(value valid)" "the chosen ends"
    grep -v -e '^seconds' -e '^core_s' "$scratch/out" >"$scratch/two"
    pairs --threads 1
    grep -v -e '^seconds' -e '^core_s' "$scratch/out" | cmp - "$scratch/two" || fail "other ends with another number of threads"
}

bench() { local rc=0; REPEATS=1 BENCH_OUT=$scratch/tables tests/bench/run moves "$B" >"$scratch/out" 2>"$scratch/err" || rc=$?; [ "$rc" = "$1" ] || { cat "$scratch/out" "$scratch/err"; fail "exit $rc, wanted $1"; }; }

a_small_scene_gets_its_table()
{
    make_layers
    BENCH_SCENES="$made nowhere" BENCH_FULL="" BENCH_SIDES="32 64" BENCH_CELLS=4 bench 0
    grep -qF 'nowhere is skipped' "$scratch/err" || fail "no message that a scene is skipped"
    t=$scratch/tables/moves.tsv
    [ "$(grep -vc '^#' "$t")" = 6 ] || { cat "$t"; fail "wanted one row for each setting"; }
    head=$(sed -n '/^#/!{p;q}' "$t" | tr '\t' ' ')
    for w in series scene sweep value seconds core_s parallax chosen reached pairs renders limits; do [[ " $head " == *" $w "* ]] || fail "no column $w in $head"; done
}

missing_inputs_of_the_bench_are_named()
{
    BENCH_SCENES=nowhere bench 3
    grep -qF 'there is no scene; BENCH_SCENES' "$scratch/err" || fail "the message does not name what is missing"
    BENCH_SWEEPS=qualities BENCH_SCENES=nowhere bench 3
    grep -qF 'no scene of BENCH_SCENES has a scenes/NAME/scene.mk' "$scratch/err" || fail "the message does not name what is missing"
}

for t in ends_are_compared a_small_scene_gets_its_table missing_inputs_of_the_bench_are_named; do run "$t"; done
