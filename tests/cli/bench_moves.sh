# what the bench of camera moves stands on: ends of moves with their parallax and costs; and its table
. tests/lib.sh
project moves

made=$scratch/made
said() { awk -v k="$1" '$1 == k { print $2 }' "$scratch/said"; }
holds() { awk "BEGIN { exit !($1) }" || { cat "$scratch/said"; fail "$2: not $1"; }; }
make_layers() { [ -d "$made" ] || "$B/tests/bench/made_layers" --out "$made" --views 7 --width 96 --height 64 --side 8 2>"$scratch/err" || { cat "$scratch/err"; fail "no depth maps were made"; }; }
sampled() { make_layers; mkdir -p "$scratch/v"; "$B/bin/sample_validity" --views "$made/views" --depth "$made/depth" --effect establishing_dolly --out "$scratch/v" --set check_cells=0 --set grid=6 2>"$scratch/err" || { cat "$scratch/err"; fail "no valid viewpoints"; }; }
pairs() { "$B/tests/bench/move_pairs" --views "$made/views" --depth "$made/depth" --validity "$scratch/v/validity.txt" "$@" >"$scratch/said" 2>"$scratch/err" || { cat "$scratch/err"; return 1; }; }

ends_are_compared()
{
    sampled
    pairs --all; all=$(said chosen)
    for k in seconds core_s renders pairs; do holds "0$(said "$k") > 0" "$k"; done
    holds "$(said best) >= $all" "the best pair whatever its way"
    pairs --set refine=no; longest=$(said chosen); few=$(said pairs)
    pairs
    holds "$(said chosen) >= $all && $(said chosen) >= $longest && $few <= 12 && $(said valid)" "the chosen ends"
    grep -v -e '^seconds' -e '^core_s' "$scratch/said" >"$scratch/two"
    pairs --threads 1
    grep -v -e '^seconds' -e '^core_s' "$scratch/said" | cmp - "$scratch/two" || fail "other ends with another number of threads"
}

bench() { local rc=0; REPEATS=1 BENCH_OUT=$scratch/tables tests/bench/run moves "$B" >"$scratch/said" 2>"$scratch/err" || rc=$?; [ "$rc" = "$1" ] || { cat "$scratch/said" "$scratch/err"; fail "exit $rc, wanted $1"; }; }

a_small_scene_gets_its_table()
{
    make_layers
    BENCH_SCENES="$made nowhere" BENCH_FULL="" BENCH_SIDES="32 64" BENCH_CELLS=4 bench 0
    grep -qF 'nowhere is skipped' "$scratch/err" || fail "nothing says that a scene is skipped"
    t=$scratch/tables/moves.tsv
    [ "$(grep -vc '^#' "$t")" = 6 ] || { cat "$t"; fail "not a row a setting"; }
    head=$(sed -n '/^#/!{p;q}' "$t" | tr '\t' ' ')
    for w in series scene sweep value seconds core_s parallax chosen reached pairs renders limits; do [[ " $head " == *" $w "* ]] || fail "no column $w in $head"; done
}

the_bench_says_what_it_misses()
{
    BENCH_SCENES=nowhere bench 3
    grep -qF 'there is no scene; BENCH_SCENES' "$scratch/err" || fail "nothing says what is missing"
}

for t in ends_are_compared a_small_scene_gets_its_table the_bench_says_what_it_misses; do run "$t"; done
