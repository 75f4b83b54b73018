# photos of 200 megapixels, as phones take them: import_photos and rectify stay below 1.5 GiB
. tests/lib.sh
cd "$scratch" || exit 1
export PATH=$root/$B/bin:$PATH
most=1536 # MiB

peak() { sed -n 's/.* \([0-9]*\) MiB peak$/\1/p' err | tail -n 1; }

two_hundred_megapixels_fit_into_memory()
{
    case $FLAVOR in asan*) skip "the sanitizers take memory of their own" ;; esac
    mkdir photos views
    ffmpeg -v error -f lavfi -i testsrc2=size=16320x12240 -frames:v 1 -q:v 3 -pix_fmt yuvj420p photos/a.jpg
    cp photos/a.jpg photos/b.jpg; printf ' ' >>photos/b.jpg # other bytes: of two that are alike one is left out
    echo "1 PINHOLE 1600 1200 1280 1280 800 600" >views/cameras.txt
    printf '1 1 0 0 0 0 0 0 1 a.exr\n\n' >views/images.txt
    : >views/points3D.txt
    printf 'remodel-lenses 1\na a SIMPLE_RADIAL 16320 12240 13056 8160 6120 -0.05 turn 1 0 0 0\n' >views/lenses.txt
    import_photos --photos photos --out records 2>err || { cat err; fail "import_photos"; }
    [ "$(peak)" -le $most ] || fail "import_photos takes $(peak) MiB, wanted at most $most"
    rectify --photo a --photos photos --records records --views views --out out 2>err || { cat err; fail "rectify"; }
    [ "$(peak)" -le $most ] || fail "rectify takes $(peak) MiB, wanted at most $most"
}

run two_hundred_megapixels_fit_into_memory
