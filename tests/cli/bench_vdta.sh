# the bench of atlases: its photographs are kept until the description changes, and its scenes follow the photos' size
. tests/lib.sh
project atlases
export BENCH_HELDOUT=''
B=$root/$B

mkdir -p scenes/room/edits
cat >scenes/room/scene.txt <<'TXT'
remodel-scene 1
texture plain plaster 0.3 0.4 1  0.6 0.58 0.5
material m lambert plain
room hall 0 0 4 3  0 2.5  m m
wall south 0 0 4 0  0 2.5 0.2 m
wall east 4 0 4 3  0 2.5 0.2 m
wall north 4 3 0 3  0 2.5 0.2 m
wall west 0 3 0 0  0 2.5 0.2 m
window w south 1 3  0.8 2.2
box chest 3 2 0  3.5 2.5 0.8  m
lamp l quad 1 1 2.49  0 1 0  1 0 0  10 10 9
sun -100 40 1  2000 1900 1700
panorama 3  1.6 1.9 2.3  0.8 0.8 0.6
TXT
cat >scenes/room/cameras.txt <<'TXT'
remodel-shoot 1
lens p pinhole 60 40 50 50 30 20
exposure 0.02
sensor 30000 6 1 5
photo a p 1 1 1.5  3 2 1.2
photo b p 1.2 1 1.5  3 2 1.2
photo c p 1.4 1 1.5  3 2 1.2
photo d p 1.6 1 1.5  3 2 1.2
witness w p 1.3 1 1.5  3 2 1.2
TXT
printf '[simulate]\nsamples = 8\n[sfm]\ncamera_params = 50\n' >scenes/room/scene.cfg
printf '# drawn in a\nwall north in a 10.5 20 30 40 thickness 0.3\njoin north east\n' >scenes/room/model.txt
printf 'mark left a 8 12\nlength left right 4.5\n' >scenes/room/scale.txt
printf 'remove north\n' >scenes/room/edits/open.txt

# The functions of the bench, in its own project; SCALE.
bench()
{
    work=$scratch/work fast=$scratch/work here=tests/bench
    mkdir -p "$work"
    # shellcheck disable=SC2317 # the bench calls it
    missing() { cat "$work/messages" "$scratch/err"; fail "$*"; }
    BENCH_SCENE=room BENCH_SCALE=$1 BENCH_SAMPLES=1 BENCH_SHELL_SAMPLES=2 BENCH_SHELL="a c"
    . "$root/tests/bench/vdta.sh"
}
shoot_all() { { shoot; shoot_shell; } 2>"$scratch/err"; }
times() { find "$kept" -type f -printf '%P %T@\n' | LC_ALL=C sort; }

photographs_are_kept_until_the_description_changes()
{
    bench 0.5
    shoot_all
    grep -q 'photographing room at scale 0.5' "$scratch/err" || fail "nothing tells that photographs are made"
    grep -q '^photos: ' "$scratch/err" || fail "nothing tells how long the photos take"
    grep -q 'photographing room at scale 0.5 without furniture' "$scratch/err" || fail "nothing tells that the shell is photographed"
    [ "$(ls "$kept/room/photos" | wc -l)" = 4 ] || fail "wanted four photos"
    [ "$(ls "$kept/suns/photos" | tr '\n' ' ')" = 'b.jpg d.jpg ' ] || fail "wanted every second photo under another sun"
    [ "$(ls "$kept/room/truth/shell/ids" | tr '\n' ' ')" = 'a.exr b.exr c.exr d.exr w.exr ' ] || fail "the shell's ids are of other views"
    [ "$(ls "$kept/room/truth/shell/hdr" | tr '\n' ' ')" = 'a.exr c.exr w.exr ' ] || fail "the shell's radiance is of other views"
    times >"$scratch/a"
    shoot_all
    times | cmp - "$scratch/a" || fail "a second run made pictures again"
    [ ! -s "$scratch/err" ] || fail "a second run says something"
    sed -i 's/^photo b p 1.2/photo b p 1.25/' scenes/room/cameras.txt
    shoot_all
    times | cmp -s - "$scratch/a" && fail "a moved camera did not make pictures again"
    return 0
}

half_of_the_photos_have_the_other_sun_and_no_true_shell()
{
    bench 0.5
    shoot_all
    [ "$(ls "$kept/mixed/photos" | tr '\n' ' ')" = 'a.jpg b.jpg c.jpg d.jpg ' ] || fail "photos are missing"
    cmp "$kept/mixed/photos/a.jpg" "$kept/room/photos/a.jpg" || fail "the first photo has another sun"
    ! cmp -s "$kept/mixed/photos/b.jpg" "$kept/room/photos/b.jpg" || fail "the second photo has the same sun"
    cmp "$kept/mixed/truth/hdr/b.exr" "$kept/suns/truth/hdr/b.exr" || fail "the truth of the second photo has the wrong sun"
    [ "$(ls "$kept/mixed/truth/shell/hdr" | tr '\n' ' ')" = 'a.exr c.exr w.exr ' ] || fail "the shell's radiance is of other views"
    mv "$kept" "$scratch/moved" # links are relative
    cmp "$scratch/moved/mixed/photos/b.jpg" "$scratch/moved/suns/photos/b.jpg" || fail "links do not follow the folder"
}

scripts_follow_the_size_of_the_photos()
{
    bench 0.5
    new_scene t "$kept/photos" "$kept/truth"
    local to=$kept/project/scenes/t
    grep -q '^wall north in a 5.25 10 15 20 thickness 0.3$' "$to/model.txt" || { cat "$to/model.txt"; fail "the model has other clicks"; }
    grep -q '^mark left a 4 6$' "$to/scale.txt" || { cat "$to/scale.txt"; fail "the scale has other marks"; }
    grep -q '^length left right 4.5$' "$to/scale.txt" || fail "a length was scaled"
    grep -q '^camera_params = 25$' "$to/scene.cfg" || { cat "$to/scene.cfg"; fail "the lens has another focal length"; }
    cmp "$to/edits/open.txt" scenes/room/edits/open.txt || fail "the edit changed"
    printf 'disk spot in a 8 12 rim 10 12 off 0.5\n' >marks.txt
    [ "$(scaled marks.txt)" = 'disk spot in a 4 6 rim 5 6 off 0.5' ] || { scaled marks.txt; fail "a lamp has other marks"; }
    bench 1
    new_scene t "$kept/photos" "$kept/truth"
    cmp "$kept/project/scenes/t/model.txt" scenes/room/model.txt || fail "at full size the model changed"
}

a_scene_that_is_not_described_is_refused()
{
    rc=0; BENCH_SCENE=none tests/bench/run vdta "$B" 2>"$scratch/err" || rc=$?
    [ "$rc" = 3 ] || { cat "$scratch/err"; fail "exit $rc, wanted 3"; }
    grep -q 'there is no scenes/none/scene.txt' "$scratch/err" || { cat "$scratch/err"; fail "another message"; }
}

for t in photographs_are_kept_until_the_description_changes half_of_the_photos_have_the_other_sun_and_no_true_shell \
    scripts_follow_the_size_of_the_photos a_scene_that_is_not_described_is_refused; do run "$t"; done
