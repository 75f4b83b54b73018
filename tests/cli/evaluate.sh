# evaluate: pictures, radiance, irradiance, edited models and hidden faces against the truth of a described scene
. tests/lib.sh
project evaluate
mkdir -p scene bare wide truth t/views t/model shared
cat >scene/scene.txt <<'E'
remodel-scene 1
texture plain plaster 0.3 0.4 1  0.6 0.58 0.5
texture red checker 0.2  0.6 0.2 0.1  0.3 0.1 0.1
material wall lambert plain
material box lambert red
room hall 0 0 4 3  0 2.5  wall wall
room den  4 0 7 3  0 2.5  wall wall
wall south -0.1 -0.1 7.1 -0.1  0 2.5 0.2 wall
wall east 7.1 -0.1 7.1 3.1  0 2.5 0.2 wall
wall north 7.1 3.1 -0.1 3.1  0 2.5 0.2 wall
wall west -0.1 3.1 -0.1 -0.1  0 2.5 0.2 wall
wall partition 4 0 4 3  0 2.5 0.16 wall
opening way partition 1 2 0 2
window sun south 1.1 3.1  0.9 2.1
lamp light quad 1.7 1.2 2.45  0 0.6 0  0.6 0 0  14 13 12
panorama 3  1.6 1.9 2.3  0.8 0.8 0.6
box crate 2.6 0.3 0 3.6 0.8 1 box
E
cat >scene/cameras.txt <<'E'
remodel-shoot 1
lens wide pinhole 120 90 70 70 60 45
exposure 0.0166666667
sensor 30000 6 60 1
photo a wide 0.4 2.6 1.5  3.5 0.6 1
photo b wide 0.9 2.7 1.4  4 1.3 0.9
photo c wide 0.5 0.5 1.6  4 1.6 1
E
cp scene/cameras.txt bare/
grep -v '^box' scene/scene.txt >bare/scene.txt
cp scene/cameras.txt wide/
sed 's/^opening way.*/opening way partition 0.55 2.45 0 2/' scene/scene.txt >wide/scene.txt
cat >axes.txt <<'E'
remodel-axes 1
rotation 1 0 0 0
translation 0 0 0
scale 2 metres
ceiling 2.5
thickness 0.2
error tilt 0
error heading 0
error floor 0
error ceiling 0
error scale 0
E
cat >room.txt <<'E'
remodel-script 1
wall south from 7 0 to 0 0
wall west from 0 0 to 0 3
wall north from 0 3 to 7 3
wall east from 7 3 to 7 0
wall partition from 3.92 3 to 3.92 0 thickness 0.16
join south west north east south
extend partition start to north
extend partition end to south
room hall south west north partition
room den south partition north east
passage way on partition from 1 0 to 2 2
window sun on south from 1 0.9 to 3 2.1
E

