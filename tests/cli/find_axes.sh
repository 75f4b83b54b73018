# find_axes: axes and floor of a synthetic room, corrections and scale from marks on photos, and when make reruns it
. tests/lib.sh
project axes
photos set --views 6 --size 320x240 >/dev/null
mkdir -p scenes/t
printf '[segment_depth]\nplanes = 48\npasses = 1\nrounds = 0\nneighbours = 3\n' >scenes/t/scene.cfg
make_axes() { make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=t axes >log 2>&1 || { cat log; fail "make axes"; }; }
make_axes
axes=out/t/model/axes.txt
photo=$(sed -n 's/^VIEWS := \([^ ]*\).*/\1/p' out/t/views/views.mk)

# find_them CODE WORD ARGUMENT...: runs find_axes; checks its exit status and a word on standard error
find_them()
{
    local code=$1 word=$2 rc=0; shift 2
    rm -rf made
    "$B/bin/find_axes" --views out/t/views --records out/t/photos --points "${points:-out/t/points/points.ply}" --out made/axes.txt "$@" >out.txt 2>err.txt </dev/null || rc=$?
    [ "$rc" = "$code" ] || { cat err.txt; fail "$*: exit $rc, wanted $code"; }
    grep -qF -- "$word" err.txt || { cat err.txt; fail "$*: nothing says '$word'"; }
    [ "$code" = 0 ] || grep -q 'find_axes: error: .*[.?]$' err.txt || { cat err.txt; fail "$*: no sentence"; }
    [ "$code" = 0 ] || [ ! -e made/axes.txt ] || fail "$*: axes were left"
}

# tilt and turn, in degrees, of the rotation's rows against the room's normals: floor -y, wall (1 0 -4) / sqrt(17)
degrees_off()
{
    awk '$1 == "rotation" {
            w = $2; x = $3; y = $4; z = $5
            up = 2 * (y * z + w * x)                               # -(third row, second column) is cos of the tilt
            tilt = atan2(sqrt((2 * (x * z - w * y)) ^ 2 + (1 - 2 * (x * x + y * y)) ^ 2), -up)
            a = (1 - 2 * (y * y + z * z)) / sqrt(17) - 4 * 2 * (x * z + w * y) / sqrt(17)    # first row . wall
            b = 2 * (x * y + w * z) / sqrt(17) - 4 * 2 * (y * z - w * x) / sqrt(17)          # second row . wall
            off = atan2(a < 0 ? -a : a, b < 0 ? -b : b); far = atan2(1, 0) - off
            printf "%.4f %.4f\n", tilt * 57.29578, (off < far ? off : far) * 57.29578
        }' "$1"
}

axes_of_a_synthetic_room_are_found()
{
    read -r tilt turn < <(degrees_off "$axes")
    awk -v a="$tilt" -v b="$turn" 'BEGIN { exit !(a < 0.2 && b < 0.2) }' || { cat log "$axes"; fail "axes off by $tilt and $turn degrees"; }
    # its floor is the plane y = 1.5, so R and the translation take (0 1.5 0) to the height 0
    awk '$1 == "rotation" { r = 2 * ($4 * $5 + $2 * $3) } $1 == "translation" { h = 1.5 * r + $4; exit !(h < 0.02 && h > -0.02) }' "$axes" ||
        { cat "$axes"; fail "the floor is off"; }
    grep -qx 'scale 1 unknown' "$axes" && grep -qx 'ceiling none' "$axes" || { cat "$axes"; fail "what the room does not have"; }
    [ "$(ls out/t/model/axes/*.png | wc -l)" = 4 ] || { ls out/t/model/axes; fail "the pictures"; }
    ! grep -qF "$PWD" "$axes" || fail "the axes name a folder of this machine"
}

the_result_does_not_depend_on_threads()
{
    find_them 0 'the origin lies on the floor below view' --threads 1
    cmp made/axes.txt "$axes" || diff <(grep -v '^#' made/axes.txt) <(grep -v '^#' "$axes")
    for p in made/axes/*.png; do cmp "$p" "out/t/model/axes/${p##*/}"; done
    find_them 0 'the origin' --threads 3 --set pictures=0
    [ ! -e made/axes ] || fail "pictures that nobody wants"
}

errors_in_marks_name_the_line()
{
    for c in 'meter p q 1|wanted "mark", "length" or "height"' "mark p $photo 10 10|in one view alone" 'length p q 1|p is used' "mark p $photo 1 nan floor|nan"; do
        printf '# marks\n%s\n' "${c%|*}" >marks.txt
        find_them 1 "${c##*|}" --scale marks.txt
        grep -qF 'marks.txt:2: ' err.txt || { cat err.txt; fail "no line"; }
    done
    printf 'mark p nobody 10 200 floor\nmark q %s 200 200 floor\nlength p q 1\n' "$photo" >marks.txt
    find_them 1 "marks.txt:1: found \"nobody\", wanted a photo's id" --scale marks.txt
    printf 'mark p %s 10 0 floor\nmark q %s 200 200 floor\nlength p q 1\n' "$photo" "$photo" >marks.txt
    find_them 1 'marks.txt:1: the floor is not visible' --scale marks.txt
    printf 'corner c %s 10 10\n' "$photo" >marks.txt
    find_them 1 'marks.txt:1: the corner c corrects nothing yet' --fix marks.txt
    find_them 1 nowhere.txt --fix nowhere.txt
    find_them 1 'no two perpendicular directions' --set min_part=0.9
    find_them 2 'min_part' --set min_part=2
    head -c 3000 out/t/points/points.ply >cut.ply
    points=cut.ply find_them 1 cut.ply
}

changed_marks_rebuild_the_axes()
{
    make_axes
    ! grep -q find_axes log || { cat log; fail "made again without a reason"; }
    grep -v '^#' "$axes" >before
    printf 'mark p %s 100 225 floor\nmark q %s 220 225 floor\nlength p q 1\n' "$photo" "$photo" >scenes/t/scale.txt
    make_axes
    grep -q '^scale .* metres' "$axes" && grep -q '^# input scale.txt ' "$axes" || { cat log "$axes"; fail "no scale"; }
    make_axes
    ! grep -q find_axes log || { cat log; fail "made again without a reason"; }
    printf 'corner c %s 160 200\nedge c %s 220 200\n' "$photo" "$photo" >scenes/t/axes_fix.txt
    make_axes
    grep -q 'axes_fix.txt turns the axes by' log || { cat log; fail "no correction"; }
    [ -e "out/t/model/axes/$photo.png" ] || fail "the corner's photo is not drawn on"
    rm scenes/t/scale.txt scenes/t/axes_fix.txt
    make_axes
    grep -v '^#' "$axes" | diff before - || fail "what was marked stays"
    printf '[find_axes]\npictures = 2\n' >>scenes/t/scene.cfg
    make_axes
    [ "$(ls out/t/model/axes/*.png | wc -l)" = 2 ] || { ls out/t/model/axes; fail "pictures of an earlier choice stay"; }
}

run axes_of_a_synthetic_room_are_found
run the_result_does_not_depend_on_threads
run errors_in_marks_name_the_line
run changed_marks_rebuild_the_axes
