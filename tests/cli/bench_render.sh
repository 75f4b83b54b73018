# the bench of renderers: frames of held-out cameras with their times, flattened depth, synthetic depth maps, and its table
. tests/lib.sh
project rendering
export DEPS=manual
photos set --size 320x240 >/dev/null
small t
printf 'PHOTOS := set/photos\nSFM := set/model\n' >scenes/t/scene.mk

made=$scratch/made
rate() { "$B/tests/bench/render_rate" "$@" >"$scratch/out" 2>"$scratch/err" || { cat "$scratch/err"; return 1; }; }
value() { awk -v k="$1" '$1 == k { print $2 }' "$scratch/out"; }
holds() { awk "BEGIN { exit !($1) }" || fail "$2: not $1"; }
wants() { grep -qF -- "$1" "$scratch/err" || { cat "$scratch/err"; fail "the message does not have '$1'"; }; }
same() { [[ $("$B/tests/bench/picture_error" "$1" "$2") == "error 0"$'\n'* ]] || fail "$1 and $2 differ"; }
make_layers() { "$B/tests/bench/made_layers" --out "$made" --views 7 --width 96 --height 64 2>"$scratch/err" || { cat "$scratch/err"; fail "no depth maps were made"; }; }

frames_are_timed_and_written()
{
    make_layers; mkdir "$scratch/whole" "$scratch/half"
    for r in fast offline; do
        rate --views "$made/views" --depth "$made/depth" --cameras "$made/cameras" --set renderer=$r --out "$scratch/whole"
        for k in seconds frames_per_s core_ms core_s_per_mp peak_mib; do holds "0$(value $k) > 0" "$k"; done
        holds "$(value frames_per_s) * $(value seconds) > 0.999 && $(value frames_per_s) * $(value seconds) < 1.001" "frames a second"
        holds "$(value core_s_per_mp) * 96 * 64 * 1e-3 / $(value core_ms) > 0.999 && $(value core_s_per_mp) * 96 * 64 * 1e-3 / $(value core_ms) < 1.001" "a megapixel's time"
        holds "$(value holes) < 1" "holes"
        "$B/bin/render_views" --views "$made/views" --depth "$made/depth" --cameras "$made/cameras" --renderer $r --out "$scratch/stage" 2>/dev/null
        same "$scratch/whole/v00.exr" "$scratch/stage/v00.exr"
    done
    rate --views "$made/views" --depth "$made/depth" --cameras "$made/cameras" --coverage
    holds "$(value holes) < 1 && 0$(value seconds) > 0" "coverage"
    # rendered at half size and enlarged: the same size, and a small error
    rate --views "$made/views" --depth "$made/depth" --cameras "$made/cameras" --scale 0.5 --out "$scratch/half"
    holds "$("$B/tests/bench/picture_error" "$scratch/half/v00.exr" "$scratch/whole/v00.exr" | awk '{ printf "%s ", $2 }' | awk '{ print "(" $1 " > 0 && " $1 " < 0.5 && " $3 " == 6144)" }')" "an enlarged frame"
}

segments_are_flattened_at_their_middle()
{
    make_layers
    "$B/tests/bench/flatten_depth" --views "$made/views" --depth "$made/depth" --out "$scratch/flat" 2>"$scratch/err" || { cat "$scratch/err"; fail "nothing was flattened"; }
    [ "$(ls "$scratch/flat" | wc -l)" = 14 ] || fail "wanted an EXR and a text file for each view"
    # the first segment is 11 x 11 px; half of its last column and row belongs to its neighbours, the corner to the column's
    awk '/^#/ || NF != 7 { next }
        FNR == NR { a[$1] = $3; b[$1] = $4; c[$1] = $5; next }
        { n++; if ($3 != 0 || $4 != 0) exit 1 }
        $1 == 1 { w = 10 * 10 + 21 / 2; u = (100 * 5 + 10.5 * 11 / 2 + (5 * 10) / 2) / w; v = (100 * 5 + 10.5 * 10 / 2 + (5.5 * 11) / 2) / w
            d = (a[1] * u + b[1] * v + c[1]) / $5 - 1; if (d * d > 1e-12) exit 1 }
        END { if (n != 54) exit 1 }' "$made/depth/v03.txt" "$scratch/flat/v03.txt" || fail "a segment is not flat, or not at the depth of its middle"
    rate --views "$made/views" --depth "$scratch/flat" --cameras "$made/cameras"
}