# The truth in its documented layout, from three described scenes; products of an exact scene in units of 2 m.
make_truth()
{
    local name opt='--set samples=4 --set irradiance_points=120 --set irradiance_samples=64'
    for name in scene bare wide; do
        "$B/bin/simulate" --scene $name --out sim-$name --common $opt 2>log || { cat log; fail "simulate $name"; }
        "$B/bin/simulate" --scene $name --out sim-$name --photo all $opt 2>log || { cat log; fail "simulate $name"; }
    done
    cp -r sim-scene/truth/. truth/
    mkdir -p truth/shell truth/edited-wide truth/novel
    cp -r sim-bare/truth/hdr sim-bare/truth/ids sim-bare/truth/depth truth/shell/
    cp -r sim-wide/truth/hdr sim-wide/truth/ids sim-wide/truth/depth sim-wide/truth/*.txt truth/edited-wide/
    rm truth/edited-wide/cameras.txt truth/edited-wide/images.txt
    # photo c counts as a view that nobody photographed
    cp sim-scene/truth/cameras.txt truth/novel/
    sed -i 's/c\.jpg$/c/' sim-scene/truth/images.txt
    awk '/^#/ { next } NF { keep = $10 == "c" } keep || !NF' sim-scene/truth/images.txt >truth/novel/images.txt
    mkdir truth/novel/hdr && cp truth/hdr/c.exr truth/novel/hdr/
    rm truth/hdr/c.exr
}

make_products()
{
    "$B/bin/import_photos" --photos sim-scene/photos --out shared/photos 2>log || { cat log; fail import_photos; }
    awk '/^#/ || !NF { print; next } { for (i = 6; i <= 8; i++) $i = sprintf("%.17g", $i / 2); sub(/\.jpg$/, "", $10); $10 = $10 ".exr"; print }' \
        truth/images.txt >t/views/images.txt
    cp truth/cameras.txt t/views/cameras.txt
    : >t/views/points3D.txt
    { echo remodel-lenses 1; for v in a b c; do echo "$v $v PINHOLE 120 90 70 70 60 45 turn 1 0 0 0"; done; } >t/views/lenses.txt
    cp sim-scene/truth/hdr/*.exr t/views/
    cp axes.txt t/model/
    "$B/bin/build_model" --axes axes.txt --script room.txt --out t/model 2>log || { cat log; fail build_model; }
    printf 'remodel-script 1\nadjust way from 0.55 0 to 2.45 2\n' >wide.txt
    "$B/bin/build_model" --axes axes.txt --script room.txt --edit wide.txt --base t/model/model.txt --out t/remodel/wide 2>log || { cat log; fail "build_model of the edit"; }
}

# measure [OPTION...]: runs evaluate on t
measure() { "$B/bin/evaluate" --folder t --shared shared --truth truth --out metrics.tsv "$@" 2>log || { cat log; fail "evaluate"; }; }
# within METRIC MIN MAX [VIEW]
within()
{
    local v
    if [ $# = 4 ]; then v=$(awk -F'\t' -v m="$1" -v w="$4" '$1 == w && $2 == m { print $3 }' t/evaluate/views.tsv)
    else v=$(awk -F'\t' -v m="$1" '$1 == m { print $2 }' metrics.tsv); fi
    awk -v v="$v" -v a="$2" -v b="$3" 'BEGIN { exit !(v != "" && v + 0 >= a && v + 0 <= b) }' || { cat metrics.tsv; fail "$1 of ${4:-the scene} is ${v:-missing}, wanted $2 to $3"; }
}
says() { grep -qF -- "$1" metrics.tsv || { grep '^#' metrics.tsv; fail "nothing says '$1'"; }; }

the_truth_and_products_are_made()
{
    make_truth
    make_products
    measure
    within camera.scale 1.999999 2.000001
}

exact_radiance_has_no_error()
{
    measure
    within radiance.scale 0.9995 1.0005
    within radiance.error90 0 0.05
    within radiance.rms 0 0.05
    within radiance.pictures 2 2
    within radiance.scale 0.9995 1.0005 a
}

pictures_are_compared_through_their_own_cameras()
{
    says 'skipped pictures of novel: the folder novel'
    mkdir -p t/rendered/novel
    cp t/evaluate/cameras/novel/*.txt t/rendered/novel/
    cp truth/novel/hdr/c.exr t/rendered/novel/
    measure
    within novel.pictures 1 1
    within novel.psnr 60 99 c
    within novel.rms 0 0.05
    within novel.offset 0 1e-9
    within novel.white 0.9995 1.0005
    # the picture of another camera is wrong; one that is too far away is not compared
    cp truth/hdr/a.exr t/rendered/novel/c.exr
    measure
    within novel.psnr 5 25
    awk '/c.exr/ { $6 += 0.2 } { print }' t/evaluate/cameras/novel/images.txt >t/rendered/novel/images.txt
    measure
    says 'skipped 1 pictures of novel: their cameras are up to 0.4 m from the true ones'
    says 'skipped 1 of 1 true pictures of novel'
    cp t/evaluate/cameras/novel/images.txt t/rendered/novel/
}

eight_bit_pictures_need_a_white_point()
{
    # the photo: signal 60 radiance seconds, so that white is the radiance 1
    rm t/rendered/novel/c.exr
    cp sim-scene/photos/c.jpg t/rendered/novel/
    measure
    within novel.psnr 25 60
    within novel.rms_clipped 0 15
    ! grep -q '^novel.rms	' metrics.tsv || fail "a clipped picture has an error of all light"
    measure --set white=2
    within novel.white 2 2
    within novel.psnr 5 24
    mv truth/hdr hdr
    measure
    says 'skipped pictures of novel: 8-bit pictures need [evaluate] white'
    mv hdr truth/hdr
}

edited_pictures_are_compared_as_views()
{
    mkdir -p t/rendered/edited-wide
    cp truth/edited-wide/hdr/[ab].exr t/rendered/edited-wide/
    measure
    within edited.wide.pictures 2 2
    within edited.wide.psnr 60 99
    says 'skipped 1 of 3 true pictures of edited.wide'
    cp truth/hdr/[ab].exr t/rendered/edited-wide/
    measure
    within edited.wide.psnr 10 45
}

faces_of_the_model_and_its_edit_agree()
{
    within model.faces 99.9 100
    within model.walls 0 1e-4
    within model.openings 0 1e-4
    within model.ceilings 0 1e-4
    within edited.wide.faces 99.9 100
    within edited.wide.openings 0 1e-4
    within edited.wide.missing 0 0
    within edited.wide.faces 99.9 100 b
    # the unedited model in place of the edited one: the opening is 0.45 m narrower on both sides
    mkdir -p right && mv t/remodel/wide right/
    cp -r t/model t/remodel/wide
    measure
    within edited.wide.openings 0.4499 0.4501
    within edited.wide.faces 95 99.5
    says 'note: most pixels that edited.wide.faces misses are on'
    rm -r t/remodel/wide
    measure
    says 'skipped walls of edited.wide: remodel/wide/plan.txt is missing'
    says 'skipped faces of edited.wide: remodel/wide/model.txt is missing'
    mv right/wide t/remodel/
}

irradiance_is_compared_on_the_model_and_elsewhere()
{
    says 'skipped irradiance: relight/irradiance.txt is missing'
    mkdir -p t/relight
    paste -d' ' <(grep -v '^#' t/evaluate/irradiance_points.txt) <(grep -v '^#' truth/irradiance.txt | awk '{ print $7 * 1.1, $8 * 1.1, $9 * 1.1 }') >all.txt
    head -n 100 all.txt >t/relight/irradiance.txt
    measure
    within irradiance.points 100 100
    within irradiance.missing 20 20
    within irradiance.rms 9.9 10.1
    within irradiance.error50 9.9 10.1
    within irradiance.rms_model 9.9 10.1
    # the crate is not in the model: a point on it is elsewhere
    local on=0 off=0
    on=$(awk -F'\t' '$1 == "irradiance.points_model" { print $2 }' metrics.tsv)
    off=$(awk -F'\t' '$1 == "irradiance.points_other" { print $2 }' metrics.tsv)
    [ $((on + off)) = 100 ] && [ "$off" -gt 0 ] && [ "$on" -gt 50 ] || fail "$on points on the model, $off elsewhere"
    echo '0 0 0 0 0 2 1 1 1' >t/relight/irradiance.txt
    if "$B/bin/evaluate" --folder t --shared shared --truth truth --out other.tsv 2>log; then fail "a bad normal was accepted"; fi
    grep -q 'irradiance.txt:1: found .*2.*, wanted a normal of length 1' log || { cat log; fail "no message about the normal"; }
    [ ! -e other.tsv ] || fail "a table was left"
    echo '0 0 0 0 0 1 1 1 1' >t/relight/irradiance.txt
    measure
    says 'skipped irradiance: no point of relight/irradiance.txt is one of the truth'
}

pictures_of_irradiance_are_compared_before_and_after()
{
    local part
    says 'skipped pictures of irradiance: '
    printf 'remodel-scene 2\nbase scene.txt\n' >scene/scene-same.txt
    printf 'remodel-scene 2\nbase scene.txt\ndrop crate sun\n' >scene/scene-dark.txt
    for opt in '' '--edit dark' '--edit same'; do
        # shellcheck disable=SC2086 # options
        "$B/bin/simulate" --scene scene --out sim-scene --photo all --kind irradiance $opt --set samples=16 2>log || { cat log; fail "simulate irradiance $opt"; }
    done
    cp -r sim-scene/truth/irradiance truth/
    for part in dark same; do mkdir truth/edited-$part; cp -r sim-scene/truth/edited-$part/irradiance truth/edited-$part/; done
    measure
    says 'skipped pictures of irradiance: the folder irradiance'
    # exact pictures, beside the points; photo c is no picture of the truth's folder of photos, but of the views
    mkdir -p t/relight t/rendered/edited-dark t/rendered/edited-same
    cp -r truth/irradiance t/relight/
    cp -r truth/edited-dark/irradiance t/rendered/edited-dark/
    cp -r truth/edited-same/irradiance t/rendered/edited-same/
    measure
    within irradiance.pictures 3 3
    within irradiance.picture_rms 0 0.05
    within irradiance.picture_rms_model 0 0.05
    within irradiance.picture_rms_other 0 0.05
    within irradiance.picture_error50 0 0.05 a
    within irradiance.picture_missing 0 0
    within irradiance.ratio_pictures 6 6
    within irradiance.ratio_rms 0 1e-4
    within irradiance.ratio_error90 0 1e-4
    within irradiance.ratio_missing 0 0
    within irradiance.ratio_change 0 0 edited-same/irradiance
    within irradiance.ratio_change 20 1000 edited-dark/irradiance
    within irradiance.ratio_error50 0 1e-4 edited-dark/irradiance/b
    # a ratio of 1 is wrong by the whole change; one of the unedited room is right
    cp truth/irradiance/*.exr t/rendered/edited-dark/irradiance/
    measure
    change=$(awk -F'\t' '$1 == "edited-dark/irradiance" && $2 == "irradiance.ratio_change" { print $3 }' t/evaluate/views.tsv)
    within irradiance.ratio_rms "$change" "$change" edited-dark/irradiance
    within irradiance.ratio_rms 0 1e-4 edited-same/irradiance
    # pictures without a partner, and integers, are skipped
    rm t/relight/irradiance/a.exr
    cp sim-scene/photos/b.jpg t/rendered/edited-same/irradiance/ && rm t/rendered/edited-same/irradiance/b.exr
    measure
    within irradiance.ratio_pictures 3 3
    says 'skipped the ratios of 1 pictures of edited.dark/irradiance: irradiance/ has no picture of the same name'
    says 'skipped 1 pictures of edited.same/irradiance: irradiance is compared in EXR files alone'
    cp -r truth/irradiance t/relight/
    cp truth/edited-same/irradiance/b.exr t/rendered/edited-same/irradiance/
}

relit_pictures_are_compared_where_light_changes()
{
    says 'skipped relit pictures of edited.dark: there are none'
    "$B/bin/simulate" --scene scene --out sim-scene --photo all --edit dark --set samples=4 2>log || { cat log; fail "simulate the dark room"; }
    cp -r sim-scene/truth/edited-dark/{hdr,ids,depth} truth/edited-dark/
    printf 'remodel-script 1\nremove sun\n' >dark.txt
    "$B/bin/build_model" --axes axes.txt --script room.txt --edit dark.txt --base t/model/model.txt --out t/remodel/dark 2>log || { cat log; fail "build_model of the dark room"; }
    # exact pictures after, and those of the unedited room before
    mkdir -p t/relight/dark/unlit
    cp truth/edited-dark/hdr/[ab].exr t/relight/dark/
    cp truth/hdr/[ab].exr t/relight/dark/unlit/
    cp truth/irradiance/a.exr t/relight/dark/a-ratio.exr
    measure
    within edited.dark.relit_psnr 80 100
    within edited.dark.unlit_psnr 5 40
    within edited.dark.relit_gain 40 95
    awk -F'\t' '{ v[$1] = $2 } END { p = "edited.dark."; exit !(v[p "relit_limit_psnr"] > v[p "unlit_psnr"] && v[p "relit_limit_psnr"] <= 100) }' metrics.tsv || { cat metrics.tsv; fail "the true change of light gains nothing"; }
    within edited.dark.relit_pixels 20 95
    within edited.dark.relit_psnr_model 80 100
    within edited.dark.relit_revealed_psnr 60 100
    within edited.dark.relit_gain 40 95 b
    within edited.dark.relit_ratio_error50 1 1e6
    awk -F'\t' '{ v[$1] = $2 } END { p = "edited.dark.relit_pixels"; exit !(v[p "_model"] + v[p "_other"] <= v[p] + 1e-6 && v[p "_model"] > 0.9 * v[p]) }' metrics.tsv || { cat metrics.tsv; fail "the parts are not those of the whole"; }
    ! grep -q 'edited.wide.relit' metrics.tsv || fail "a picture that nobody relit is measured"
    # RENDERED/relit-E comes first, against RENDERED/edited-E; a picture without a partner is skipped
    mkdir -p t/rendered/relit-dark
    cp truth/hdr/[ab].exr t/rendered/relit-dark/
    cp truth/hdr/a.exr t/rendered/edited-dark/
    measure
    within edited.dark.relit_gain 0 0
    says 'skipped 1 relit pictures of edited.dark: their pictures in the old light, with the same names and cameras, are missing'
    # without true irradiance, radiance decides, and there is no error of a ratio
    mv t/rendered/relit-dark relit-dark
    mv truth/edited-dark/irradiance irradiance
    measure
    says 'note: of 2 relit pictures of edited.dark, where light changes is found from radiance'
    within edited.dark.relit_gain 40 95
    ! grep -q 'edited.dark.relit_ratio_error50' metrics.tsv || fail "an error without a truth"
    mv irradiance truth/edited-dark/irradiance
}

hidden_faces_are_scored_apart()
{
    says 'skipped pictures of shell: the folder shell'
    mkdir -p t/rendered/shell
    cp truth/shell/hdr/*.exr t/rendered/shell/
    measure
    within shell.pictures 3 3
    within shell.hidden 2 30
    within shell.error50_hidden 0 0.05
    within shell.error50_seen 0 0.05
    # a picture with the crate is wrong where the crate hides the room, and nearly right elsewhere
    cp sim-scene/truth/hdr/*.exr t/rendered/shell/
    measure
    within shell.rms_hidden 20 200
    awk -F'\t' '$1 == "shell.error50_hidden" { h = $2 } $1 == "shell.error50_seen" { s = $2 } END { exit !(h > 3 * s) }' metrics.tsv || { cat metrics.tsv; fail "hidden faces are not worse"; }
    within shell.error50_hidden 10 500 face/hall.floor
    says 'note: shell.faces_max_hidden is that of'
}

the_page_shows_the_metrics()
{
    measure
    cp metrics.tsv t/
    "$B/bin/report" --scene t --folder t --shared shared --photos sim-scene/photos --stages evaluate --out page.html 2>log || { cat log; fail report; }
    ! grep -q 'metrics.* cannot be read' page/numbers.html || fail "the page cannot read the tables"
    for m in novel.rms_clipped edited.dark.relit_gain edited.wide.faces shell.faces_hidden radiance.scale model.ceilings; do grep -qF "<code>$m</code>" page/numbers.html || fail "the page lacks $m"; done
}

any_number_of_threads_gives_the_same_bytes()
{
    measure --threads 1
    cp metrics.tsv one.tsv && cp t/evaluate/views.tsv one-views.tsv
    measure --threads 3
    cmp one.tsv metrics.tsv && cmp one-views.tsv t/evaluate/views.tsv || fail "other bytes"
    ! grep -v '^#' metrics.tsv | grep -iE 'nan|inf' || fail "a figure is not a number"
}

for t in the_truth_and_products_are_made exact_radiance_has_no_error pictures_are_compared_through_their_own_cameras \
    eight_bit_pictures_need_a_white_point edited_pictures_are_compared_as_views faces_of_the_model_and_its_edit_agree \
    irradiance_is_compared_on_the_model_and_elsewhere pictures_of_irradiance_are_compared_before_and_after \
    relit_pictures_are_compared_where_light_changes \
    hidden_faces_are_scored_apart the_page_shows_the_metrics \
    any_number_of_threads_gives_the_same_bytes; do run "$t"; done
