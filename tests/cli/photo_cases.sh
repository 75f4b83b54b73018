# import_photos on photos as people have them, for developers who have ../shared/data/cases
. tests/lib.sh
cases=$root/../shared/data/cases

# imported CASE: imports its photos into $scratch/CASE; messages go to $scratch/err
imported()
{
    [ -d "$cases/$1" ] || skip "$cases/$1 does not exist"
    "$B/bin/import_photos" --photos "$cases/$1" --out "$scratch/records" 2>"$scratch/err"
}
says() { grep -qF -- "$1" "$scratch/err" || { cat "$scratch/err"; fail "nothing says '$1'"; }; }
grouped() { grep -v '^#' "$scratch/records/brackets.txt" | cmp - <(printf '%s\n' "$@") || { cat "$scratch/records/brackets.txt"; fail "wrong groups"; }; }

aperture_priority_is_bracketed()
{
    imported brackets-aperture-priority/photos || fail "it failed"
    says "6 views of 3 exposures each"
    grouped "IMG_0001 IMG_0002.JPG IMG_0001.JPG IMG_0003.JPG" "IMG_0004 IMG_0005.JPG IMG_0004.JPG IMG_0006.JPG" \
        "IMG_0007 IMG_0008.JPG IMG_0007.JPG IMG_0009.JPG" "IMG_0010 IMG_0011.JPG IMG_0010.JPG IMG_0012.JPG" \
        "IMG_0013 IMG_0014.JPG IMG_0013.JPG IMG_0015.JPG" "IMG_0016 IMG_0017.JPG IMG_0016.JPG IMG_0018.JPG"
}

# 9998 9999 0001 is one view
a_counter_may_wrap()
{
    imported brackets-counter-wraps/photos || fail "it failed"
    says "6 views of 3 exposures each"
    for view in "DSC_9993.JPG DSC_9992.JPG DSC_9994.JPG" "DSC_9996.JPG DSC_9995.JPG DSC_9997.JPG" "DSC_9999.JPG DSC_9998.JPG DSC_0001.JPG" \
        "DSC_0003.JPG DSC_0002.JPG DSC_0004.JPG" "DSC_0006.JPG DSC_0005.JPG DSC_0007.JPG" "DSC_0009.JPG DSC_0008.JPG DSC_0010.JPG"; do
        grep -q " $view\$" "$scratch/records/brackets.txt" || { cat "$scratch/records/brackets.txt"; fail "$view is no view"; }
    done
}

exposures_may_be_equal()
{
    imported brackets-equal-exposures/photos || fail "it failed"
    says "4 views of 4 exposures each"
    grouped "IMG_0001 IMG_0001.JPG IMG_0002.JPG IMG_0003.JPG IMG_0004.JPG" "IMG_0005 IMG_0005.JPG IMG_0006.JPG IMG_0007.JPG IMG_0008.JPG" \
        "IMG_0009 IMG_0009.JPG IMG_0010.JPG IMG_0011.JPG IMG_0012.JPG" "IMG_0013 IMG_0013.JPG IMG_0014.JPG IMG_0015.JPG IMG_0016.JPG"
}

photos_of_phones_are_used()
{
    imported phone-formats/photos || fail "it failed"
    [ "$(cut -d' ' -f1 "$scratch/records/list.txt" | tr -d '\n')" = IMG_000IMG_001IMG_002IMG_003IMG_004IMG_005IMG_006IMG_007IMG_008 ] || fail "wrong photos"
    ! imported phone-formats/subfolders || fail "photos in a subfolder are used"
    says "cam1 (folders with photos, which are not searched; move the photos into one folder, or give that one as the folder of photos)"
}

colour_spaces_are_named()
{
    imported colour-profiles/photos || fail "it failed"
    for words in "kermit000.jpg: its colours are in Artifex Software A98 ICC Profile" "kermit001.png: its colours are in Artifex Software ROMMRGB ICC" \
        "kermit002.png: its colours are in gAMA 1" "p3-kermit000.jpg and 1 more photos: their colours are in Display P3 (test)"; do says "$words"; done
}

