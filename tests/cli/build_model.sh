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
    for f in model.txt plan.txt merged.txt plan.svg view.png; do [ -s "made/$f" ] || fail "no $f"; done
    for n in wall/south/in door/way/left window/sun/sill glass/sun/out floor/hall ceiling/hall; do grep -q "$n" made/model.txt || fail "no face $n"; done
    grep -q '^wall south normal 0 1 at 0 thickness 0.2' made/plan.txt || { cat made/plan.txt; fail "plan.txt"; }
    cp -r made first
    build 0 closed --script room.txt --threads 1
    diff -r first made || fail "another number of threads gives other bytes"
    ! grep -rqF "$PWD" made || fail "a product names a folder of this machine"
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
wall x foot in v00 1 2 30 40|no views are known
walls x y corner in v00 1 2 corner in v01 3 4|no views are known
wall x foot in v00 1 2 1 2|found the pixel 1 2 of v00 twice
join south north|they are parallel
door d on south from 3.5 0 to 4.5 2|is outside its wall south
door d on suoth from 3 0 to 3.5 2|did you mean south?
window w on south from 1.5 1 to 3 2|overlap
room r south north east|are parallel
close south|south is a wall
gable hall from south 2.6 to north 3 ridge 2.8|the ridge of hall would be at 2.8
skylight s on hall from 3 1 to 5 2|does not lie between the walls of room hall
window w on south at left 3.5 width 1 from 1 to 2|is outside its wall south
wall x parallel to south by 1 between west north|cannot end at wall north
resize way top 1|is outside its wall south
change hall ceiling -1|wanted a ceiling above the floor
change way top 2|way is an opening; wanted a wall, a box or a room
fill sun with glass|is filled with glass already
box b from 1 1 to 1 2|box b would be 0 x 1
END
    : >empty.txt
    build 1 'remodel-script 1' --script empty.txt
    printf 'remodel-script 1\n' >empty.txt
    build 1 'describes no solid' --script empty.txt
}

# an edit that changes nothing is a mistake, unless it is empty
an_edit_without_effect_is_refused()
{
    printf 'remodel-script 1\nset ceiling 3\n' >edit.txt
    build 1 'write "change ROOM ceiling Z"' --script room.txt --edit edit.txt
    grep -qF 'edit.txt:2: ' err.txt || { cat err.txt; fail "no line"; }
    printf 'remodel-script 1\nmove east by 0\n' >edit.txt
    build 1 'edit.txt:2: the statement changes nothing' --script room.txt --edit edit.txt
    printf 'remodel-script 1\n# nothing yet\n' >edit.txt
    build 0 'volume 12.55' --script room.txt --edit edit.txt
    printf 'remodel-script 1\nchange hall ceiling 3\n' >edit.txt
    build 0 'volume 14.03' --script room.txt --edit edit.txt
}

# walls under a gable of 0.3 a metre, 3.1 at the ridge: the integral over 4.4 x 3.4 less that over 4 x 3, 7.8392; two slabs of
# 2.992; less door and window, 0.88, and a skylight of 1 x 1 x 0.2; and panes of 0.068
gables_and_skylights_have_their_volume()
{
    { cat room.txt; echo 'gable hall from west 2.5 to east 2.5 ridge 3.1'; echo 'skylight light on hall from 1.5 1 to 2.5 2'; } >more.txt
    build 0 '3 bodies, volume 12.81;' --script more.txt
    grep -q '^gable hall ceiling ' made/plan.txt && grep -q '^skylight light on hall from 1.5 1 to 2.5 2 closed' made/plan.txt || { cat made/plan.txt; fail "plan.txt"; }
    for n in skylight/light/left glass/light/out; do grep -q "$n" made/model.txt || fail "no face $n"; done
}

