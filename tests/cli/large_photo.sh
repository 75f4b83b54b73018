# Large photos: memory by pixel, and the same picture as from a small one.
. tests/lib.sh
cd "$scratch" || exit 1
export PATH=$root/$B/bin:$PATH

# photo NAME WIDTH HEIGHT: writes photos-NAME/{a,b}.jpg and a view of half a megapixel through a lens with distortion
photo()
{
    mkdir -p "photos-$1" "views-$1"
    ffmpeg -y -v error -f lavfi -i "testsrc2=size=$2x$3:rate=1" -frames:v 2 -q:v 3 -pix_fmt yuvj420p "photos-$1/%d.jpg"
    mv "photos-$1/1.jpg" "photos-$1/a.jpg"; mv "photos-$1/2.jpg" "photos-$1/b.jpg"
    local f=$(($2 * 4 / 5))
    echo "1 PINHOLE 800 600 640 640 400 300" >"views-$1/cameras.txt"
    printf '1 1 0 0 0 0 0 0 1 a.exr\n\n' >"views-$1/images.txt"
    : >"views-$1/points3D.txt"
    printf 'remodel-lenses 1\na a SIMPLE_RADIAL %d %d %d %d %d -0.05 turn 1 0 0 0\n' "$2" "$3" "$f" $(($2 / 2)) $(($3 / 2)) >"views-$1/lenses.txt"
}
# peak: MiB, from a stage's last line
peak() { sed -n 's/.* \([0-9]*\) MiB peak$/\1/p' err | tail -n 1; }
imported() { import_photos --photos "photos-$1" --out "records-$1" --threads 2 2>err || { cat err; fail "import_photos"; }; peak; }
rectified() { rectify --photo a --photos "photos-$1" --records "records-$1" --views "views-$1" --out "out-$1" --threads 2 2>err || { cat err; fail "rectify"; }; peak; }

# 3 bytes a pixel, and the file; floats with noise and marks would be 17 more. Import keeps no pixels, only two files.
memory_is_that_of_the_stored_photo()
{
    case $FLAVOR in asan*) skip "the sanitizers take memory of their own" ;; esac
    photo small 1600 1200; photo large 6400 4800
    local a b c d mib=$(((6400 * 4800 - 1600 * 1200) * 3 / 1048576)) file
    file=$(($(stat -c %s photos-large/a.jpg) / 1048576 + 1))
    a=$(imported small); b=$(imported large); c=$(rectified small); d=$(rectified large)
    [ $((b - a)) -le $((2 * file + 16)) ] || fail "import_photos takes $((b - a)) MiB more for 29 Mpx more, wanted two files of $file MiB"
    [ $((d - c)) -le $((mib + file + 16)) ] || fail "rectify takes $((d - c)) MiB more for 29 Mpx more, wanted $mib and a file of $file MiB"
}

the_picture_does_not_depend_on_threads()
{
    photo large 2400 1800; imported large >/dev/null; rectified large >/dev/null
    cp out-large/a.exr first.exr
    rectify --photo a --photos photos-large --records records-large --views views-large --out out-large --threads 1 2>err || { cat err; fail "rectify"; }
    cmp first.exr out-large/a.exr || fail "one thread gives different bytes"
}

for t in memory_is_that_of_the_stored_photo the_picture_does_not_depend_on_threads; do run "$t"; done
