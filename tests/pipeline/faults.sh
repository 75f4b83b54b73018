# a slice of tests/long/faults.sh: calls that fail, kills, lost memory and damaged inputs, in the first stages
. tests/lib.sh
. tests/faults/scene.sh
project faults

[ -x "$root/$B/tests/faults/campaign" ] || { echo "skip faults: the campaign is for x86-64"; exit 0; }
case $B in */asan | */arm64) echo "skip faults: the sanitizers have allocators of their own"; exit 0 ;; esac
photos set --views 3 --size 48x36 >/dev/null
mkdir -p scenes/t
printf 'PHOTOS := set/photos\nSFM := set/model\n' >scenes/t/scene.mk
: >scenes/t/scene.cfg
faults_record make -s DEPS=manual CORES=1 SCENE=t views >log 2>&1 || { cat log; fail "make views"; }
find recorded -type f ! -name 'import_photos.*' ! -name 'sfm_import.*' ! -name 'rectify.*' -delete
faults_inject 1 1
cat table.tsv

dozens_of_injections_were_made()
{
    local n
    n=$(awk 'END { for (i = 3; i <= NF; i++) n += $i; print n }' table.tsv)
    echo "# $n injections"
    [ "$n" -ge 60 ] || fail "only $n"
}

for t in dozens_of_injections_were_made $FAULT_TESTS; do run "$t"; done
