# import_photos: --split, its parameters and errors
. tests/lib.sh
d=$scratch/photos; mkdir "$d"
ffmpeg -v error -f lavfi -i testsrc2=size=120x80 -frames:v 1 "$d/a.png"
bin() { "$B/bin/import_photos" --photos "$d" --out "$scratch/records" "$@" 2>"$scratch/err"; }
# rejects CODE WORDS OPTION...
rejects()
{
    local code=$1 words=$2 rc=0; shift 2
    bin "$@" || rc=$?
    [ "$rc" = "$code" ] || { cat "$scratch/err"; fail "$*: exit $rc, wanted $code"; }
    grep -qF -- "$words" "$scratch/err" || { cat "$scratch/err"; fail "$*: nothing says '$words'"; }
    [ -z "$(find "$scratch/records" "$scratch/cuts" -type f 2>/dev/null)" ] || fail "$*: a product was left"
}

invalid_grids_are_rejected()
{
    for g in 3 3x x3 0x3 3x0 100x1 3x3x3 -1x2 '3x3 ' axb ''; do rejects 2 "wanted COLUMNSxROWS" --split "$g" --cuts "$scratch/cuts"; done
    rejects 2 "cuts nothing" --split 1x1 --cuts "$scratch/cuts"
    rejects 2 "go together" --split 2x2
    rejects 2 "go together" --cuts "$scratch/cuts"
    rejects 2 "the folder of photos itself" --split 2x2 --cuts "$d"
}

invalid_parameters_are_rejected()
{
    rejects 2 "split_gap" --split 2x2 --cuts "$scratch/cuts" --set split_gap=-1
    rejects 2 "split_dark" --split 2x2 --cuts "$scratch/cuts" --set split_dark=255
    rejects 2 "leave these two at 0" --split 2x2 --cuts "$scratch/cuts" --set split_dark=9 --set split_border=1
}

photos_that_cannot_be_cut_are_named()
{
    rejects 1 "a.png: cutting its 120 px into 9 columns leaves 13 px" --split 9x1 --cuts "$scratch/cuts"
    rejects 1 "a.png: columns 53 to 66 contain no dark line" --split 2x1 --cuts "$scratch/cuts" --set split_dark=9
    rejects 1 "no photo besides those left out" --split 2x1 --cuts "$scratch/cuts" --exclude a
}

cut_pictures_are_photos()
{
    bin --split 3x2 --cuts "$scratch/cuts" || { cat "$scratch/err"; fail "it failed"; }
    [ "$(cut -d' ' -f1 "$scratch/records/list.txt" | tr '\n' ' ')" = "a_c1r1 a_c1r2 a_c2r1 a_c2r2 a_c3r1 a_c3r2 " ] || fail "wrong ids"
    grep -qx 'size 40 40' "$scratch/records/a_c2r2.txt" || fail "wrong size"
}

# as phones and browsers name them; each left out by its name, with what to do
files_are_known_by_their_content()
{
    local c=$root/tests/fuzz/corpus/photo m=$scratch/mixed; mkdir -p "$m/cam1"
    cp "$c/rgb.jpg" "$m/1.jfif"; { cat "$c/rgb.jpg"; echo; } >"$m/2.HEIC"; # not the same bytes twice
    cp "$c/rgb.heic" "$m/3.HEIC"; cp "$c/rgb.webp" "$m/4.webp"
    cp "$c/rgb.jpg" "$m/cam1/5.jpg"; cp "$c/rgb.jpg" "$m/1.jfif_original"; cp "$c/rgb.jpg" "$m/._2.jpg"; echo >"$m/6.mov"; echo >"$m/7.xmp"
    "$B/bin/import_photos" --photos "$m" --out "$scratch/mixed-records" 2>"$scratch/err" || { cat "$scratch/err"; fail "it failed"; }
    [ "$(cut -d' ' -f1 "$scratch/mixed-records/list.txt" | tr '\n' ' ')" = "1 2 3 4 " ] || fail "wrong photos"
    grep -qx 'BRACKETED := yes' "$scratch/mixed-records/photos.mk" || fail "COLMAP would get HEIC"
    for words in "warning: not used in $m: cam1 (folders with photos" "warning: not used in $m: 6.mov (videos of a kind" "not used in $m: 1.jfif_original (backups" \
        "not used in $m: ._2.jpg (hidden" "not used in $m: 7.xmp (no pictures)"; do
        grep -qF "$words" "$scratch/err" || { cat "$scratch/err"; fail "nothing says '$words'"; }
    done
    rc=0; "$B/bin/import_photos" --photos "$m" --out "$scratch/mixed-records" --set brackets=no 2>"$scratch/err" || rc=$?
    [ "$rc" = 1 ] && grep -qF "3.HEIC is HEIC, AVIF, WebP or JPEG XL, which COLMAP does not read" "$scratch/err" || { cat "$scratch/err"; fail "brackets = no"; }
}

