# films for two eyes and in other formats: what make makes, tags, the limits of disparity, errors
. tests/lib.sh
unset EYES FILM
project eyes
photos set --views 3 --size 160x120 >/dev/null
small t
sed -i 's/^planes = .*/planes = 32\nrounds = 0/; s/^seconds = .*/seconds = 0.25/; s/^max_side = .*/max_side = 96/' scenes/t/scene.cfg
printf '[plan_eyes]\nvr_side = 64\n' >>scenes/t/scene.cfg
make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=t path >log 2>&1 || { cat log; fail "make"; }
film=out/t/parallax/establishing_dolly

unknown_words_are_refused()
{
    for v in EYES=cross FILM=vhs; do
        rc=0; make -s DEPS=manual SCENE=t "$v" video >log 2>&1 || rc=$?
        [ "$rc" != 0 ] || fail "$v was accepted"
        grep -q "$v: wanted words among" log || { cat log; fail "$v: no sentence"; }
    done
}

films_are_made_as_asked()
{
    make -s DEPS=manual SCENE=t EYES="side_by_side vr180" FILM=hlg video >log 2>&1 || { cat log; fail "make"; }
    for f in video video-hlg video-side_by_side video-side_by_side-hlg video-vr180 video-vr180-hlg; do
        [ -s $film/$f.mp4 ] || fail "there is no $f.mp4"
    done
    [ "$(find $film -maxdepth 1 -name 'video*' | wc -l)" = 6 ] || fail "other films were made"
    size() { ffprobe -v error -show_entries stream=width,height -of default=nw=1:nk=1 "$film/$1" | sed -n 1,2p | paste -sd,; }
    [ "$(size video.mp4)" = 96,72 ] && [ "$(size video-side_by_side.mp4)" = 192,72 ] && [ "$(size video-vr180.mp4)" = 128,64 ] || fail "sizes"
    ffprobe -v error -show_streams $film/video-vr180-hlg.mp4 >tags
    for t in 'side by side' 'Spherical Mapping' arib-std-b67 bt2020nc yuv420p10le; do grep -q "$t" tags || { cat tags; fail "no $t"; }; done
    # nothing is made again, also with fewer words
    make -s DEPS=manual SCENE=t EYES=vr180 video >log 2>&1
    ! grep -q 'encode_video\|render_views\|plan_eyes' log || { cat log; fail "a second run made something"; }
}

disparities_keep_their_limits()
{
    awk '$1 == "front" || $1 == "behind" { n++; if ($3 > $4 * 1.1) exit 1 } $1 == "near_ratio" && $2 < $3 * 0.999 { exit 1 }
        END { if (n != 2) exit 1 }' $film/eyes.txt || { cat $film/eyes.txt; fail "a limit is exceeded"; }
    grep -q 'of the width (.* px) in front of the screen' out/t/log/plan_eyes.*.log || fail "the log does not state the disparities"
    grep -q '^kind half_sphere$' $film/vr180/eyes.txt || fail "kind"
}

settings_make_the_eyes_again()
{
    sed 's/\[plan_eyes\]/&\nbase = 5/' scenes/t/scene.cfg >cfg && cp cfg scenes/t/scene.cfg
    make -s DEPS=manual SCENE=t EYES=side_by_side eyes >log 2>&1 || { cat log; fail "make"; }
    grep -q '^base 5 base$' $film/eyes.txt || { cat $film/eyes.txt; fail "base"; }
    grep -q 'near things will be hard to fuse' out/t/log/plan_eyes.*.log || fail "no warning"
}

bad_arguments_are_refused_with_a_sentence()
{
    code() { local rc=0; "$@" >out.txt 2>err.txt || rc=$?; [ "$rc" = 2 ] || { cat err.txt; fail "$*: exit $rc"; }; }
    code "$B/bin/encode_video" --path $film --frames $film/frames --out x.mp4 --film vhs
    grep -q 'wanted one of h264, av1' err.txt || fail "no formats"
    code "$B/bin/encode_video" --path $film --frames $film/frames --out x.mp4 --eyes vr180
    grep -q 'wanted both --eyes and --right' err.txt || fail "no sentence about --right"
    code "$B/bin/plan_eyes" --views out/t/views --depth out/t/depth --path $film --out x --picture round
    grep -q 'wanted flat or half_sphere' err.txt || fail "no pictures"
    code "$B/bin/render_views" --views out/t/views --depth out/t/depth --path $film --frames 1 --out x --picture round
    grep -q 'wanted flat or half_sphere' err.txt || fail "no pictures"
    [ ! -e x ] && [ ! -e x.mp4 ] || fail "a file was left"
}

for t in unknown_words_are_refused films_are_made_as_asked disparities_keep_their_limits settings_make_the_eyes_again bad_arguments_are_refused_with_a_sentence; do run "$t"; done
