# thousands of calls that fail, kills, lost memory and damaged inputs, in every stage's program (tests/faults/campaign.c)
. tests/lib.sh
. tests/faults/scene.sh
project faults

[ -x "$root/$B/tests/faults/campaign" ] || { echo "skip faults: the campaign is for x86-64"; exit 0; }
case $B in */asan | */arm64) echo "skip faults: the sanitizers have allocators of their own"; exit 0 ;; esac
faults_describe
faults_record faults_make
faults_inject "${FAULT_EACH:-3}" "${FAULT_INPUTS:-3}"
cp table.tsv details.tsv "$root/$B/tests/"
cat table.tsv

every_stage_took_part()
{
    local stage
    for stage in "$root"/stages/*/; do
        stage=$(basename "$stage")
        grep -q "^$stage	" table.tsv || fail "no program of $stage was run"
    done
}
at_least_five_thousand_injections_were_made()
{
    local n
    n=$(awk 'END { for (i = 3; i <= NF; i++) n += $i; print n }' table.tsv)
    echo "# $n injections"
    [ -n "${FAULT_EACH-}" ] || [ "$n" -ge 5000 ] || fail "only $n"
}

for t in every_stage_took_part at_least_five_thousand_injections_were_made $FAULT_TESTS; do run "$t"; done
