# `make verify` names each file that is not as a run left it, back to the photos
. tests/lib.sh
project verify
photos set >/dev/null
small t
make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=t all >log 2>&1 || { cat log; fail "make"; }

verify() { "$root/$B/bin/verify" --scene out/t --run out/t >log 2>&1; }
# named FILE: verify fails, and names it
named()
{
    if verify; then cat log; fail "verify does not see that $1 was changed"; fi
    grep -qF "$1: " log || { cat log; fail "verify does not name $1"; }
}
# kept: every file that the ledger must know
kept()
{
    find out/t -type f ! -name '.*' ! -path 'out/t/log/*' ! -path '*/slice/*' ! -path '*/stamp/*' ! -path '*/graph/*'
    find scenes/t set/photos set/model -type f
}
# flip FILE AT: changes one byte; a second call changes it back
flip()
{
    local byte
    byte=$(od -An -tu1 -j"$2" -N1 "$1")
    # shellcheck disable=SC2059 # the byte itself
    printf "\\$(printf %03o $((byte ^ 1)))" | dd of="$1" bs=1 seek="$2" conv=notrunc status=none
}

all_is_as_it_was_made()
{
    make -s DEPS=manual SCENE=t verify >log 2>&1 || { cat log; fail "verify finds a fault"; }
    grep -qE '^out/t: [0-9]+ products, .*: all as they were made' log || { cat log; fail "no numbers"; }
    kept | LC_ALL=C sort >all
    awk 'NR > 1 && !/^end / { print $3 }' out/t/log/ledger.txt | LC_ALL=C sort >known
    missing=$(LC_ALL=C comm -23 all known)
    [ -z "$missing" ] || fail "the ledger does not know $missing"
}
# CHANGES=N: how many; tests/long/verify.sh makes a thousand
changed_bytes_are_named()
{
    local n=0 file at size
    kept | LC_ALL=C sort | awk -v n="${CHANGES:-40}" '{ f[NR] = $0 } END { srand(7); for (i = 0; i < n; i++) print f[1 + int(rand() * NR)], rand() }' >changes
    while read -r file at; do
        size=$(stat -c %s "$file")
        [ "$size" -gt 0 ] || continue
        at=$(awk -v s="$size" -v r="$at" 'BEGIN { printf "%d", s * r }')
        flip "$file" "$at"
        named "$file"
        flip "$file" "$at"
        n=$((n + 1))
    done <changes
    verify || { cat log; fail "the bytes are back, but verify finds a fault"; }
    echo "$n changes, each named"
}
a_file_that_is_gone_is_named()
{
    for f in out/t/depth/photo_2.exr scenes/t/scene.cfg set/photos/photo_3.jpg; do
        mv "$f" "$f.away"
        named "$f"
        mv "$f.away" "$f"
    done
}
the_ledger_itself_is_checked()
{
    cp out/t/log/ledger.txt ledger.txt
    for at in 3 40 2000 $(($(stat -c %s ledger.txt) - 9)); do
        flip out/t/log/ledger.txt "$at"
        if verify; then fail "byte $at of the ledger may change"; fi
        grep -qF out/t/log/ledger.txt log || { cat log; fail "verify does not name the ledger"; }
        cp ledger.txt out/t/log/ledger.txt
    done
}
a_product_of_before_breaks_the_chain()
{
    # the lenses are others now, and the ledger says so: only the chain can tell
    cp out/t/log/ledger.txt ledger.txt; cp out/t/views/lenses.txt lenses.txt
    cp out/t/views/cameras.txt out/t/views/lenses.txt
    mkdir -p out/t/log/ledger
    sed -n 's| out/t/views/cameras.txt$| out/t/views/lenses.txt|p' ledger.txt >out/t/log/ledger/x.txt
    "$root/$B/bin/verify" --gather --scene out/t
    if verify; then cat log; fail "the chain holds"; fi
    grep -q 'made it of views/lenses.txt as it no longer is' log || { cat log; fail "the chain is not named"; }
    mv lenses.txt out/t/views/lenses.txt; mv ledger.txt out/t/log/ledger.txt
}
a_run_after_an_edit_makes_it_whole_again()
{
    echo '# a remark' >>scenes/t/scene.cfg
    named scenes/t/scene.cfg
    rm out/t/depth/photo_1.exr
    make -s DEPS=manual SCENE=t all >log 2>&1 || { cat log; fail "make"; }
    verify || { cat log; fail "verify finds a fault after a run"; }
}
a_process_that_was_killed_leaves_a_product_that_holds()
{
    # it wrote its line, but was killed before the product was replaced
    mkdir -p out/t/log/ledger
    printf '%s segment_depth out/t/depth/photo_1.exr\n%s' 0123456789abcdef0123456789abcdef 'half a li' >out/t/log/ledger/killed.txt
    "$root/$B/bin/verify" --gather --scene out/t
    verify || { cat log; fail "the older product is not known"; }
}
a_scene_that_was_never_run_is_said()
{
    mkdir -p out/new
    if "$root/$B/bin/verify" --scene out/new 2>log; then fail "nothing is verified"; fi
    grep -q 'out/new/log/ledger.txt does not exist.*Run make' log || { cat log; fail "no sentence"; }
}

for t in all_is_as_it_was_made changed_bytes_are_named a_file_that_is_gone_is_named the_ledger_itself_is_checked \
    a_product_of_before_breaks_the_chain a_run_after_an_edit_makes_it_whole_again \
    a_process_that_was_killed_leaves_a_product_that_holds a_scene_that_was_never_run_is_said; do run $t; done