# make_clip FILE FRAMES STEP [FILTER]: a board that moves by 2 STEP px a frame against a wall of smooth noise; it has nearly half
# of the picture, so that parallax, which a fifth of the points decide, is certain
make_clip()
{
    [ -e "$scratch/wall.png" ] || ffmpeg -v error -f lavfi -i "nullsrc=size=900x270,geq=lum='random(1)*255':cb=128:cr=128,gblur=sigma=2,normalize" \
        -frames:v 1 "$scratch/wall.png"
    ffmpeg -v error -y -framerate 30 -loop 1 -i "$scratch/wall.png" -framerate 30 -loop 1 -i "$scratch/wall.png" -filter_complex \
        "[0]crop=480:270:x='$3*n':y=0[w];[1]hflip,crop=300:200:50:50[b];[w][b]overlay=x='60+$3*n':y=35,format=yuv420p${4:+,$4}" \
        -frames:v "$2" -c:v libx264 -crf 12 -flags:v +bitexact -fflags +bitexact "$1"
}
frames_of() { grep -c '^frame ' "$scratch/frames/frames.txt"; }
films() { rm -rf "$scratch/records"; "$B/bin/import_photos" --out "$scratch/records" --frames "$scratch/frames" "$@" 2>"$scratch/err"; }

clips_among_photos_become_photos()
{
    local m=$scratch/clips times sum; mkdir "$m"
    make_clip "$m/walk 1.MOV" 40 2; make_clip "$m/IMG_7.mov" 20 2; cp "$d/a.png" "$m/IMG_7.png"; ffmpeg -v error -i "$d/a.png" -vf hflip "$m/b.png"; cp "$m/IMG_7.mov" "$m/GX1.LRV"
    films --photos "$m" --threads 2 || { cat "$scratch/err"; fail "it failed"; }
    grep -qF "IMG_7.mov (clips beside photos of the same name" "$scratch/err" || fail "the clip of a live photo is not named"
    grep -qF "GX1.LRV (videos of a kind" "$scratch/err" || fail "the preview is not named"
    grep -qE "walk 1.MOV: [0-9]+ of 40 frames become photos, at 0.0" "$scratch/err" || fail "the times are not listed"
    # 4 px of 480 a frame: 2 % of parallax, 0.7 to 1.3 times, is two frames or three
    [ "$(frames_of)" -ge 14 ] && [ "$(frames_of)" -le 20 ] || fail "$(frames_of) frames, wanted 14 to 20"
    [ "$(grep -c '^walk_1_f0000' "$scratch/records/list.txt")" = "$(frames_of)" ] || fail "not all frames are photos"
    grep -qx 'b b.png' "$scratch/records/list.txt" && [ "$(readlink "$scratch/frames/b.png")" = "$(realpath "$m")/b.png" ] || fail "a photo beside the clip is lost"
    # again: nothing is taken again, with other threads the bytes are the same
    times=$(stat -c '%n %y' "$scratch"/frames/*); sum=$(cat "$scratch"/frames/* | cksum)
    films --photos "$m" || fail "the second run failed"
    [ "$times" = "$(stat -c '%n %y' "$scratch"/frames/*)" ] || fail "frames were taken again"
    rm -rf "$scratch/frames"; films --photos "$m" --threads 1 || fail "it fails with one thread"
    [ "$sum" = "$(cat "$scratch"/frames/* | cksum)" ] || fail "the bytes depend on the threads"
    films --photos "$m" --set frames=3 || fail "it fails with 3 frames"
    [ "$(frames_of)" = 3 ] && [ "$(find "$scratch/frames" -name '*_f*' | wc -l)" = 3 ] || fail "$(frames_of) frames, wanted 3"
    films --photos "$m" --exclude "walk 1" || fail "it fails without the clip"
    [ -z "$(find "$scratch/frames" -type f -o -type l)" ] || fail "frames of a clip that is left out remain"
}

clips_are_given_by_name()
{
    make_clip "$scratch/one.mp4" 30 2; mkdir -p "$scratch/other"; make_clip "$scratch/other/one.mp4" 30 3
    films --photos "$scratch/one.mp4" --photos "$scratch/other/one.mp4" || { cat "$scratch/err"; fail "it failed"; }
    grep -q '^one_f' "$scratch/records/list.txt" && grep -q '^one-2_f' "$scratch/records/list.txt" || fail "wrong ids"
    rc=0; "$B/bin/import_photos" --photos "$scratch/one.mp4" --out "$scratch/none" 2>"$scratch/err" || rc=$?
    [ "$rc" = 2 ] && grep -qF "needs --frames" "$scratch/err" || fail "a clip without --frames: exit $rc"
}

# unusable NAME WORDS
unusable()
{
    local rc=0; rm -rf "$scratch/frames"; films --photos "$scratch/$1" || rc=$?
    [ "$rc" = 1 ] && grep -qE "$1.*$2" "$scratch/err" || { cat "$scratch/err"; fail "$1: exit $rc, nothing says '$2'"; }
    [ ! -e "$scratch/records/list.txt" ] && [ ! -e "$scratch/frames/frames.txt" ] || fail "$1: a product was left"
}
unusable_clips_are_named()
{
    make_clip "$scratch/still.mp4" 30 0; make_clip "$scratch/whole.mov" 30 2
    ffmpeg -v error -f lavfi -i sine=duration=1 -c:a aac "$scratch/sound.mp4"
    head -c 40000 "$scratch/whole.mov" >"$scratch/cut.mov"; echo text >"$scratch/text.mp4"
    unusable still.mp4 "its camera moves too little"
    unusable sound.mp4 "has no video stream"
    unusable cut.mov "damaged, cut off or no video"
    unusable text.mp4 "does not contain a video in MP4, QuickTime, Matroska or AVI"
}

panoramas_become_views()
{
    local m=$scratch/panoramas; mkdir "$m"
    ffmpeg -v error -f lavfi -i "nullsrc=size=512x256,geq=lum='128+100*sin(2*PI*(X+0.5)/W)*sin(PI*(Y+0.5)/H)':cb=128:cr=128" -frames:v 1 "$m/R 1.png"
    cp "$d/a.png" "$m/b.png"
    films --photos "$m" || { cat "$scratch/err"; fail "it failed"; }
    matches "R 1.png is a panorama of 360 degrees; it becomes 6 views of 164 x 164 px" <"$scratch/err" || { cat "$scratch/err"; fail "nothing says so"; }
    [ "$(cut -d' ' -f1 "$scratch/records/list.txt" | tr '\n' ' ')" = "R_1_yaw000 R_1_yaw060 R_1_yaw120 R_1_yaw180 R_1_yaw240 R_1_yaw300 b " ] || fail "wrong ids"
    films --photos "$m" --set panoramas=no || { cat "$scratch/err"; fail "it fails without views"; }
    [ "$(cut -d' ' -f1 "$scratch/records/list.txt" | tr '\n' ' ')" = "R_1 b " ] && [ ! -e "$scratch/frames/frames.txt" ] || fail "views remain"
}

# a folder as a downloads folder is: the same photo twice, an archive, a TIFF of two pages, transparent pixels, a name with blanks
what_is_not_used_is_named()
{
    local f=$scratch/downloads
    mkdir "$f"
    for k in 1 2 3; do ffmpeg -v error -f lavfi -i testsrc2=size=120x80 -vf "hue=h=$((40 * k))" -frames:v 1 "$f/IMG $k.png"; done
    cp "$f/IMG 2.png" "$f/Copy of IMG 2 (1).png"
    : >"$f/photos.zip"
    ffmpeg -v error -f lavfi -i testsrc2=size=120x80 -vf 'format=rgba,geq=r=r(X\,Y):g=g(X\,Y):b=b(X\,Y):a=255*gt(X\,29)' -frames:v 1 "$f/cut out.png"
    "$B/bin/import_photos" --photos "$f" --out "$scratch/used" 2>"$scratch/err" || { cat "$scratch/err"; fail "it failed"; }
    for words in "Copy of IMG 2 (1).png (the same bytes as another photo" "photos.zip (archives, which are not opened" \
        "cut out.png: 25 % of its pixels are transparent" "masks/cut_out.png"; do
        grep -qF -- "$words" "$scratch/err" || { cat "$scratch/err"; fail "nothing says '$words'"; }
    done
    [ "$(cut -d' ' -f1 "$scratch/used/list.txt" | tr '\n' ' ')" = "IMG_1 IMG_2 IMG_3 cut_out " ] || { cat "$scratch/used/list.txt"; fail "wrong photos"; }
}

# an edited photo has lost its EXIF data
photos_of_unknown_exposure_among_others()
{
    command -v cwebp >/dev/null || skip "cwebp is not installed"
    local f=$scratch/edited
    mkdir "$f"
    for k in 1 2 3; do ffmpeg -v error -f lavfi -i testsrc2=size=120x80 -vf "hue=h=$((40 * k))" -frames:v 1 "$f/$k.png"; done
    cwebp -quiet "$f/3.png" -o "$f/3.webp"; rm "$f/3.png"
    printf '1.png 0.01\n2.png 0.01\n' >"$f/exposures.txt"
    "$B/bin/import_photos" --photos "$f" --out "$scratch/equal" 2>"$scratch/err" || { cat "$scratch/err"; fail "it failed"; }
    grep -q '3 views of one exposure each; not all exposures are known, so all are assumed to be equal' "$scratch/err" || { cat "$scratch/err"; fail "it is not said"; }
}

sources_that_are_none_are_named()
{
    cp "$d/a.png" "$scratch/photo"
    : >"$scratch/set.zip"; echo text >"$scratch/text"
    for pair in "photo|is one photo; give the folder" "set.zip|is an archive; unpack it" "text|does not contain a video in MP4"; do
        ! "$B/bin/import_photos" --photos "$scratch/${pair%%|*}" --frames "$scratch/frames" --out "$scratch/none" 2>"$scratch/err" || fail "$pair was accepted"
        grep -qF -- "${pair#*|}" "$scratch/err" || { cat "$scratch/err"; fail "nothing says '${pair#*|}'"; }
    done
}

for t in invalid_grids_are_rejected invalid_parameters_are_rejected photos_that_cannot_be_cut_are_named cut_pictures_are_photos files_are_known_by_their_content \
    clips_among_photos_become_photos clips_are_given_by_name unusable_clips_are_named \
    panoramas_become_views what_is_not_used_is_named photos_of_unknown_exposure_among_others sources_that_are_none_are_named; do run "$t"; done
