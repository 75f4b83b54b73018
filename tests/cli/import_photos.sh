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
    cp "$c/rgb.jpg" "$m/1.jfif"; cp "$c/rgb.jpg" "$m/2.HEIC"; cp "$c/rgb.heic" "$m/3.HEIC"; cp "$c/rgb.webp" "$m/4.webp"
    cp "$c/rgb.jpg" "$m/cam1/5.jpg"; cp "$c/rgb.jpg" "$m/1.jfif_original"; cp "$c/rgb.jpg" "$m/._2.jpg"; echo >"$m/6.mov"; echo >"$m/7.xmp"
    "$B/bin/import_photos" --photos "$m" --out "$scratch/mixed-records" 2>"$scratch/err" || { cat "$scratch/err"; fail "it failed"; }
    [ "$(cut -d' ' -f1 "$scratch/mixed-records/list.txt" | tr '\n' ' ')" = "1 2 3 4 " ] || fail "wrong photos"
    grep -qx 'BRACKETED := yes' "$scratch/mixed-records/photos.mk" || fail "COLMAP would get HEIC"
    for words in "warning: not used in $m: cam1 (folders with photos" "warning: not used in $m: 6.mov (videos" "not used in $m: 1.jfif_original (backups" \
        "not used in $m: ._2.jpg (hidden" "not used in $m: 7.xmp (no pictures)"; do
        grep -qF "$words" "$scratch/err" || { cat "$scratch/err"; fail "nothing says '$words'"; }
    done
    rc=0; "$B/bin/import_photos" --photos "$m" --out "$scratch/mixed-records" --set brackets=no 2>"$scratch/err" || rc=$?
    [ "$rc" = 1 ] && grep -qF "3.HEIC is HEIC, AVIF, WebP or JPEG XL, which COLMAP does not read" "$scratch/err" || { cat "$scratch/err"; fail "brackets = no"; }
}

for t in invalid_grids_are_rejected invalid_parameters_are_rejected photos_that_cannot_be_cut_are_named cut_pictures_are_photos files_are_known_by_their_content; do run "$t"; done
