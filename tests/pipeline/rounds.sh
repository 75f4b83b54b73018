# rounds of depth: which views a round estimates, what it carries over, and that both are reproducible
. tests/lib.sh
project rounds
photos set >/dev/null
small t
sed -i 's/^passes = 1/passes = 1\nrounds = 4\nmin_change = 0.02/' scenes/t/scene.cfg

run_scene() { make -s DEPS=manual SCENE=t "$@" 2>&1; }
folder_of() { [ "$1" = 4 ] && echo out/t/depth || echo "out/t/depth/round$1"; }
# item ROUND VIEW NAME: an item of the record of a view
item() { sed -n "s/^$3 //p" "$(folder_of "$1")/$2.round"; }
# estimated ROUND: how many views it estimated
estimated() { grep -lx 'estimated yes' "$(folder_of "$1")"/*.round | wc -l; }
made_of_depth() { (cd out/t/depth && find . -type f ! -name '.*' ! -name '*.d' | LC_ALL=C sort | xargs sha256sum); }

each_round_estimates_the_views_around_which_depth_changed()
{
    local k v n most carried=0 again=0
    make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=t depth >log 2>&1 || { cat log; fail "make depth"; }
    for v in photo_{1..6}; do
        [ "$(item 0 $v changed) $(item 0 $v estimated)" = "1 yes" ] || fail "$v did not begin with round 0"
        [ "$(item 1 $v estimated)" = yes ] || fail "$v was not estimated in round 1"
        for k in 2 3 4; do
            # the larger of its own change and the mean of its neighbours'; its own record is the first of $v.d
            most=$(for n in $(sed -nE "s|^.*/depth/round$((k - 1))/(.*)\.exr:\$|\1|p" "$(folder_of $k)/$v.d"); do item $((k - 1)) "$n" changed; done |
                awk 'NR == 1 { own = $1; next } { sum += $1 } END { mean = NR > 1 ? sum / (NR - 1) : 0; printf "%.9f", (own > mean ? own : mean) }')
            if awk "BEGIN { exit !($most < 0.02) }"; then
                carried=$((carried + 1))
                [ "$(item $k $v changed) $(item $k $v estimated)" = "0 no" ] || fail "round $k estimated $v, but nothing had changed by more than $most"
                cmp "$(folder_of $((k - 1)))/$v.exr" "$(folder_of $k)/$v.exr" && cmp "$(folder_of $((k - 1)))/$v.txt" "$(folder_of $k)/$v.txt" || fail "round $k changed what it carried over"
            else
                again=$((again + 1))
                [ "$(item $k $v estimated)" = yes ] || fail "round $k carried $v over, but a change of $most was near"
                awk -v c="$(item $k $v changed)" 'BEGIN { exit !(c >= 0 && c < 1) }' || fail "the change of $v in round $k is no share"
            fi
        done
    done
    [ $carried -gt 0 ] && [ $again -gt 0 ] || { head out/t/depth/*/*.round; fail "$carried views were carried over and $again estimated again; the test needs both"; }
}

the_run_says_how_many_views_each_round_estimated()
{
    grep -qx "depth: views estimated in each round: $(estimated 0), $(estimated 1), $(estimated 2), $(estimated 3), $(estimated 4), of 6." log || { cat log; fail "no such line"; }
    run_scene depth >log
    ! grep 'views estimated' log || fail "the line is there although nothing was made"
    [ -z "$(run_scene -n depth | grep run_stage)" ] || fail "make -n would make more depth"
    run_scene why | grep ' depth/\|/depth/' >why || true
    ! grep -E '^out/t/depth/[^ ]*: ' why || { cat why; fail "make why finds stale depth"; }
}

carried_depth_is_the_same_for_any_order_and_after_a_kill()
{
    local file
    made_of_depth >want
    rm -r out/t/depth
    run_scene -j3 CORES=3 depth >log || { cat log; fail "three jobs"; }
    made_of_depth | diff want - || fail "three jobs give other bytes"
    rm -r out/t/depth
    for file in round0/photo_3.exr round2/photo_2.exr round3/photo_5.exr photo_4.exr; do
        kill_at "out/t/depth/$file" make -s DEPS=manual SCENE=t CORES=1 depth
    done
    run_scene CORES=1 depth >log || { cat log; fail "resumed"; }
    made_of_depth | diff want - || fail "a resumed run gives other bytes"
    rm out/t/depth/round2/photo_2.round out/t/depth/photo_1.exr out/t/depth/round3/photo_4.txt
    run_scene depth >log || { cat log; fail "make after files were deleted"; }
    made_of_depth | diff want - || fail "other bytes come out after files were deleted"
}

the_least_change_is_a_parameter()
{
    sed -i 's/^min_change = .*/min_change = 0/' scenes/t/scene.cfg
    run_scene why >why
    grep -q 'min_change = 0$' why || { cat why; fail "make why does not show the new value"; }
    run_scene depth >log || { cat log; fail "make with min_change = 0"; }
    grep -qx 'depth: views estimated in each round: 6, 6, 6, 6, 6, of 6.' log || { cat log; fail "not all views were estimated in all rounds"; }
    sed -i 's/^min_change = .*/min_change = 1/' scenes/t/scene.cfg
    run_scene depth >log || { cat log; fail "make with min_change = 1"; }
    grep -qx 'depth: views estimated in each round: 6, 6, 0, 0, 0, of 6.' log || { cat log; fail "views that had changed by less than all pixels were estimated again"; }
    cmp out/t/depth/round1/photo_1.exr out/t/depth/photo_1.exr || fail "the depth of round 1 is not the result"
}

a_damaged_record_is_named()
{
    printf 'remodel-round 1\nchanged 2\n' >out/t/depth/round3/photo_2.round
    rm out/t/depth/photo_2.exr
    if run_scene depth >log; then fail "a damaged record was accepted"; fi
    grep -q 'round3/photo_2.round:2: found "2", wanted share of pixels, a number from 0 to 1' log || { cat log; fail "the message does not name the record"; }
    rm out/t/depth/round3/photo_2.round
    run_scene depth >log || { cat log; fail "make after the record was deleted"; }
}

for t in each_round_estimates_the_views_around_which_depth_changed the_run_says_how_many_views_each_round_estimated \
    carried_depth_is_the_same_for_any_order_and_after_a_kill the_least_change_is_a_parameter a_damaged_record_is_named; do run "$t"; done
