# find_subjects: faces in real photographs, drawn rectangles, and errors
. tests/lib.sh
data=$root/../shared/data
project subjects
photos set --views 3 --size 160x120 >/dev/null
small t
sed -i 's/^planes = .*/planes = 32\nrounds = 0/' scenes/t/scene.cfg
make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=t subjects >log 2>&1 || { cat log; fail "make"; }
views=$(sed 's/VIEWS := //' out/t/views/views.mk)
first=${views%% *}

# find_subjects CODE TEXT ARGUMENT...: runs find_subjects on the synthetic scene; checks its exit status and that standard error contains TEXT
find_subjects()
{
    local code=$1 text=$2 rc=0; shift 2
    rm -f made.txt
    "$B/bin/find_subjects" --views out/t/views --depth "${depth:-out/t/depth}" --records out/t/photos --out made.txt "$@" >out.txt 2>err.txt </dev/null || rc=$?
    [ "$rc" = "$code" ] || { cat err.txt; fail "$*: exit $rc, wanted $code"; }
    grep -qF -- "$text" err.txt || { cat err.txt; fail "$*: '$text' is not in the message"; }
    [ "$code" = 0 ] || grep -q 'find_subjects: error: .*[.?]$' err.txt || { cat err.txt; fail "$*: the error is not a sentence"; }
    [ "$code" = 0 ] || [ ! -e made.txt ] || fail "$*: a list was written despite the error"
}

a_scene_without_faces_has_an_empty_list()
{
    grep -qx 'subjects 0' out/t/parallax/subjects.txt || { cat out/t/parallax/subjects.txt; fail "the textured scene has subjects"; }
    find_subjects 0 'no face in the'
    cmp made.txt out/t/parallax/subjects.txt
    find_subjects 0 'no face in the' --threads 1
    cmp made.txt out/t/parallax/subjects.txt
}

drawn_rectangles_become_subjects_in_order()
{
    printf 'subject %s 80 40 120 100\nsubject %s -10 20 30 500\n' "$first" "$first" >drawn.txt
    find_subjects 0 'subject 2: ' --subjects drawn.txt
    [ "$(grep -c "^subject $first user " made.txt)" = 2 ] && [ "$(grep -c '^corner ' made.txt)" = 8 ] || { cat made.txt; fail "the list is wrong"; }
    awk '$1 == "subject" && ++n == 2 { exit !($4 == 0 && $7 == 120 && $8 > 0) }' made.txt || { cat made.txt; fail "the rectangle is not clipped to the picture"; }
    grep -qE 'drawn.txt:2: only [0-9]+ % of the rectangle' err.txt || { cat err.txt; fail "no warning about the clipping"; }
    printf 'subject %s 80 40 82 44\n' "$first" >drawn.txt
    find_subjects 0 'so small a subject' --subjects drawn.txt
    ! grep -qF "$PWD" made.txt || fail "the list contains a path of this machine"
    : >drawn.txt
    find_subjects 0 'names no subject' --subjects drawn.txt
    grep -qx 'subjects 0' made.txt || fail "an empty file gives subjects"
}

invalid_rectangles_are_errors_with_their_line()
{
    find_subjects 1 nowhere.txt --subjects nowhere.txt
    for c in "face $first 1 2 3 4|\"subject\"" "subject $first 1 2 3|y1" "subject $first 9 2 3 4|above X0" "subject $first 1 nan 3 4|nan" \
        "subject nobody 1 2 3 4|lenses.txt" "subject ${first}x 1 2 3 4|did you mean $first" "subject $first 500 2 600 4|outside"; do
        printf '# drawn\n%s\n' "${c%|*}" >drawn.txt
        find_subjects 1 "${c##*|}" --subjects drawn.txt
        grep -qF 'drawn.txt:2: ' err.txt || { cat err.txt; fail "the message names no line"; }
    done
}

a_rectangle_without_depth_is_an_error()
{
    mkdir -p scenes/masked/masks
    cp scenes/t/scene.cfg scenes/masked/
    ffmpeg -v error -f lavfi -i color=white:s=160x120 -vf "drawbox=x=40:y=30:w=60:h=50:color=black:t=fill" -frames:v 1 -y "scenes/masked/masks/$first.png"
    make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=masked depth >log 2>&1 || { cat log; fail "make"; }
    printf 'subject %s 50 40 90 70\n' "$first" >drawn.txt
    sed -i 's/^/ /' drawn.txt
    rc=0
    "$B/bin/find_subjects" --views out/masked/views --depth out/masked/depth --subjects drawn.txt --out made.txt 2>err.txt || rc=$?
    [ "$rc" = 1 ] && grep -qF "drawn.txt:1: nothing in the rectangle from 50 40 to 90 70 of $first has a depth" err.txt || { cat err.txt; fail "exit $rc"; }
    [ ! -e made.txt ] || fail "a list was written despite the error"
}

missing_cascades_are_an_error()
{
    find_subjects 1 'haarcascade_frontalface_alt2.xml' --cascades .
    grep -q 'opencv-data' err.txt || { cat err.txt; fail "the message does not name the package"; }
    echo '<xml' >haarcascade_frontalface_alt2.xml
    find_subjects 1 'haarcascade_frontalface_alt2.xml' --cascades .
}

