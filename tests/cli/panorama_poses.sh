# panoramas with given poses, for developers who have ../shared/data/zind-open: their views are the pinhole pictures that others cut
# out of them, with the cameras that these have
. tests/lib.sh
data=$root/../shared/data/zind-open
export PATH=$root/$B/bin:$PATH
cd "$scratch" || exit 1

# transforms: the pose of each panorama is that of the picture in its middle, in the axes of OpenGL from camera to world
transforms()
{
    awk '
        BEGIN { printf "{\"camera_model\": \"EQUIRECTANGULAR\", \"frames\": [" }
        /^#/ || NF != 10 || $10 !~ /_p000.jpg$/ { next }
        {
            a = $2; b = $3; c = $4; d = $5; name = $10; sub(/_p000/, "", name)
            r[0,0] = 1 - 2 * (c * c + d * d); r[0,1] = 2 * (b * c - a * d); r[0,2] = 2 * (b * d + a * c)
            r[1,0] = 2 * (b * c + a * d); r[1,1] = 1 - 2 * (b * b + d * d); r[1,2] = 2 * (c * d - a * b)
            r[2,0] = 2 * (b * d - a * c); r[2,1] = 2 * (c * d + a * b); r[2,2] = 1 - 2 * (b * b + c * c)
            m = ""
            for (i = 0; i < 3; i++)
                m = m sprintf("[%.12g, %.12g, %.12g, %.12g], ", r[0,i], -r[1,i], -r[2,i], -(r[0,i] * $6 + r[1,i] * $7 + r[2,i] * $8))
            printf "%s{\"file_path\": \"%s\", \"transform_matrix\": [%s[0, 0, 0, 1]]}", n++ ? ", " : "", name, m
        }
        END { print "]}" }' "$data/truth/images.txt" >"$1/transforms.json"
}

# poses FILE: NAME QW QX QY QZ CX CY CZ of each image, with the names of views
poses()
{
    awk '!/^#/ && NF == 10 {
        sub(/\.[a-z]*$/, "", $10); sub(/_p/, "_yaw", $10); if ($10 !~ /^pano_(2|8|12)_/) next
        w = $2; x = -$3; y = -$4; z = -$5; a = -$6; b = -$7; c = -$8
        u = 2 * (y * c - z * b); v = 2 * (z * a - x * c); s = 2 * (x * b - y * a)
        print $10, $2, $3, $4, $5, a + w * u + y * s - z * v, b + w * v + z * u - x * s, c + w * s + x * v - y * u }' "$1" | sort
}
bytes() { ffmpeg -loglevel error "$@" -f rawvideo -pix_fmt rgb24 -; }

views_of_panoramas_are_the_pinhole_pictures_beside_them()
{
    [ -d "$data" ] || skip "$data does not exist"
    mkdir panoramas given
    cp "$data"/panoramas/pano_{2,8,12}.jpg panoramas
    transforms given
    import_photos --photos panoramas --frames frames --out records 2>err || { cat err; fail "import_photos"; }
    sfm --photos frames --records records --model given --out sfm 2>err || { cat err; fail "sfm"; }
    grep -q 'the poses of 3 panoramas are those of their views' err || { cat err; fail "the poses are not used"; }
    sfm_import --sfm sfm --records records --out views 2>err || { cat err; fail "sfm_import"; }
    join <(poses "$data/truth/images.txt") <(poses views/images.txt) >both
    # within 0.001 degrees and 0.1 mm
    awk '{ sign = $2 * $9 + $3 * $10 + $4 * $11 + $5 * $12 < 0 ? -1 : 1
           for (k = d = 0; k < 4; k++) d += ($(2 + k) - sign * $(9 + k))^2
           turn = 2 * sqrt(d) * 57.2958
           way = sqrt(($6 - $13)^2 + ($7 - $14)^2 + ($8 - $15)^2); if (turn > 0.001 || way > 1e-4) { print; bad = 1 } }
         END { exit bad || NR != 18 }' both || fail "cameras differ, or not all 18 are there"
    for p in pano_2_yaw000 pano_8_yaw120 pano_12_yaw300; do
        rectify --photo $p --photos frames --records records --views views --out views 2>err || { cat err; fail "rectify"; }
        bytes -apply_trc iec61966_2_1 -i views/$p.exr >found
        bytes -i "$data/photos/${p/_yaw/_p}.jpg" >wanted
        [ "$(wc -c <found)" = "$(wc -c <wanted)" ] || fail "$p has another size"
        # the mean difference, of 255
        { cmp -l found wanted || true; } | awk -v size="$(wc -c <wanted)" '
            function octal(s) { return 64 * int(s / 100) + 8 * (int(s / 10) % 10) + s % 10 }
            { d = octal($2) - octal($3); sum += d < 0 ? -d : d } END { print sum / size; exit !(sum / size < 2) }' || fail "$p shows something else"
    done
}

run views_of_panoramas_are_the_pinhole_pictures_beside_them
