# choose_views: the views of films of a made room; bad arguments
. tests/lib.sh
B=$root/$B
cd "$scratch" || exit 1

# room: the folder room/ has three views each that look north, east, south and west; to the south there is furniture before
# a wall, to the east a wall with posters and a chair, elsewhere nothing
room()
{
    mkdir -p room
    awk -v PI=3.14159265358979 '
        function track(i, x, y, z,    k, v, s, c, u, w) {
            line = ""
            for (v = 0; v < 12; v++) {
                s = sin(int(v / 3) * PI / 2); c = cos(int(v / 3) * PI / 2); k = v % 3 - 1
                u = c * x - s * z - k; w = s * x + c * z
                if (w > 0.1 && u * u < w * w && y * y < w * w) { line = line " " v + 1 " " n[v]; obs[v] = obs[v] " 50 50 " i; n[v]++ }
            }
            if (line != "") print i, x, y, z, 9, 9, 9, 0.5 line >"room/points3D.txt"
        }
        BEGIN {
            for (v = 0; v < 12; v++) n[v] = 0
            for (d = 1; d <= 2; d++)
                for (i = 0; i < 64; i++) {
                    z = d == 1 ? (i % 8 < 2 ? 3 : 4) : (i % 8 < 4 ? 2 : 4)
                    x = (i % 8 - 3.5) / 4 * z; y = (int(i / 8) - 3.5) / 4 * z; s = sin(d * PI / 2); c = cos(d * PI / 2)
                    track(++points, c * x + s * z, y, -s * x + c * z)
                }
            print "1 PINHOLE 100 100 50 50 50 50" >"room/cameras.txt"
            for (v = 0; v < 12; v++) {
                h = int(v / 3) * PI / 4; k = v % 3 - 1
                printf "%d %.17g 0 %.17g 0 %d 0 0 1 %s%d.exr\n%s\n", v + 1, cos(h), -sin(h), -k, substr("nesw", int(v / 3) + 1, 1), v % 3 + 1, obs[v] >"room/images.txt"
            }
        }'
    { echo remodel-lenses 1; for v in {e,n,s,w}{1,2,3}; do echo "$v $v PINHOLE 100 100 50 50 50 50 turn 1 0 0 0"; done; } >room/lenses.txt
}

# choose CODE WORD ARGUMENT...
choose()
{
    local code=$1 word=$2 rc=0; shift 2
    rm -f made.txt
    "$B/bin/choose_views" --views "${views:-room}" --out made.txt "$@" >out.txt 2>err.txt </dev/null || rc=$?
    [ "$rc" = "$code" ] || { cat err.txt; fail "$*: exit $rc, wanted $code"; }
    grep -qF -- "$word" err.txt || { cat err.txt; fail "$*: nothing says '$word'"; }
    [ "$code" = 0 ] || { grep -q 'choose_views: error: .*[.?]$' err.txt && [ ! -e made.txt ]; } || { cat err.txt; fail "$*: no sentence, or a file was left"; }
}
made() { sed -n 's/^view //p; /^all$/p' made.txt | tr '\n' ' '; }
# chose NAMES: these views were chosen
chose() { [ "$(made)" = "$1 " ] || { cat err.txt made.txt; fail "chose $(made), wanted $1"; }; }

a_room_gets_the_cluster_with_the_most_depth()
{
    choose 0 'the 12 views look all round' --threads 1
    chose 's1 s2 s3'
    grep -q 'films use 3 views, .* as s[123] ' err.txt && grep -q 's2 is in their middle' err.txt || { cat err.txt; fail "the log does not say what was chosen"; }
    ! grep -qF "$PWD" made.txt || fail "the file names a folder of this machine"
    cp made.txt one.txt
    choose 0 'look all round' --threads 2
    cmp one.txt made.txt
}

a_view_or_all_can_be_asked_for()
{
    choose 0 'as e1 ' --set around=e1; chose 'e1 e2 e3'
    choose 0 '' --set around=all; chose all
    choose 0 '' --set min_agreement=0; chose all
    choose 0 'no cluster of them' --set around=n1; chose all
    choose 2 'around = "e9": wanted auto, all or a view'"'"'s name as in views/images.txt; did you mean e1?' --set around=e9
}

the_cluster_sees_the_subjects()
{
    echo 'subject e2 40 40 60 60' >drawn.txt
    choose 0 'look all round' --subjects drawn.txt; chose 'e1 e2 e3'
    grep -q '^# input subjects.txt' made.txt || fail "the rectangles are not among the inputs"
    echo 'subject s1 40 40 60 60' >>drawn.txt
    choose 0 'no cluster of them contains those with the subjects' --subjects drawn.txt; chose all
    echo 'subject q1 40 40 60 60' >drawn.txt
    choose 1 'drawn.txt:1: ' --subjects drawn.txt
    # where all views are used, the rectangles do not matter
    choose 0 '' --subjects drawn.txt --set around=all; chose all
    ! grep -q subjects made.txt || fail "rectangles that are not used are among the inputs"
}

a_folder_without_cameras_is_an_error()
{
    mkdir -p none
    views=none choose 1 none/cameras.txt
}

room
for t in a_room_gets_the_cluster_with_the_most_depth a_view_or_all_can_be_asked_for the_cluster_sees_the_subjects a_folder_without_cameras_is_an_error; do run "$t"; done
