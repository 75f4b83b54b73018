# photographs as people have them: the same eleven as JPEG, as HEIC in Display P3, as a clip of 10 bits in HLG that is held upright, and
# a room as panoramas; each gives a film from one command, and its imported pictures have the colours of the sRGB originals (mean
# CIEDE2000 below 1). Prints a table of both
. tests/lib.sh
tool=$root/$B/tests/pipeline/picture_tool
data=$root/../shared/data/kermit/photos
project kinds

# originals: kermit's photos, or a made-up set where these are missing
originals()
{
    [ ! -e originals ] || return 0
    if [ -d "$data" ]; then mkdir originals; cp "$data"/*.jpg originals; chmod u+w originals/*
    else photos made --views 9 --size 640x480 >/dev/null; mv made/photos originals; fi
}
# film SCENE [VARIABLE=VALUE...]: one command, of few and small frames
film()
{
    local began=$SECONDS
    tiny "$1"
    make -s DEPS=manual SCENE="$1" "${@:2}" >"$1.log" 2>&1 || { tail -n 20 "$1.log"; fail "no film"; }
    [ -s "out/$1/parallax/establishing_dolly/video.mp4" ] || fail "no film"
    seconds=$((SECONDS - began))
}
# told KIND DELTAS: a row of the table; DELTAS: a file with the difference of each picture. The mean is below 1
told()
{
    awk -v kind="$1" -v seconds="$seconds" '{ sum += $1; if ($1 > most) most = $1 }
        END { printf "# %-28s %2d pictures, mean CIEDE2000 %.3f, at most %.3f; film in %d s\n", kind, NR, sum / NR, most, seconds; exit !(NR && sum / NR < 1) }' "$2" >row &&
        cat row >&3 || { cat row; fail "the colours are off"; }
}

jpeg()
{
    originals
    film jpeg PHOTOS=originals
    for f in originals/*.jpg; do "$tool" delta "$f" "$f"; done >deltas
    told "JPEG" deltas
}

heic_in_p3()
{
    command -v heif-enc >/dev/null || skip "heif-enc is not installed"
    originals
    mkdir heic
    local f n
    for f in originals/*.jpg; do
        n=$(basename "$f" .jpg)
        "$tool" p3 "$f" p3.png
        heif-enc -q 96 p3.png -o "heic/$n.HEIC" >/dev/null 2>&1 || skip "heif-enc has no encoder of HEVC"
    done
    film heic PHOTOS=heic
    grep -q 'their colours are in' heic.log || fail "the colour space is not named"
    for f in originals/*.jpg; do "$tool" delta "$f" "heic/$(basename "$f" .jpg).HEIC"; done >deltas
    told "HEIC in P3, imported" deltas
    # as the views that depth and films are made of start: merged radiance on one scale
    for f in originals/*.jpg; do "$tool" delta "$f" "out/heic/hdr/$(basename "$f" .jpg).exr"; done >deltas
    told "HEIC in P3, S/hdr" deltas
}

# a clip that shows each photo for four frames, stored sideways as by a phone that is held upright
clip()
{
    local f k i=0 turned=(-metadata:s:v rotate=270) # before ffmpeg 6 it counted the other way
    mkdir signals
    for f in originals/*.jpg; do
        "$tool" "$1" "$f" one.png
        for k in 1 2 3 4; do cp one.png "signals/$(printf %04d $i).png"; i=$((i + 1)); done
    done
    ffmpeg -loglevel error -y -framerate 10 -i signals/%04d.png -vf "transpose=2,scale=out_color_matrix=bt2020:out_range=tv:flags=accurate_rnd+full_chroma_int,format=$2,setparams=color_primaries=bt2020:color_trc=arib-std-b67:colorspace=bt2020nc" \
        -c:v libx264 -crf 8 -color_primaries bt2020 -color_trc arib-std-b67 -colorspace bt2020nc -color_range tv sideways.mov || fail "ffmpeg"
    if ffmpeg -hide_banner -h full 2>/dev/null | matches display_rotation; then ffmpeg -loglevel error -y -display_rotation -90 -i sideways.mov -c copy clip.mov
    else ffmpeg -loglevel error -y -i sideways.mov -c copy "${turned[@]}" clip.mov; fi || fail "ffmpeg"
}
mov_of_a_phone()
{
    ffmpeg -hide_banner -h encoder=libx264 2>/dev/null | matches yuv420p10 || skip "ffmpeg encodes no H.264 of 10 bits"
    originals
    clip hlg yuv420p10le
    film mov PHOTOS=clip.mov
    ls originals >names
    for f in out/mov/frames/clip_f*.png; do
        n=${f##*_f} n=$((10#${n%.png} / 4 + 1))
        "$tool" delta "originals/$(sed -n ${n}p names)" "$f"
    done >deltas
    [ "$(wc -l <deltas)" -ge 6 ] || fail "few frames were chosen"
    told "MOV, 10-bit HLG, turned" deltas
}

panoramas()
{
    mkdir panoramas
    local k v yaw side
    for k in 0 1 2 3 4 5 6 7; do "$tool" panorama $k "panoramas/room$k.jpg" & [ $((k % 2)) = 0 ] || wait; done
    film room PHOTOS=panoramas
    for v in out/room/frames/room[06]_yaw*.png; do
        k=${v##*/room} k=${k%%_*} yaw=${v##*_yaw} yaw=${yaw%.png}
        side=$(od -An -tu1 -j16 -N4 "$v" | awk '{ print $3 * 256 + $4 }')
        "$tool" pinhole "$k" "$((10#$yaw))" "$side" truth.png
        "$tool" delta truth.png "$v"
    done >deltas
    [ "$(wc -l <deltas)" = 12 ] || fail "not all views are there"
    told "equirectangular" deltas
}

exec 3>&1
for t in jpeg heic_in_p3 mov_of_a_phone panoramas; do run "$t"; done