# placed PHOTOS OUT: the poses of photos without brackets, as lines FILE QW QX QY QZ
placed()
{
    local p b=$B/bin; mkdir "$2"
    "$b/import_photos" --photos "$1" --out "$2/records" 2>"$scratch/err" || return
    for p in $(cut -d' ' -f1 "$2/records/list.txt"); do "$b/extract_features" --photos "$1" --records "$2/records" --photo "$p" --out "$2/features/$p.txt" 2>"$scratch/err" || return; done
    "$b/choose_pairs" --records "$2/records" --features "$2/features" --out "$2/pairs.txt" 2>"$scratch/err" || return
    for p in $(cut -d' ' -f1 "$2/records/list.txt"); do "$b/match_photos" --pairs "$2/pairs.txt" --features "$2/features" --photo "$p" --out "$2/matches/$p.txt" 2>"$scratch/err" || return; done
    "$b/sfm" --photos "$1" --records "$2/records" --features "$2/features" --matches "$2/matches" --out "$2/sfm" 2>"$scratch/err" || return
    awk '!/^#/ && NF == 10 && $10 ~ /jpg$/ { print $10, $2, $3, $4, $5 }' "$2/sfm/0/images.txt" | sort >"$2/poses"
}

# texts burnt into all photos have up to 80 % of the matches of a pair
what_stands_still_does_not_place_photos()
{
    [ -d "$cases/watermark" ] || skip "$cases/watermark does not exist"
    command -v colmap >/dev/null || skip "colmap is not installed"
    placed "$cases/../kermit/photos" "$scratch/plain" || { cat "$scratch/err"; fail "kermit"; }
    ! grep -q "stands still" "$scratch/err" || { cat "$scratch/err"; fail "something stands still in kermit"; }
    placed "$cases/watermark/photos" "$scratch/marked" || { cat "$scratch/err"; fail "watermark"; }
    says "something stands still in 11 of 11 photos"
    says "copy $scratch/marked/sfm/still-kermit000.png to masks/PHOTO.png"
    [ -s "$scratch/marked/sfm/still-kermit000.png" ] || fail "no mask"
    # turns from each photo to the next, as quaternions: the angle between those of both models
    join "$scratch/plain/poses" "$scratch/marked/poses" | awk '
        { for (m = 0; m < 2; m++) { for (i = 0; i < 4; i++) q[m, i] = $(2 + 4 * m + i)
            if (NR > 1) { w[m] = q[m, 0] * p[m, 0] + q[m, 1] * p[m, 1] + q[m, 2] * p[m, 2] + q[m, 3] * p[m, 3]
                x[m] = -q[m, 0] * p[m, 1] + q[m, 1] * p[m, 0] - q[m, 2] * p[m, 3] + q[m, 3] * p[m, 2]
                y[m] = -q[m, 0] * p[m, 2] + q[m, 2] * p[m, 0] - q[m, 3] * p[m, 1] + q[m, 1] * p[m, 3]
                z[m] = -q[m, 0] * p[m, 3] + q[m, 3] * p[m, 0] - q[m, 1] * p[m, 2] + q[m, 2] * p[m, 1] } }
          for (m = 0; m < 2; m++) for (i = 0; i < 4; i++) p[m, i] = q[m, i]
          if (NR > 1) { c = w[0] * w[1] + x[0] * x[1] + y[0] * y[1] + z[0] * z[1]; c = c < 0 ? -c : c
            a = c < 1 ? 2 * atan2(sqrt(1 - c * c), c) * 180 / 3.14159265 : 0; if (a > most) most = a } }
        END { print NR, most; exit !(NR == 11 && most < 0.6) }' || fail "photos are placed wrong"
}

for t in aperture_priority_is_bracketed a_counter_may_wrap exposures_may_be_equal photos_of_phones_are_used colour_spaces_are_named what_stands_still_does_not_place_photos; do run "$t"; done