# lamps, gloss, paint and objects are data beside the model, which they do not change
an_edit_says_what_changes_the_light()
{
    build 0 closed --script room.txt
    rm -rf base home; mv made base; mkdir -p home/edits home/meshes
    printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n' >home/meshes/a.obj
    printf 'remodel-script 1\n# none\n' >home/edits/plain.txt
    edited() { local code=$1 word=$2; shift 2; build "$code" "$word" --script room.txt --edit "$1" --scene home --base base/model.txt; }
    edited 0 closed home/edits/plain.txt
    [ "$(sed -n 1p made/texture.txt)" = 'remodel-texture 3' ] || { sed -n 1,3p made/texture.txt; fail "the version of texture.txt"; }
    [ "$(sed -n 1p made/objects.txt)" = 'remodel-objects 1' ] && ! grep -q '^object' made/objects.txt || { cat made/objects.txt; fail "objects.txt without objects"; }
    printf 'remodel-script 1\nobject plant meshes/a.obj at 1 1 0 matt 0.1 0.4 0.1\n' >home/objects.txt
    cat >home/edits/dark.txt <<'END'
remodel-script 1
lamp "over the table" off
lamp floor scale 2 2 1.5
paint wall/south/in from 0.2 0.5 to 0.8 1.5 0.8 0.1 0.1
material wall/south/in phong 0.05 40
object tent meshes/a.obj at 2 1 0 turn 90 scale 0.5 ward 0.5 0.5 0.5 0.1 0.2
END
    printf 'remodel-script 1\nbase dark\nlamp floor off\nremove object tent\n' >home/edits/darker.txt
    edited 0 'object tent: 4 triangles, from 1.5 1 0 to 2 1.5 0.5' home/edits/dark.txt
    for line in 'lamp "over the table" 0 0 0' 'lamp floor 2 2 1.5' 'gloss phong 0.050000000000000003 40'; do
        grep -qxF -- "$line" made/texture.txt || { grep '^lamp\|^gloss' made/texture.txt; fail "texture.txt has no line '$line'"; }
    done
    grep -q '^colour 0.800.* within 0.8*' made/texture.txt || fail "texture.txt has no painted place"
    [ "$(grep -c '^gloss' made/texture.txt)" = 1 ] || fail "gloss on other faces"
    grep -q '^object plant meshes/a.obj [0-9a-f]* 1 0 0 1 0 1 0 1 0 0 1 0 matt ' made/objects.txt && grep -q '^object tent .* ward 0.5 ' made/objects.txt || { cat made/objects.txt; fail "objects.txt"; }
    for f in texture.txt objects.txt; do "$B/bin/verify" --file made/$f || fail "$f is not whole"; done
    grep -v '^#' made/model.txt | diff -q - <(grep -v '^#' base/model.txt) >/dev/null || fail "the model has changed"
    mv made dark
    edited 0 closed home/edits/darker.txt
    grep -qx 'lamp floor 0 0 0' made/texture.txt && grep -q '^gloss' made/texture.txt || fail "the edit below counts for nothing"
    grep -q '^object plant' made/objects.txt && ! grep -q '^object tent' made/objects.txt || { cat made/objects.txt; fail "an object was not removed"; }
    rm -rf copied; cp -r home copied; mv made darker
    build 0 closed --script room.txt --edit copied/edits/darker.txt --scene copied --base base/model.txt
    diff -r darker made || fail "products depend on the scene's folder"
    # a changed mesh is another object; without its mesh there is none
    printf 'v 0 0 2\nf -1 1 2\n' >>home/meshes/a.obj
    edited 0 closed home/edits/dark.txt
    [ "$(grep '^object' made/objects.txt | cut -d' ' -f4)" != "$(grep '^object' dark/objects.txt | cut -d' ' -f4)" ] || fail "the hash is that of the mesh before"
    echo 'f 1 2 9' >>home/meshes/a.obj
    edited 1 'home/meshes/a.obj:11: found "9", wanted a vertex from 1 to 5' home/edits/dark.txt
    rm home/meshes/a.obj
    edited 1 'home/objects.txt:2: found no file home/meshes/a.obj, wanted the mesh of the object plant' home/edits/dark.txt
    echo 'lamp floor off' >>home/objects.txt
    edited 1 'home/objects.txt:3: found lamp, wanted object' home/edits/dark.txt
    rm home/objects.txt
    build 1 'home/edits/dark.txt:6: the mesh meshes/a.obj is in the scene' --script room.txt --edit home/edits/dark.txt --base base/model.txt
    build 2 -- '--scene is only for --edit' --script room.txt --scene home
}

