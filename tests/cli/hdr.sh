# hdr_merge and fit_response: photo formats, single exposures, shifts, errors about wrong input
. tests/lib.sh
photos "$scratch/set" --size 320x240 --brackets 3 >/dev/null
cd "$scratch" || exit 1
export PATH=$root/$B/bin:$PATH

# records FOLDER [OPTION...]: runs import_photos into FOLDER-records; the scene's folder is FOLDER-scene
records() { local d=$1; shift; mkdir -p "$d-scene"; import_photos --photos "$d" --scene "$d-scene" --out "$d-records" "$@" 2>err; }
# merged FOLDER ID [OPTION...]: runs hdr_merge into FOLDER-hdr
merged() { local d=$1 id=$2; shift 2; hdr_merge --id "$id" --photos "$d" --records "$d-records" --out "$d-hdr" "$@" 2>err; }
says() { grep -qF -- "$1" err || { cat err; fail "no message '$1'"; }; }
refused() { local words=$1 rc=0; shift; "$@" || rc=$?; [ "$rc" = 1 ] || { cat err; fail "$*: exit $rc, wanted 1"; }; says "$words"; }
has() { grep -aqF -- "$2" "$1" || fail "$1 has no '$2'"; }
# times FOLDER: writes exposures.txt for photos without exposure times
times() { for k in 0 1 2; do for p in "$1"/*_e"$k".*; do echo "$(basename "$p") $(awk -v k=$k 'BEGIN { print 4 ^ k / 16384 }') 8 100"; done; done >"$1-scene/exposures.txt"; }

jpegs_are_fitted_and_merged()
{
    records set/photos || { cat err; fail "import"; }
    fit_response --photos set/photos --records set/photos-records --out set/response.txt 2>err || { cat err; fail "fit_response"; }
    says "response curve: sRGB: exposure ratios vary by"
    tail -n 2 set/response.txt | cmp - <(printf 'remodel-response 1\ncurve srgb\n') || fail "not the sRGB curve"
    merged set/photos photo_3 --response set/response.txt || { cat err; fail "merge"; }
    has set/photos-hdr/photo_3.exr exact
    has set/photos-hdr/photo_3.exr variance
    cp set/photos-hdr/photo_3.exr first.exr
    merged set/photos photo_3 --threads 1 --response set/response.txt
    cmp first.exr set/photos-hdr/photo_3.exr || fail "one thread gives different bytes"
    merged set/photos photo_3 --set picture=middle
    cmp set/photos-hdr/photo_3.jpg set/photos/photo_3_e1.jpg || fail "picture=middle is not the middle exposure's bytes"
}

# two photos of one exposure, each with noise of its own: the second makes the radiance better
equal_exposures_are_merged()
{
    mkdir -p equal equal-scene
    for p in set/photos/photo_?_e?.jpg; do
        b=$(basename "${p%.jpg}")
        ffmpeg -v error -i "$p" -vf noise=alls=3:allf=u:all_seed=1 -pix_fmt rgb24 "equal/$b.png"
        [ "${b#*_e}" != 1 ] || ffmpeg -v error -i "$p" -vf noise=alls=3:allf=u:all_seed=2 -pix_fmt rgb24 "equal/${b}b.png"
    done
    for p in equal/*.png; do echo "$(basename "$p") $(basename "$p" .png | sed 's/.*_e\(.\).*/\1/' | awk '{ print 4 ^ $1 / 16384 }') 8 100"; done >equal-scene/exposures.txt
    records equal || { cat err; fail "import"; }
    says "views of 4 exposures each: 1/16384 s, 1/4096 s, 1/4096 s, 1/1024 s"
    fit_response --photos equal --records equal-records --out equal/response.txt 2>err || { cat err; fail "fit_response"; }
    says "response curve: sRGB"
    merged equal photo_3 || { cat err; fail "merge"; }
    ! grep -q warning err || { cat err; fail "equal exposures are doubted"; }
    "$root/$B/tests/bench/picture_error" equal-hdr/photo_3.exr first.exr >with || fail "no comparison"
    rm equal/*b.png; sed -i '/b.png/d' equal-scene/exposures.txt
    records equal && merged equal photo_3 || { cat err; fail "without the second photo"; }
    "$root/$B/tests/bench/picture_error" equal-hdr/photo_3.exr first.exr >without || fail "no comparison"
    awk '$1 == "error" { e[n++] = $2 } END { exit !(n == 2 && e[0] < 0.98 * e[1] && e[1] < 0.1) }' with without ||
        { cat with without; fail "the second photo does not help"; }
}

tiff_and_png_merge_like_jpeg()
{
    mkdir -p tif tif-scene; n=0
    for p in set/photos/photo_[123]_e?.jpg; do
        b=$(basename "${p%.jpg}")
        case $((n++ % 3)) in
            0) ffmpeg -v error -i "$p" -pix_fmt rgb24 "tif/$b.tif" ;;
            1) ffmpeg -v error -i "$p" -pix_fmt rgb48le "tif/$b.tiff" ;;
            2) ffmpeg -v error -i "$p" -pix_fmt rgb24 "tif/$b.png" ;;
        esac
    done
    times tif
    records tif || { cat err; fail "import"; }
    says "3 views of 3 exposures each"
    merged tif photo_3 || { cat err; fail "merge"; }
    "$root/$B/tests/bench/picture_error" tif-hdr/photo_3.exr first.exr >out || fail "no comparison"
    awk '$1 == "error" { exit !($2 < 0.03) }' out || { cat out; fail "different radiance"; }
}

an_exr_is_a_single_exposure()
{
    mkdir -p exr
    for i in 1 2 3; do ffmpeg -v error -i set/photos/photo_${i}_e1.jpg -vf scale=160:120 -pix_fmt gbrpf32le exr/photo_$i.exr; done
    records exr || { cat err; fail "import"; }
    says "3 views of one exposure each; no exposure time is known, so all are assumed to be equal"
    grep -qx 'bits 32' exr-records/photo_2.txt && grep -qx 'BRACKETED := yes' exr-records/photos.mk || fail "wrong records"
    merged exr photo_2 || { cat err; fail "merge"; }
    has exr-hdr/photo_2.exr "one exposure"
    [ -s exr-hdr/photo_2.jpg ] || fail "no picture"
    "$root/$B/tests/bench/picture_error" exr-hdr/photo_2.exr exr/photo_2.exr >out || fail "no comparison"
    awk '$1 == "error" { exit !($2 < 0.001) }' out || { cat out; fail "the radiance is not the file's"; }
    fit_response --photos exr --records exr-records --out exr.txt 2>err || { cat err; fail "fit_response"; }
    grep -qx 'curve srgb' exr.txt || fail "a curve without evidence"
    refused "photo_1.exr is an EXR, a raw file or a photo with a gain map" records exr --set brackets=no
    printf 'photo_1.exr 1\nphoto_2.exr 0.25\nphoto_3.exr 1\n' >exr-scene/exposures.txt
    records exr && merged exr photo_2 || { cat err; fail "with times"; }
    "$root/$B/tests/bench/picture_error" exr-hdr/photo_2.exr exr/photo_2.exr >out
    awk '$1 == "error" { exit !($2 > 2.9 && $2 < 3.1) }' out || { cat out; fail "a quarter of the time is not four times the radiance"; }
    sed -i 1d exr-scene/exposures.txt
    refused "the exposure time of photo_1.exr is not known" records exr
}

a_tiff_is_a_single_exposure()
{
    mkdir -p lone; for i in 1 2; do ffmpeg -v error -i set/photos/photo_${i}_e1.jpg -pix_fmt rgb48le lone/photo_$i.tif; done
    records lone || { cat err; fail "import"; }
    says "2 views of one exposure each"
    merged lone photo_2 && [ -s lone-hdr/photo_2.jpg ] || { cat err; fail "merge"; }
    has lone-hdr/photo_2.exr "one exposure"
}

single_jpegs_share_one_scale()
{
    mkdir -p one; for i in 1 2 3; do cp set/photos/photo_${i}_e$((i - 1)).jpg one/photo_$i.jpg; done
    records one --set brackets=single || { cat err; fail "import"; }
    merged one photo_1 || { cat err; fail "merge"; }
    has one-hdr/photo_1.exr "one exposure"
    has one-hdr/photo_1.exr remodel:white
}

# Ultra HDR photos of the corpus: one with a map of three colours, one with a smaller grey map, one with a damaged map
gain_maps_give_linear_light()
{
    local c=$root/tests/fuzz/corpus/photo; mkdir -p gain; cp "$c/gain.jpg" "$c/gain-grey.jpg" gain/
    records gain || { cat err; fail "import"; }
    grep -qx 'bits 8' gain-records/gain.txt && ! grep -q 'BRACKETED := yes' gain-records/photos.mk && ! grep -q "gain maps" err || { cat err; fail "gain maps are used without being asked for"; }
    records gain --set gain_map=yes || { cat err; fail "import with gain maps"; }
    says "2 of 2 JPEGs have gain maps"
    grep -qx 'bits 32' gain-records/gain.txt && grep -qx 'BRACKETED := yes' gain-records/photos.mk || fail "an old record was taken"
    records gain --set gain_map=yes && grep -qx 'bits 32' gain-records/gain.txt || fail "the second run gives another record"
    fit_response --photos gain --records gain-records --out gain.txt 2>err && merged gain gain --response gain.txt --set picture=middle || { cat err; fail "merge"; }
    cmp gain-hdr/gain.jpg gain/gain.jpg || fail "picture=middle is not the photo itself"
    refused "a photo with a gain map, which can only be used if brackets are merged" records gain --set gain_map=yes --set brackets=no
    cp "$c/gain-damaged.jpg" "$c/gain-outside.jpg" gain/
    refused "2 of 4 photos in gain cannot be used" records gain --set gain_map=yes
    says "gain-damaged.jpg: its XMP data, which describe its gain map, are damaged"
    says "gain-outside.jpg says that it has a gain map, but none"
    records gain || { cat err; fail "damaged maps matter though they are not used"; }
    grep -qx 'bits 8' gain-records/gain.txt || fail "the record of the HDR picture stays"
    rm gain/gain*; cp set/photos/photo_[12]_e1.jpg gain/
    records gain --set gain_map=yes || { cat err; fail "photos without gain maps"; }
    says "none of the photos in gain has a gain map"
}

raw_files_are_recognised()
{
    mkdir -p raw; cp set/photos/photo_[12]_e1.jpg raw/
    echo "not read" >raw/photo_1_e1.CR2
    records raw || { cat err; fail "import"; }
    says "not used in raw: photo_1_e1.CR2 (a raw file, HEIC or AVIF beside a JPEG of the same name"
    printf 'FUJIFILMCCD-RAW 0201' >raw/photo_9.raf
    refused "photo_9.raf is a raw file that cannot be read (libraw:" records raw
}

# photos of one colour in Display P3: every format gives its light
other_colour_spaces_are_merged()
{
    mkdir -p p3 mixed mixed-scene; for e in heic avif webp jxl; do cp "$root/tests/fuzz/corpus/photo/p3.$e" "p3/$e.$e"; done
    records p3 || { cat err; fail "import"; }
    says "heic.heic and 2 more photos: their colours are in RGB built-in; they become linear Rec.709."
    says "avif.avif: its colours are in Display P3, sRGB curve; they become linear Rec.709."
    grep -qx 'colour "Display P3, sRGB curve"' p3-records/avif.txt || fail "the record does not name the colours"
    for e in heic avif webp jxl; do
        merged p3 "$e" || { cat err; fail "merge of $e"; }
        "$root/$B/tests/bench/picture_error" "p3-hdr/$e.exr" p3-hdr/heic.exr | awk '$1 == "error" { exit !($2 < 0.02) }' || fail "$e differs from heic"
    done
    has p3-hdr/webp.exr profile
    for k in 1 2; do
        cp "$root/tests/fuzz/corpus/photo/p3.png" "mixed/$k-p3.png"; cp "$root/tests/fuzz/corpus/photo/rgb.jpg" "mixed/$k.jpg"
        echo "v$k $k-p3.png $k.jpg" >>mixed-scene/brackets.txt; printf '%s 0.01 8 100\n%s 0.02 8 100\n' "$k-p3.png" "$k.jpg" >>mixed-scene/exposures.txt
    done
    records mixed || { cat err; fail "import of two spaces"; }
    refused "view v1: 1-p3.png and 1.jpg are in different colour spaces; save all exposures of a view in one." merged mixed v1
}

wrong_exposures_are_refused()
{
    mkdir -p wrong wrong-scene; cp set/photos/photo_[123]_e?.jpg wrong/
    { for i in 1 2 3; do echo "photo_${i}_e0.jpg 0.001"; echo "photo_${i}_e1.jpg 0.00025"; done; } >wrong-scene/exposures.txt
    for i in 1 2 3; do echo "photo_$i photo_${i}_e0.jpg photo_${i}_e1.jpg photo_${i}_e2.jpg"; done >wrong-scene/brackets.txt
    sed -i 's/photo_[123]_e2.jpg//' wrong-scene/brackets.txt; rm wrong/*_e2.jpg
    records wrong || { cat err; fail "import"; }
    refused "view photo_2: photo_2_e0.jpg should have 4 times the light of photo_2_e1.jpg, but shows 0.2" merged wrong photo_2
    [ ! -e wrong-hdr/photo_2.exr ] || fail "a failed merge left a product"
    merged wrong photo_2 --set max_disagreement=1000 || { cat err; fail "a larger max_disagreement does not help"; }
    says "warning: view photo_2"
    has wrong-hdr/photo_2.exr approximate
}

missing_exposures_and_times_are_named()
{
    mkdir -p few few-scene; cp set/photos/photo_?_e?.jpg few/; rm few/photo_4_e2.jpg
    refused "photo_4_e0.jpg (1/16384 s), photo_4_e1.jpg (1/4096 s)" records few
    mkdir -p bare bare-scene; for k in 0 1 2; do for i in 1 2; do ffmpeg -v error -i set/photos/photo_${i}_e$k.jpg bare/photo_${i}_e$k.png; done; done
    for i in 1 2; do echo "photo_$i photo_${i}_e0.png photo_${i}_e1.png photo_${i}_e2.png"; done >bare-scene/brackets.txt
    refused "the exposure time of photo_1_e0.png is not known (not in EXIF); write a line" records bare
    echo 'photo_1_e7.png 1' >bare-scene/exposures.txt
    refused "bare-scene/exposures.txt:1: found photo_1_e7.png, wanted the name of a photo in" records bare
}

shifts_are_reported_and_corrected()
{
    mkdir -p moved moved-scene
    for i in 1 2 3; do for k in 0 1 2; do
        at=8:8; [ "$i$k" != 22 ] || at=4:10
        ffmpeg -v error -i set/photos/photo_${i}_e$k.jpg -vf "crop=300:220:$at" -pix_fmt rgb24 moved/photo_${i}_e$k.png
    done; done
    times moved
    records moved || { cat err; fail "import"; }
    merged moved photo_2 || { cat err; fail "merge"; }
    says "photo_2_e2.png is shifted by 4, -2 px against photo_2_e1.png; corrected"
    has moved-hdr/photo_2.exr remodel:shift.3
    merged moved photo_2 --set align=report || { cat err; fail "merge"; }
    says "shifted by 4, -2 px against photo_2_e1.png"
    ! grep -aq remodel:shift moved-hdr/photo_2.exr || fail "align=report corrected a shift"
    merged moved photo_1 || { cat err; fail "merge"; }
    ! grep -q shifted err || { cat err; fail "a shift in an aligned view"; }
}

errors_in_a_response_name_the_line()
{
    printf 'remodel-response 1\ncurve table 256\n0 0 0\n0.1 0.1 x\n' >bad.txt
    refused "bad.txt:4: found" merged set/photos photo_3 --response bad.txt
    refused "nothing.txt" merged set/photos photo_3 --response nothing.txt
}

# the camera from a model; lighting reference images on the scale of another set
cameras_are_copied_and_references_scaled()
{
    mkdir -p model lri
    printf '1 OPENCV_FISHEYE 320 240 150 150 160 120 0 0 0 0\n' >model/cameras.txt
    printf '1 1 0 0 0 1 2 3 1 photo_3.jpg\n\n' >model/images.txt
    merged set/photos photo_3 --model model || { cat err; fail "merge"; }
    has set/photos-hdr/photo_3.exr 'OPENCV_FISHEYE 320 240 150 150 160 120 0 0 0 0'
    has set/photos-hdr/photo_3.exr worldToCamera
    merged set/photos photo_2 --model model || { cat err; fail "merge"; }
    says "view photo_2: model/images.txt has no image of it"
    ! grep -aq worldToCamera set/photos-hdr/photo_2.exr || fail "a pose without an image in the model"
    sed -i 's/320 240/321 240/' model/cameras.txt
    refused "view photo_3 has 320 x 240 pixels, but its camera in model/cameras.txt 321 x 240" merged set/photos photo_3 --model model
    rc=0; merged set/photos photo_2 --model model --views model || rc=$?
    [ "$rc" = 2 ] || fail "--views without --scene-records: exit $rc, wanted 2"
    says "give one of them"
    cp set/photos/photo_[12]_e?.jpg lri
    records lri --like set/photos-records || { cat err; fail "import of references"; }
    says "2 views of 3 exposures each"
    [ "$(awk '$1 == "brackets" { print $4 }' lri-records/photo_1.txt set/photos-records/photo_3.txt | uniq | wc -l)" = 1 ] || fail "the scales differ"
    rm lri/photo_2*
    records lri --like set/photos-records || { cat err; fail "import of one reference"; }
    grep -qx 'PHOTO_IDS := photo_1' lri-records/photos.mk || { cat lri-records/photos.mk; fail "not one view"; }
    rm lri/*; for i in 1 2; do ffmpeg -v error -i set/photos/photo_${i}_e1.jpg -vf scale=160:120 -pix_fmt gbrpf32le lri/photo_$i.exr; done
    refused 'write lines "FILE SECONDS F_NUMBER ISO" into exposures.txt' records lri --like set/photos-records
}

# marks in an image of 320 x 240 pixels, taken from 0.3 0.5 1.2 of a model whose southern wall is at y = -2
marked_corners_give_the_camera()
{
    mkdir -p marked; rm -rf set/photos-hdr
    cat >marked/plan.txt <<'TXT'
remodel-plan 2
wall south normal 0 1 at -2 thickness 0.2 from -3 to 3 foot 0 top 2.5 start free end free
window w on south from -1 0.8 to 1 2 closed
TXT
    cat >marked/axes.txt <<'TXT'
remodel-axes 1
rotation 1 0 0 0
translation 0 0 0
scale 1 metres
ceiling none
thickness none
error tilt 0
error heading 0
error floor 0
error ceiling none
error scale 0.01
TXT
    cat >marked/lri.txt <<'TXT'
lens photo_3 PINHOLE 320 240 150 150 160 120
corner photo_3 w left bottom 118 144
corner photo_3 w left top 118 72
corner photo_3_e0.jpg w right bottom 238 144
corner photo_3 w right top 238 72
TXT
    local marks="--marks marked/lri.txt --plan marked/plan.txt --axes marked/axes.txt"
    # shellcheck disable=SC2086 # options
    merged set/photos photo_3 $marks || { cat err; fail "merge"; }
    says "photo_3: placed by 4 marks, which are"
    says "photo_3: its camera is at 0.300 0.500 1.200 m in the model, 95 % interval"
    says "photo_3: that is 2.50 m in front of the inner face of the wall south"
    has set/photos-hdr/photo_3.exr 'PINHOLE 320 240 150 150 160 120'
    has set/photos-hdr/photo_3.exr worldToCamera
    has set/photos-hdr/photo_3.exr 'marks 4 '
    cp set/photos-hdr/photo_3.exr first.exr
    merged set/photos photo_3 --threads 1 $marks
    cmp first.exr set/photos-hdr/photo_3.exr || fail "one thread gives different bytes"
    merged set/photos photo_2 $marks
    says "view photo_2: marked/lri.txt has no mark of it; its radiance is written without lens and pose."
    rm -rf set/photos-hdr
    sed -i 's/right top 238 72/right top 138 172/' marked/lri.txt
    refused "marked/lri.txt: from the pose that fits best, the marks of image photo_3 are" merged set/photos photo_3 $marks
    sed -i '$d' marked/lri.txt
    refused "marked/lri.txt: three marks of image photo_3 leave 4 poses, with the camera at" merged set/photos photo_3 $marks
    ! ls set/photos-hdr/photo_3.* 2>/dev/null || fail "a product of a refused image is left"
    echo 'near photo_3 0 0 1.5' >>marked/lri.txt
    merged set/photos photo_3 $marks || { cat err; fail "merge with a place near the camera"; }
    says "three marks always fit"
    says "its camera is at 0.300 0.500 1.200 m"
    printf 'lens photo_3 PINHOLE 320 240 150 150 160 120\nin photo_3 w at 0.5 0.5 looking out\n' >marked/lri.txt
    merged set/photos photo_3 $marks || { cat err; fail "merge in a window"; }
    says "photo_3: placed in an opening of the wall south, looking straight out, level;"
    has set/photos-hdr/photo_3.exr 'window level'
    echo 'horizon photo_3 10 100 310 110' >>marked/lri.txt
    merged set/photos photo_3 $marks || { cat err; fail "merge with a horizon"; }
    says "level by its horizon"
    has set/photos-hdr/photo_3.exr 'window horizon'
    rc=0; merged set/photos photo_3 --marks marked/lri.txt || rc=$?
    [ "$rc" = 2 ] || fail "--marks without --plan: exit $rc, wanted 2"
    says "--marks, --plan and --axes belong together"
    rc=0; merged set/photos photo_3 --outdoors views || rc=$?
    [ "$rc" = 2 ] || fail "--outdoors without --marks: exit $rc, wanted 2"
    says "--outdoors wants --marks, --plan and --axes"
}

for t in jpegs_are_fitted_and_merged equal_exposures_are_merged tiff_and_png_merge_like_jpeg an_exr_is_a_single_exposure a_tiff_is_a_single_exposure single_jpegs_share_one_scale gain_maps_give_linear_light raw_files_are_recognised other_colour_spaces_are_merged wrong_exposures_are_refused \
    missing_exposures_and_times_are_named shifts_are_reported_and_corrected errors_in_a_response_name_the_line cameras_are_copied_and_references_scaled marked_corners_give_the_camera; do run "$t"; done
