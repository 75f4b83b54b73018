# build_model: models of scripts, errors with file and line, edits keep ids, make rebuilds only what changed
. tests/lib.sh
project model
cat >axes.txt <<'END'
remodel-axes 1
rotation 1 0 0 0
translation 0 0 0
scale 1 metres
ceiling 2.5
thickness 0.2
error tilt 0
error heading 0
error floor 0
error ceiling 0
error scale 0
END
cat >room.txt <<'END'
remodel-script 1
wall south from 4 0 to 0 0
wall west from 0 0 to 0 3
wall north from 0 3 to 4 3
wall east from 4 3 to 4 0
join south west north east south
room hall south west north east
door way on south from 1 0 to 2 2
window sun on north from 1 0.9 to 3 2.1
END

# build CODE WORD ARGUMENT...: runs build_model; checks its exit status and a word on standard error
build()
{
    local code=$1 word=$2 rc=0; shift 2
    rm -rf made
    "$B/bin/build_model" --axes axes.txt --out made "$@" >out.txt 2>err.txt </dev/null || rc=$?
    [ "$rc" = "$code" ] || { cat err.txt; fail "$*: exit $rc, wanted $code"; }
    grep -qF -- "$word" err.txt || { cat err.txt; fail "$*: nothing says '$word'"; }
    [ "$code" = 0 ] || grep -q 'build_model: error: .*[.?]$' err.txt || { cat err.txt; fail "$*: no sentence"; }
    [ "$code" = 0 ] || [ ! -e made/model.txt ] || fail "$*: a model was left"
}

a_room_is_a_closed_solid()
{
    build 0 'closed, without self-intersection' --script room.txt
    # 4.4 x 3.4 x 2.9 less the room, door and window, and a pane of 2 cm
    grep -q '2 bodies, volume 12.55' err.txt || { cat err.txt; fail "the volume"; }
    for f in model.txt model.obj plan.txt merged.txt plan.svg view.png; do [ -s "made/$f" ] || fail "no $f"; done
    for n in wall/south/in door/way/left window/sun/sill glass/sun/out floor/hall ceiling/hall; do grep -q "$n" made/model.txt || fail "no face $n"; done
    grep -q '^wall south normal 0 1 at 0 thickness 0.2' made/plan.txt || { cat made/plan.txt; fail "plan.txt"; }
    cp -r made first
    build 0 closed --script room.txt --threads 1
    diff -r first made || fail "another number of threads gives other bytes"
    ! grep -rqF "$PWD" made || fail "a product names a folder of this machine"
}

# as another program reads it: triangles, each edge of an object once in each direction, a group per name, volumes above 0
another_program_can_read_the_obj()
{
    { cat room.txt; echo 'box b from 1 1 to 2 2 top 1 turn 30'; echo 'window w on west from 0 0 to 3 2.5'; echo 'slope hall from south 2.6 to north 3'; } >more.txt
    build 0 closed --script more.txt
    awk 'BEGIN { n = normals = 0 }
        $1 == "v" { for (k = 0; k < 3; k++) v[n, k] = $(k + 2); n++ }
        $1 == "vn" { for (k = 0; k < 3; k++) m[normals, k] = $(k + 2); normals++ }
        $1 == "o" { o = $2; objects++ }
        $1 == "g" { if (NF != 2 || seen[o, $2]++) exit bad = 1; groups++ }
        $1 == "f" {
            if (NF != 4 || !groups) exit bad = 2
            for (k = 0; k < 3; k++) { split($(k + 2), p, "/"); c[k] = p[1] - 1; if (c[k] < 0 || c[k] >= n || p[3] < 1 || p[3] > normals) exit bad = 3 }
            for (k = 0; k < 3; k++) if (edge[o, c[k], c[(k + 1) % 3]]++) exit bad = 4
            s = 0
            for (k = 0; k < 3; k++) {
                i = (k + 1) % 3; j = (k + 2) % 3
                x = (v[c[1], i] - v[c[0], i]) * (v[c[2], j] - v[c[0], j]) - (v[c[1], j] - v[c[0], j]) * (v[c[2], i] - v[c[0], i])
                s += x * m[p[3] - 1, k]; volume[o] += x * v[c[0], k] / 6
            }
            if (s <= 0) exit bad = 5
        }
        END {
            for (e in edge) { split(e, p, SUBSEP); if (!((p[1], p[3], p[2]) in edge)) bad = 6 }
            for (o in volume) if (volume[o] <= 0) bad = 7
            exit bad ? bad : objects != 3
        }' made/model.obj || fail "model.obj: fault $?"
}