# the loft's walls as scene.txt has them, by coordinates; each edit puts openings where the scene of its name has them
edits_of_the_loft_do_not_depend_on_views()
{
    cat >loft.txt <<'END'
remodel-script 1
set thickness 0.3
set ceiling 2.7
wall south from 8.65 0.15 to 0.15 0.15
wall west from 0.15 0.15 to 0.15 4.05
wall north from 0.15 4.05 to 8.65 4.05
wall east from 8.65 4.05 to 8.65 0.15
wall partition from 5.32 4.05 to 5.32 0.15 thickness 0.16
join south west north east south
extend partition start to north
extend partition end to south
room living south west north partition
room study south partition north east
passage doorway on partition from 1.5 0 to 2.45 2.1
window sunny on south from 1.4 0.75 to 3.4 2.25
window north-light on east from 1.5 0.95 to 2.4 2.15
END
    build 0 closed --script loft.txt
    mv made unedited
    local name
    for name in "$root"/scenes/loft/edits/*.txt; do
        # a box on a floor has no wall to be placed by
        [[ $name != */object-* ]] || continue
        ! grep -q ' in v[0-9]' "$name" || fail "$name names a view"
        build 0 closed --script loft.txt --things "$root/scenes/loft/things.txt" --edit "$name" --base unedited/model.txt
        mv made "$(basename "$name" .txt)"
    done
    # lines LINE WORD N...: the numbers of plan.txt's line that begins so are N..., to a millionth
    numbers()
    {
        local file=$1 line=$2; shift 2
        grep "^$line " "$file/plan.txt" | awk -v w="$*" '{ n = split(w, x, " "); k = 0
            for (i = 1; i <= NF; i++) if ($i ~ /^-?[0-9.]+(e-?[0-9]+)?$/ && k < n) { k++; if ($i - x[k] > 1e-6 || x[k] - $i > 1e-6) exit 1 }
            found = k == n } END { exit !found }' || { cat "$file/plan.txt"; fail "$file: $line is not $*"; }
    }
    numbers wide-door 'passage doorway' 1.2 0 2.65 2.1
    numbers big-window 'window sunny' 1 0.45 3.8 2.35
    numbers new-opening 'passage second' 3.2 0 4 2.1
    numbers new-opening 'passage doorway' 1.5 0 2.45 2.1
    numbers new-wall 'wall across' -1 0 -7.04 0.12 0.15 4.05 0 2.7
    ! grep -q '^window north-light' no-window/plan.txt || fail "the window is still there"
    ! grep -q '^wall partition\|^passage' no-partition/plan.txt || fail "the partition is still there"
}

# the floors are of different materials, also without a wall between the rooms
floors_of_two_rooms_stay_two_faces()
{
    local name
    for name in unedited no-partition wide-door; do
        for room in living study; do
            grep -q "^face [0-9]* floor/$room" "$name/model.txt" && grep -q "^face [0-9]* ceiling/$room " "$name/model.txt" ||
                { grep '^face' "$name/model.txt"; fail "$name: no floor/$room"; }
        done
        ! grep -q '^merged floor\|^merged ceiling' "$name/merged.txt" || { cat "$name/merged.txt"; fail "$name: a floor was merged"; }
    done
}