the_list_is_remade_when_drawn_rectangles_are_added_or_removed()
{
    cp out/t/parallax/subjects.txt before.txt
    printf 'subject %s 80 40 120 100\n' "$first" >scenes/t/subjects.txt
    touch -d '2001-01-01' scenes/t/subjects.txt
    make -s DEPS=manual SCENE=t subjects >log 2>&1 || { cat log; fail "make"; }
    grep -q "^subject $first user" out/t/parallax/subjects.txt || fail "the rectangle is not in the list"
    stat -c %y out/t/parallax/subjects.txt >a
    make -s DEPS=manual SCENE=t subjects >log 2>&1
    stat -c %y out/t/parallax/subjects.txt | diff a - || fail "a second make remade the list"
    rm scenes/t/subjects.txt
    make -s DEPS=manual SCENE=t subjects >log 2>&1 || { cat log; fail "make"; }
    cmp before.txt out/t/parallax/subjects.txt || fail "the faces are not searched again"
}

# wall PHOTO NAME: a scene of five views of a wall with a real photo on it, at a distance of 10. The camera moves parallel to the wall, so
# that the views are shifted crops of the photo and their depth is known.
wall()
{
    local photo=$1 name=$2 i
    mkdir -p "$name/photos" "$name/model" "$name/depth"
    for i in 0 1 2 3 4; do
        ffmpeg -v error -i "$photo" -vf "scale=640:640,crop=560:560:$((20 * i)):40" -frames:v 1 -q:v 2 -y "$name/photos/v$i.jpg"
        ffmpeg -v error -f lavfi -i color=black:s=560x560 -vf "format=gray,geq=lum=100" -frames:v 1 -y "$name/depth/v$i.png"
    done
    echo 'scale 0.1' >"$name/depth/depth.txt"
    echo '1 PINHOLE 560 560 560 560 280 280' >"$name/model/cameras.txt"
    awk -v folder="$name/model" 'BEGIN {
        for (i = 0; i < 5; i++) {
            x = (i - 2) / 2.8
            printf "%d 1 0 0 0 %.17g 0 0 1 v%d.jpg\n", i + 1, -x, i >folder "/images.txt"
            for (p = 0; p < 25; p++) printf "%.17g %.17g %d ", 56 * (p % 5 - 2 - x) + 280, 56 * (int(p / 5) - 2) + 280, p + 1 >folder "/images.txt"
            printf "\n" >folder "/images.txt"
        }
        for (p = 0; p < 25; p++) {
            printf "%d %d %d 10 128 128 128 0.1", p + 1, p % 5 - 2, int(p / 5) - 2 >folder "/points3D.txt"
            for (i = 0; i < 5; i++) printf " %d %d", i + 1, p >folder "/points3D.txt"
            printf "\n" >folder "/points3D.txt"
        }
    }'
    mkdir -p "scenes/$name"
    # depth is given, so that few segments and neighbours do
    sed 's/^neighbours = .*/neighbours = 2\nsegment_pixels = 1000/' scenes/t/scene.cfg >"scenes/$name/scene.cfg"
    make -s DEPS=manual PHOTOS="$name/photos" SFM="$name/model" DEPTH="$name/depth" SCENE="$name" subjects >log 2>&1 || { cat log; fail "make"; }
}

the_face_of_a_statue_is_found_at_its_place_in_space()
{
    local photo=$data/marble-head/photos/DSC05084.jpg
    [ -e "$photo" ] || skip "there is no ../shared/data/marble-head"
    wall "$photo" statue
    cat log
    # the face is at 0.18 .. 0.53 and 0.15 .. 0.50 of the photo; the middle view starts at pixel 40 40 of 640
    awk '$1 == "subjects" { n = $2 }
        $1 == "subject" { view = $2; confirmed = $10; asked = $11; depth = $8 }
        $1 == "corner" { x += $2 / 4; y += $3 / 4; if (++k == 1) left = $2; if (k == 2) width = $2 - left }
        function near(a, b, by) { return a > b - by && a < b + by }
        END { exit !(n == 1 && view == "v2" && asked == 4 && confirmed == 4 && near(depth, 10, 0.2) &&
                     near(x, (0.355 * 640 - 320) / 56, 0.4) && near(y, (0.325 * 640 - 320) / 56, 0.4) && near(width, 0.35 * 640 / 56, 0.6)) }' out/statue/parallax/subjects.txt ||
        { grep -v '^# input' out/statue/parallax/subjects.txt; fail "the face is not at its place"; }
}

a_puppet_is_not_taken_for_a_face()
{
    local photo=$data/kermit/photos/kermit003.jpg
    [ -e "$photo" ] || skip "there is no ../shared/data/kermit"
    wall "$photo" puppet
    grep -qx 'subjects 0' out/puppet/parallax/subjects.txt || { cat log; fail "a face was found"; }
}

for t in a_scene_without_faces_has_an_empty_list drawn_rectangles_become_subjects_in_order invalid_rectangles_are_errors_with_their_line \
    a_rectangle_without_depth_is_an_error missing_cascades_are_an_error the_list_is_remade_when_drawn_rectangles_are_added_or_removed \
    the_face_of_a_statue_is_found_at_its_place_in_space a_puppet_is_not_taken_for_a_face; do run "$t"; done
