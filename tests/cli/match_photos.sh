# extract_features and match_photos: masks, damaged photos, and what is kept of an earlier run.
. tests/lib.sh
photos "$scratch/set" --views 4 --size 160x120 >/dev/null
cd "$scratch" || exit 1
export PATH=$root/$B/bin:$PATH
import_photos --photos set/photos --out records 2>err || { cat err; fail "import"; }
features() { extract_features --photos set/photos --records records --photo "$1" --out "${2-features}/$1.txt" "${@:3}" 2>err || { cat err; fail "features of $1"; }; }
matches_of() { match_photos --pairs pairs.txt --features features --photo "$1" --out "$2/$1.txt" "${@:3}" 2>err || { cat err; fail "matches of $1"; }; }
for p in photo_1 photo_2 photo_3 photo_4; do features $p; done
choose_pairs --records records --features features --out pairs.txt 2>err || { cat err; fail "pairs"; }
count() { sed -n 's/^features \([0-9]*\) .*/\1/p' "$1"; }

features_are_the_same_for_any_number_of_threads()
{
    features photo_1 one --threads 1
    features photo_1 two --threads 2
    cmp one/photo_1.txt two/photo_1.txt && cmp one/photo_1.txt features/photo_1.txt || fail "other bytes"
    [ "$(count one/photo_1.txt)" -gt 20 ] || fail "hardly a feature"
}

the_largest_features_are_kept()
{
    features photo_1 few --set max_features=100
    n=$(count features/photo_1.txt); n=$((n < 100 ? n : 100))
    [ "$(count few/photo_1.txt)" = "$n" ] || fail "wanted $n features, found $(count few/photo_1.txt)"
    diff <(grep '^feature ' features/photo_1.txt | sed -n "1,${n}p") <(grep '^feature ' few/photo_1.txt) >/dev/null || fail "others are kept"
}

a_mask_hides_features()
{
    mkdir -p masks
    painted masks/photo_1.png 40 30
    features photo_1 masked --masks masks
    [ "$(count masked/photo_1.txt)" -lt "$(count features/photo_1.txt)" ] || fail "as many features as without a mask"
    awk '$1 == "feature" && $2 >= 40 && $2 < 70 && $3 >= 30 && $3 < 55 { bad++ } END { exit bad > 0 }' masked/photo_1.txt || fail "a feature under the mask"
    grep -q '^# input masks/photo_1.png ' masked/photo_1.txt || fail "the mask is not in the provenance"
}

a_damaged_photo_has_no_features_and_a_warning()
{
    cp set/photos/photo_1.jpg keep.jpg
    head -c 2000 keep.jpg >set/photos/photo_1.jpg
    features photo_1 damaged
    cp keep.jpg set/photos/photo_1.jpg
    [ "$(count damaged/photo_1.txt)" = 0 ] && grep -q 'warning: .*photo_1.jpg.* It has no features' err || { cat err; fail "no warning"; }
}

a_photo_is_matched_with_later_ones()
{
    matches_of photo_2 all
    [ "$(awk '$1 == "pair" { print $2 }' all/photo_2.txt | tr '\n' ' ')" = "photo_3 photo_4 " ] || { grep pair all/photo_2.txt; fail "other pairs"; }
    matches_of photo_4 all
    ! grep -q '^pair' all/photo_4.txt || fail "the last photo has a pair"
    awk '$1 == "pair" && $4 < 15 { bad++ } END { exit bad > 0 }' all/photo_2.txt || { grep pair all/photo_2.txt; fail "hardly a match"; }
}

kept_pairs_give_the_bytes_of_a_first_run()
{
    matches_of photo_1 all
    cp -r all kept
    features photo_3 other --set max_features=100
    cp features/photo_3.txt keep.txt
    cp other/photo_3.txt features/
    matches_of photo_1 kept
    grep -q 'photo_1: matched with 1 photos, kept 2' err || { cat err; fail "another number of pairs was kept"; }
    matches_of photo_1 anew
    cmp kept/photo_1.txt anew/photo_1.txt || fail "other bytes than of a first run"
    cp keep.txt features/photo_3.txt
    matches_of photo_1 kept
    cmp kept/photo_1.txt all/photo_1.txt || fail "the old features do not give the old bytes"
    matches_of photo_1 kept --set max_ratio=0.7
    grep -q 'matched with 3 photos, kept 0' err || { cat err; fail "matches with other limits were kept"; }
    touch -d 2020-01-01 kept/photo_1.txt
    matches_of photo_1 kept
    grep -q 'matched with 3 photos, kept 0' err || { cat err; fail "matches of an older program were kept"; }
    echo garbage >kept/photo_1.txt
    matches_of photo_1 kept
    cmp kept/photo_1.txt all/photo_1.txt || fail "a damaged file was not made anew"
}

unknown_photos_are_refused()
{
    rc=0; match_photos --pairs pairs.txt --features features --photo nobody --out x.txt 2>err || rc=$?
    [ "$rc" != 0 ] && grep -q nobody err && [ ! -e x.txt ] || { cat err; fail "exit $rc"; }
}

large_sets_compare_neighbours_and_what_looks_alike()
{
    pairs() { choose_pairs --records records --features features --out "$1.txt" "${@:2}" 2>err || { cat err; fail "pairs"; }; }
    [ "$(grep -c '^pair ' pairs.txt)" = 6 ] || { cat pairs.txt; fail "wanted all pairs of four photos"; }
    pairs similar --set matcher=similar --threads 1
    pairs again --set matcher=similar --threads 2
    cmp similar.txt again.txt || fail "other pairs with two threads"
    [ "$(grep -c '^pair ' similar.txt)" = 6 ] || { cat similar.txt; fail "wanted all pairs of four neighbours"; }
    grep -q '^# input features/photo_4.txt' similar.txt || fail "the features are not in the provenance"
}

for t in large_sets_compare_neighbours_and_what_looks_alike features_are_the_same_for_any_number_of_threads the_largest_features_are_kept a_mask_hides_features \
    a_damaged_photo_has_no_features_and_a_warning a_photo_is_matched_with_later_ones kept_pairs_give_the_bytes_of_a_first_run \
    unknown_photos_are_refused; do run $t; done