make_builds_models_and_overlays()
{
    photos set >/dev/null
    mkdir -p scenes/t/edits
    printf '[segment_depth]\nplanes = 32\npasses = 1\nrounds = 0\n' >scenes/t/scene.cfg
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
    # what changes no face draws no edge again: neither of the model nor of its edits
    overlays() { find out/t -path '*/overlay/*' -printf '%p %T@\n' | sort; }
    overlays >before
    printf '# a comment\n' >>scenes/t/model.txt
    printf 'colour wall/a/in 0.1 0.2 0.8\n' >>scenes/t/edits/far.txt
    cp -p out/t/remodel/far/model.txt far.txt
    m
    [ out/t/remodel/far/model.txt -nt far.txt ] && grep -q '^colour 0.1' out/t/remodel/far/texture.txt || fail "a colour is not in the edit"
    overlays | diff before - || fail "edges were drawn again although no face changed"
    # an edit that changes no face has copies
    printf 'remodel-script 1\ncolour wall/a/in 0.9 0.1 0.1\n' >scenes/t/edits/red.txt
    m
    diff -r out/t/model/overlay out/t/remodel/red/overlay || fail "edges of the same faces are drawn otherwise"
    ! diff -rq out/t/model/overlay out/t/remodel/far/overlay >/dev/null || fail "a wall that moved changes no photo"
    rm -r scenes/t/edits/red.txt out/t/remodel/red
    # meshes of objects, and the objects of all edits
    printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >scenes/t/a.obj
    printf 'remodel-script 1\nobject a a.obj at 0 0 0 matt 0.5 0.5 0.5\n' >scenes/t/objects.txt
    m
    grep -q '^object a a.obj' out/t/remodel/far/objects.txt || fail "objects.txt came, but nothing was made again"
    list >before
    m
    list | diff before - || fail "with objects, a second make made something again"
    cp out/t/remodel/far/objects.txt first.txt
    echo 'f 3 2 1' >>scenes/t/a.obj
    m
    ! diff -q first.txt out/t/remodel/far/objects.txt >/dev/null || fail "a mesh changed, but nothing was made again"
    rm scenes/t/a.obj
    ! make -s DEPS=manual PHOTOS=set/photos SFM=set/model SCENE=t model >log 2>&1 || fail "a mesh is missing"
    grep -q 'scenes/t/objects.txt:2: found no file scenes/t/a.obj' log || { cat log; fail "nothing names the mesh"; }
    rm scenes/t/objects.txt
    m
    ! grep -q '^object' out/t/remodel/far/objects.txt || fail "objects.txt went, but nothing was made again"
    # a rectangle on the wall in the photos
    { cat scenes/t/model.txt; echo "wall seen in $first 30 20 130 60"; } >script.txt
    "$B/bin/build_model" --script script.txt --axes out/t/model/axes.txt --views out/t/views --points out/t/points/points.ply --out made >out.txt 2>err.txt || { cat err.txt; fail "a rectangle"; }
    grep -q 'wall seen: [0-9]* points' err.txt || { cat err.txt; fail "nothing tells of its points"; }
    sed -i '$d' script.txt && echo "wall seen in ${first}x 30 20 130 60" >>script.txt
    ! "$B/bin/build_model" --script script.txt --axes out/t/model/axes.txt --views out/t/views --points out/t/points/points.ply --out made2 2>err.txt || fail "no such view"
    grep -q "script.txt:[0-9]*: found .*did you mean $first?" err.txt || { cat err.txt; fail "no guess"; }
}

every_line_of_a_log_names_its_edit()
{
    printf 'remodel-script 1\nremove way\nobject a a.obj at 1 1 0 matt 0.5 0.5 0.5\n' >no-way.txt
    mkdir -p things; printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >things/a.obj
    build 0 'build_model: model: 4 walls, 1 rooms, 2 openings' --script room.txt
    cp made/model.txt base.txt
    build 0 'build_model: no-way: object a: 1 triangle' --script room.txt --edit no-way.txt --base base.txt --scene things
    [ "$(grep -vc '^build_model: no-way: ' err.txt)" = 1 ] || { cat err.txt; fail "a line does not name the edit"; }
    tail -n1 err.txt | matches -E '^build_model: used [0-9.]+ s wall' || { cat err.txt; fail "the last line is not the program's"; }
}

for t in a_room_is_a_closed_solid an_edit_keeps_the_ids_of_its_base errors_name_file_and_line an_edit_without_effect_is_refused gables_and_skylights_have_their_volume an_edit_says_what_changes_the_light edits_of_the_loft_do_not_depend_on_views floors_of_two_rooms_stay_two_faces every_line_of_a_log_names_its_edit make_builds_models_and_overlays; do run "$t"; done