wrong_usage_gives_a_message()
{
    make_layers
    for args in "--depth $made/depth" "--depth $made/depth --cameras $made/cameras --photo" "--cameras $made/cameras" "--depth $made/depth --cameras $made/cameras --coverage --out $scratch"; do
        rc=0; rate --views "$made/views" $args >"$scratch/none" || rc=$?
        [ "$rc" = 1 ] || fail "'$args' was accepted"; wants "wanted --depth with either"
    done
    ! rate --views "$made/views" --depth "$made/depth" --path "$made/cameras" --frames 0 >"$scratch/none" || fail "no frame was accepted"
    wants "--frames 0"
    ! "$B/tests/bench/made_layers" --out "$made" --views 0 2>"$scratch/err" || fail "no view was accepted"
    wants "--views 0"
}

bench() { local rc=0; REPEATS=1 BENCH_OUT=$scratch/tables BENCH_DATA=$scratch/none tests/bench/run render "$B" >"$scratch/out" 2>"$scratch/err" || rc=$?; [ "$rc" = "$1" ] || { cat "$scratch/out" "$scratch/err"; fail "exit $rc, wanted $1"; }; }
# cell SERIES VALUE COLUMN
cell() { awk -F'\t' -v s="$1" -v v="$2" -v c="$3" '/^#/ { next } !n { n = NF; for (i = 1; i <= n; i++) if ($i == c) at = i; next } $1 == s && $4 == v { print $at }' "$scratch/tables/render.tsv"; }

a_small_scene_gets_its_table()
{
    BENCH_SCENES="t:photo_3 nowhere" BENCH_SWEEPS=filling bench 0
    wants "nowhere is skipped"
    t=$scratch/tables/render.tsv
    [ "$(grep -vc '^#' "$t")" = 8 ] || { cat "$t"; fail "wanted one row for each setting"; }
    head=$(sed -n '/^#/!{p;q}' "$t" | tr '\t' ' ')
    for w in series scene sweep value seconds peak_mib core_s_per_mp psnr ssim holes gain; do [[ " $head " == *" $w "* ]] || fail "no column $w in $head"; done
    [ "$(cell 'hard z' - gain)" = 0.00 ] && [ "$(cell 'hard z' - ratio)" = 1.000 ] || { cat "$t"; fail "hard z is not the baseline"; }
    for r in fast offline; do
        holds "$(cell $r on psnr) > $(cell 'nearest photo' - psnr)" "$r over the nearest photo"
        d="$(cell $r on psnr) - $(cell 'hard z' - psnr) - $(cell $r on gain)"
        holds "($d) < 0.01 && ($d) > -0.01" "the gain of $r"
        [ "$(cell $r on holes)" = "$(cell $r off holes)" ] || fail "filling changes the holes of $r"
    done
    [ "$(cell 'nearest photo' - core_s_per_mp)" = - ] || fail "the nearest photo was rendered"
    # the same from the stages themselves
    "$B/bin/render_views" --views out/t+holdout/views --depth out/t+holdout/depth --cameras out/t+holdout/holdout/views --out out/t+holdout/holdout/frames 2>"$scratch/err"
    "$B/bin/evaluate" --folder out/t+holdout --shared out/t --out out/t+holdout/metrics.tsv 2>"$scratch/err"
    [ "$(cell offline on psnr)" = "$(awk -F'\t' '$1 == "holdout.psnr" { printf "%.5g", $2 }' out/t+holdout/metrics.tsv)" ] || { cat "$t" out/t+holdout/metrics.tsv; fail "the PSNR differs from that of the stages"; }
}