an_edit_keeps_the_ids_of_its_base()
{
    build 0 closed --script room.txt
    mv made base
    printf 'remodel-script 1\nremove way\nmove east by 0.5\nwindow more on east from 1 1 to 2 2\n' >edit.txt
    build 0 closed --script room.txt --edit edit.txt --base base/model.txt
    awk '$1 != "face" { next } FNR == NR { id[$3] = $2; if ($2 > most) most = $2; next }
        $3 in id { same++; if (id[$3] != $2) bad++; next } $2 <= most { bad++ } END { exit !(same > 10 && !bad) }' base/model.txt made/model.txt ||
        { grep '^face' base/model.txt made/model.txt; fail "ids"; }
    grep -q 'window/more/sill' made/model.txt && ! grep -q door/way made/model.txt || fail "the edit's faces"
}

errors_name_file_and_line()
{
    build 2 --script
    build 1 nowhere.txt --script nowhere.txt
    build 2 -- '--base is only for --edit' --script room.txt --base x.txt
    while IFS='|' read -r line words; do
        { cat room.txt; echo "$line"; } >bad.txt
        build 1 "$words" --script bad.txt
        grep -q 'bad.txt:[0-9]*: ' err.txt || { cat err.txt; fail "no line"; }
        { echo 'remodel-script 1'; echo "$line"; } >edit.txt
        build 1 "$words" --script room.txt --edit edit.txt
        grep -qF 'edit.txt:2: ' err.txt || { cat err.txt; fail "no line of the edit"; }
    done <<'END'
wal x from 0 0 to 1 0|did you mean wall?
wall south from 0 5 to 1 5|the name south is used already
wall x from 0 0 to 1 1|is not along an axis
wall x in v00 1 2 30 40|no views are known
join south north|they are parallel
door d on south from 3.5 0 to 4.5 2|is outside its wall south
door d on suoth from 3 0 to 3.5 2|did you mean south?
window w on south from 1.5 1 to 3 2|overlap
room r south north east|are parallel
close south|south is a wall
box b from 1 1 to 1 2|box b would be 0 x 1
END
    : >empty.txt
    build 1 'remodel-script 1' --script empty.txt
    printf 'remodel-script 1\n' >empty.txt
    build 1 'describes no solid' --script empty.txt
}

make_builds_models_and_overlays()
{
    photos set --views 6 --size 320x240 >/dev/null
    mkdir -p scenes/t/edits
    printf '[segment_depth]\nplanes = 48\n' >scenes/t/scene.cfg
    { echo 'remodel-script 1'; echo 'set thickness 0.2'; echo 'set ceiling 4'; echo 'wall a from -2 1 to 2 1'; echo 'box b from -0.5 -0.5 to 0.5 0.5 top 1'; } >scenes/t/model.txt
    printf 'remodel-script 1\nmove a by 1\n' >scenes/t/edits/far.txt
    m() { make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=t model >log 2>&1 || { cat log; fail "make model"; }; }
    m
    local first
    first=$(sed -n 's/^VIEWS := \([^ ]*\).*/\1/p' out/t/views/views.mk)
    for f in model/model.txt "model/overlay/$first.jpg" remodel/far/model.txt "remodel/far/overlay/$first.jpg"; do [ -s "out/t/$f" ] || fail "no $f"; done
    list() { find out/t/model out/t/remodel -type f -printf '%p %T@\n' | sort; }
    list >before
    m
    list | diff before - || fail "a second make made something again"
    printf 'move a by 0.5\n' >>scenes/t/edits/far.txt
    m
    list >after
    diff before after >changes || true
    ! grep -q 'out/t/model/' changes || { cat changes; fail "an edit redid the model"; }
    grep -q 'out/t/remodel/far/model.txt' changes || fail "a changed edit was not made again"
    # a rectangle on the wall in the photos
    { cat scenes/t/model.txt; echo "wall seen in $first 60 40 260 120"; } >script.txt
    "$B/bin/build_model" --script script.txt --axes out/t/model/axes.txt --views out/t/views --points out/t/points/points.ply --out made >out.txt 2>err.txt || { cat err.txt; fail "a rectangle"; }
    grep -q 'wall seen: [0-9]* points' err.txt || { cat err.txt; fail "nothing tells of its points"; }
    sed -i '$d' script.txt && echo "wall seen in ${first}x 60 40 260 120" >>script.txt
    ! "$B/bin/build_model" --script script.txt --axes out/t/model/axes.txt --views out/t/views --points out/t/points/points.ply --out made2 2>err.txt || fail "no such view"
    grep -q "script.txt:[0-9]*: found .*did you mean $first?" err.txt || { cat err.txt; fail "no guess"; }
}

for t in a_room_is_a_closed_solid another_program_can_read_the_obj an_edit_keeps_the_ids_of_its_base errors_name_file_and_line make_builds_models_and_overlays; do run "$t"; done
