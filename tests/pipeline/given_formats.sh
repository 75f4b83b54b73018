# cameras of other programs, from the first call to depth: transforms.json of a scanning app, with depth
. tests/lib.sh
project formats
photos set --views 3 >/dev/null

# transforms: set/model as an app writes it, cameras without points and a map of depth 5 for two of three photos
transforms()
{
    mkdir -p app/images
    local k
    for k in 1 2; do
        ffmpeg -loglevel error -y -f lavfi -i color=gray:size=80x60 -frames:v 1 -pix_fmt gray16be "app/images/photo_$k.depth.png"
    done
    awk '
        FILENAME ~ /cameras/ && !/^#/ { w = $3; h = $4; f = $5; model = $2 }
        FILENAME ~ /images/ && !/^#/ && NF >= 10 && $10 ~ /photo/ {
            a = $2; b = $3; c = $4; d = $5
            r[0,0] = 1 - 2 * (c * c + d * d); r[0,1] = 2 * (b * c - a * d); r[0,2] = 2 * (b * d + a * c)
            r[1,0] = 2 * (b * c + a * d); r[1,1] = 1 - 2 * (b * b + d * d); r[1,2] = 2 * (c * d - a * b)
            r[2,0] = 2 * (b * d - a * c); r[2,1] = 2 * (c * d + a * b); r[2,2] = 1 - 2 * (b * b + c * c)
            m = ""
            for (i = 0; i < 3; i++) {
                center = -(r[0,i] * $6 + r[1,i] * $7 + r[2,i] * $8)
                m = m sprintf("[%.12g, %.12g, %.12g, %.12g], ", r[0,i], -r[1,i], -r[2,i], center)
            }
            name = $10; sub(/\..*/, "", name)
            depth = name == "photo_3" ? "" : sprintf(", \"depth_path\": \"images/%s.depth.png\"", name)
            frames = frames (n++ ? ", " : "") sprintf("{\"file_path\": \"images/%s\"%s, \"transform_matrix\": [%s[0, 0, 0, 1]]}", name, depth, m)
        }
        END { printf "{\"w\": %d, \"h\": %d, \"fl_x\": %s, \"integer_depth_scale\": 0.0001525879, \"frames\": [%s]}\n", w, h, f, frames }
    ' set/model/cameras.txt set/model/images.txt >app/transforms.json
}

depth_of_a_scanning_app_is_used()
{
    transforms
    small app
    sed -i 's/^planes = .*/planes = 32\nrounds = 0/' scenes/app/scene.cfg
    make -s DEPS=manual SCENE=app PHOTOS=set/photos SFM=app depth >log 2>&1 || { cat log; fail "make depth"; }
    grep -q '3 of 3 photos are placed' out/app/log/sfm_import.all.log || { cat log; fail "not all photos are placed"; }
    grep -q 'triangulated [0-9]* points' out/app/log/sfm.all.log || { cat log; fail "no points were triangulated"; }
    grep -q 'gives the depth of 2 of 3 views' log || { cat log; fail "the depth is not used"; }
    [ "$(cat out/app/sfm_depth/depth.txt)" = $'scale 0.0001525879\npixels photo' ] || { cat out/app/sfm_depth/depth.txt; fail "other units"; }
    grep -qF 'given/photo_1.png' out/app/depth/photo_1.txt || fail "photo_1 does not know its depth"
    ! grep -qF 'given/' out/app/depth/photo_3.txt || fail "photo_3 has depth that nobody gave"
    make -s DEPS=manual SCENE=app PHOTOS=set/photos SFM=app depth >again 2>&1 || { cat again; fail "make depth again"; }
    ! grep -q 'segment_depth' again || { cat again; fail "depth was made again"; }
}

run depth_of_a_scanning_app_is_used