the_nearest_photo_of_a_view_is_the_view_itself()
{
    [ -d out/t+holdout/views ] || skip "the bench made no views"
    mkdir "$scratch/photo"
    rate --views out/t+holdout/views --cameras out/t+holdout/views --photo --out "$scratch/photo"
    for v in photo_1 photo_5; do same "$scratch/photo/$v.exr" "out/t+holdout/views/$v.exr"; done
    rate --views out/t+holdout/views --cameras out/t+holdout/holdout/views --photo --out "$scratch/photo"
    "$B/tests/bench/picture_error" "$scratch/photo/photo_3.exr" out/t+holdout/views/photo_2.exr | matches '^error 0$' ||
        "$B/tests/bench/picture_error" "$scratch/photo/photo_3.exr" out/t+holdout/views/photo_4.exr | matches '^error 0$' || fail "the held-out view is not shown by a neighbour"
}

settings_are_chosen_on_the_other_scenes()
{
    # a second scene, whose truth has a view that nobody photographed: what photo_3 shows
    [ -e out/t+holdout/holdout/views/photo_3.exr ] || skip "the bench made no views"
    small u
    sed -i 's/^passes = 1$/passes = 0\nrounds = 0/' scenes/u/scene.cfg
    echo 'SFM := set/model' >scenes/u/scene.mk
    local data=$scratch/data/u
    mkdir -p "$data/truth/novel/hdr"
    ln -s "$PWD/set/photos" "$data/photos"
    cp set/model/{cameras,images}.txt "$data/truth/"
    cp set/model/cameras.txt "$data/truth/novel/"
    awk '$10 == "photo_3.jpg" { $10 = "new.jpg"; print; print "" }' set/model/images.txt >"$data/truth/novel/images.txt"
    cp out/t+holdout/holdout/views/photo_3.exr "$data/truth/novel/hdr/new.exr"
    local code=0
    REPEATS=1 BENCH_OUT=$scratch/tables BENCH_DATA=$scratch/data BENCH_SCENES="t:photo_3 u" BENCH_SWEEPS=candidates BENCH_CANDIDATES="renderer=fast soft_z=2,more_views=0" BENCH_BY_PHOTO=t \
        tests/bench/run render "$B" >"$scratch/out" 2>"$scratch/err" || code=$?
    [ "$code" = 0 ] || { cat "$scratch/out" "$scratch/err"; fail "exit $code"; }
    t=$scratch/tables/render.tsv
    [ "$(grep -vc '^#' "$t")" = 7 ] || { cat "$t"; fail "wanted one row for each scene and candidate"; }
    wants "no plot was drawn"
    # of(SCENE, SETTING, COLUMN) of the table
    of() { awk -F'\t' -v s="$1" -v v="$2" -v c="$3" '/^#/ { next } !n { n = NF; for (i = 1; i <= n; i++) if ($i == c) at = i; next } $2 == s && $4 == v { printf "%.2f", $at }' "$t"; }
    chosen=$scratch/tables/render_left_out.tsv
    [ "$(grep -v '^#' "$chosen" | cut -f 1 | tr '\n' ' ')" = "scene t t/photo_3 u mean " ] || { cat "$chosen"; fail "other rows"; }
    for s in t u; do
        o=$([ $s = t ] && echo u || echo t)
        best=$(for v in default renderer=fast soft_z=2,more_views=0; do echo "$(of $o $v psnr) $v"; done | sort -k1,1nr -s | sed -n '1s/.* //p')
        awk -F'\t' -v s=$s -v a="$(of $s default psnr)" -v b="$(of $s "$best" psnr)" -v v="$best" '$1 == s && $2 == a && $3 == b && $7 == v { found = 1 } END { exit !found }' "$chosen" ||
            { cat "$chosen" "$t"; fail "$s does not have the setting that is best on $o, $best"; }
    done
    [ "$(of t default psnr)" = "$(of t default psnr_photo_3)" ] || fail "the only photo has another PSNR than its scene"
    holds "$(of u default psnr) > $(of t default psnr)" "a photo that is not held out"
}

missing_inputs_of_the_bench_are_named()
{
    BENCH_SCENES=nowhere BENCH_SWEEPS="scale views" bench 3
    wants "nowhere is skipped"; wants "there is no scene; BENCH_SCENES"
}

for t in frames_are_timed_and_written segments_are_flattened_at_their_middle wrong_usage_gives_a_message a_small_scene_gets_its_table \
    the_nearest_photo_of_a_view_is_the_view_itself settings_are_chosen_on_the_other_scenes missing_inputs_of_the_bench_are_named; do run "$t"; done
