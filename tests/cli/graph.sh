# the graph of products, as print_graph prints it: which products need which, and what a change makes stale. No program of a
# stage runs: products are empty files.
. tests/lib.sh
mkdir -p "$scratch/project/scenes"
cd "$scratch/project" || exit 1
for f in Makefile stages common configs; do ln -s "$root/$f" .; done
# checksums of programs of its own: they get old times here, which would make every run of another script look at all programs
mkdir -p "out/build/$FLAVOR"
ln -s "$root/$B/bin" "out/build/$FLAVOR/bin"
cp -r "$root/$B/code" "out/build/$FLAVOR/code"
stages=$(cd "$root" && make -s --no-print-directory list-stages)

# given NAME=VALUE...: the settings of the calls that follow
declare -A settings=([PRODUCTS]=parallax [STAGES]="$stages" [FILMS]=establishing_dolly [PHOTOS]=photos)
given() { local s; for s; do settings[${s%%=*}]=${s#*=}; done; }
# graph WHAT [GOAL]: calls print_graph for the scene t
graph()
{
    local s environment=()
    for s in "${!settings[@]}"; do environment+=("REMODEL_$s=${settings[$s]}"); done
    env "${environment[@]}" "$root/$B/bin/print_graph" "$1" scenes/t out/t out/t "out/build/$FLAVOR/bin" "${@:2}"
}
# scene PHOTO...: the scene t, whose SfM has placed these photos; PHOTO@k is a view
scene()
{
    rm -rf out/t scenes/t
    mkdir -p out/t/{photos,views,slice,stamp} scenes/t
    echo "PHOTO_IDS := $(printf '%s\n' "${@%@*}" | sort -u | tr '\n' ' ')" >out/t/photos/photos.mk
    echo "VIEWS := $*" >out/t/views/views.mk
    echo 'rounds = 1' >out/t/slice/segment_depth.cfg
    for s in $stages; do touch "out/t/slice/$s.cfg"; done
    touch out/t/photos/list.txt out/t/stamp/{photo_sizes,sfm_source,truth,rendered,cameras}.txt out/t/stamp/remodel-page.txt
    for p in "${@%@*}"; do touch "out/t/photos/$p.txt"; done
}
# targets_of_graph: all files that a rule makes
targets_of_graph() { sed -nE 's/^(out[^:&]*[^:& ])( &)?:.*/\1/p' out/t/graph/*.mk | tr ' ' '\n' | LC_ALL=C sort -u; }
# made: every product exists, and none is stale
made()
{
    local i
    for i in 1 2 3; do # later rules are known when earlier products list their pieces
        graph write
        targets_of_graph | while read -r f; do [ -e "$f" ] || { mkdir -p "${f%/*}"; touch -d 2020-01-01 "$f"; }; done
        [ -s out/t/parallax/establishing_dolly/frames.mk ] || echo 'FRAMES := 0001 0002 0003' >out/t/parallax/establishing_dolly/frames.mk
    done
    find out/t/ "out/build/$FLAVOR/code/" scenes/t -newermt 2020-01-02 -exec touch -h -d 2019-01-01 {} + 2>/dev/null || true
    touch -d 2020-01-01 $(targets_of_graph)
    graph write
}
# stale [GOAL]: the commands that would run, as "STAGE ITEM", sorted
stale()
{
    graph write
    make -s --no-print-directory PHASE=graph O=out/t -n -s "${1-report}" | sed -nE 's/.*run_stage\.sh [a-z]+ ([^ ]+ [^ ]+) .*/\1/p' | LC_ALL=C sort
}
# wants EXPECTED [GOAL]
wants() { stale "${2-report}" >found; diff <(printf '%s' "$1" | sed '/^$/d') found || fail "other commands would run"; }
# rule_of PRODUCT: its line
rule_of() { grep -hE "^([^:]* )?$1( [^:]*)?:" out/t/graph/*.mk; }
needs() { rule_of "$1" | sed 's/|.*//' | matches -F " $2"; }

nothing_is_stale_when_all_is_made()
{
    scene a b c
    made
    wants ''
}

every_goal_is_known_before_the_views_are()
{
    scene a b c
    mkdir -p scenes/t/edits
    printf 'remodel-script 1\n' | tee scenes/t/model.txt scenes/t/edits/one.txt >/dev/null
    rm -r out/t/views out/t/slice/segment_depth.cfg
    touch out/t/slice/segment_depth.cfg
    local goal
    for goal in report depth points axes suggest model ids vdta vita outdoors exports lights irradiance path frames video \
        pan_scan subjects remodel tour relight relit-tour evaluate; do
        graph write
        make -s --no-print-directory PHASE=graph O=out/t -n -s "$goal" >log 2>&1 || { cat log; fail "make -n $goal"; }
    done
}

a_changed_photo_redoes_its_view_and_the_frame_that_all_depth_reads()
{
    mkdir -p given
    given SFM=given # otherwise the cameras are found again
    scene a b c
    for v in a b c; do mkdir -p out/t/depth/round0; done
    echo 'out/t/depth/round0/b.exr: out/t/views/b.exr out/t/views/a.exr' >out/t/depth/round0/b.d
    made
    touch out/t/photos/a.txt
    wants 'find_frame all
find_lines a
rectify a
segment_depth a
segment_depth b
segment_depth c
' depth-round0
    settings[SFM]=
}

a_changed_photo_redoes_its_features_and_the_cameras()
{
    scene a b c
    made
    touch out/t/photos/a.txt
    wants 'choose_pairs all
extract_features a
match_photos a
match_photos b
match_photos c
sfm all
sfm_import all
' sfm
}

a_neighbour_that_is_a_view_no_more_redoes_the_depth_that_read_it()
{
    scene a b c
    made
    echo 'out/t/depth/round0/b.exr: out/t/views/b.exr out/t/views/gone.exr' >out/t/depth/round0/b.d
    wants 'segment_depth b
' depth-round0
}

a_parameter_redoes_its_stage_and_what_follows()
{
    scene a b c
    made
    touch out/t/slice/encode_video.cfg
    wants 'encode_video establishing_dolly
encode_video establishing_dolly-pan_scan
report page
'
    touch out/t/slice/rectify.cfg
    stale views >found
    [ "$(wc -l <found)" = 3 ] || fail "a parameter of rectify does not redo all views"
}

a_deleted_product_is_remade_with_what_follows()
{
    # deleted PRODUCT EXPECTED
    deleted()
    {
        scene a b c
        made
        rm "out/t/$1"
        stale >found
        diff <(printf '%s\n' "${@:2}") found || fail "after $1 was deleted other commands would run"
    }
    local film=establishing_dolly flat='encode_video establishing_dolly-pan_scan'
    deleted parallax/$film/frames/0003.exr "encode_video $film" "render_views $film-0001" 'report page'
    deleted parallax/$film/path.txt "encode_video $film" "$flat" "pan_scan $film-0001" "plan_path $film" "render_views $film-0001" 'report page'
    scene a b c
    made
    rm out/t/views/b.exr
    stale >found
    # `make -n` of GNU Make 4.3 does not see through rules of several targets, such as a depth map's: what follows is seen then
    for c in 'rectify b' 'segment_depth b' 'report page'; do
        grep -qx "$c" found || fail "after a view was deleted, '$c' would not run"
    done
    ! grep -qx 'rectify a' found && ! grep -qx 'sfm_import all' found || fail "after a view was deleted, too much would run"
}

a_changed_program_redoes_its_products()
{
    scene a b c
    made
    rule_of out/t/sfm/models.txt | matches "out/build/$FLAVOR/code/sfm" || fail "SfM does not depend on its program"
    rule_of out/t/views/a.exr | matches "out/build/$FLAVOR/code/rectify" || fail "a view does not depend on its program"
}

a_given_model_with_points_needs_no_matches()
{
    scene a b
    mkdir -p given
    given SFM=given
    echo few >out/t/stamp/sfm_points.txt
    graph write
    rule_of out/t/sfm/models.txt | matches stamp/set/matches || fail "points cannot be triangulated without matches"
    echo enough >out/t/stamp/sfm_points.txt
    graph write
    ! rule_of out/t/sfm/models.txt | matches stamp/set/matches || fail "photos are matched though the points suffice"
    [ ! -e out/t/graph/match_photos.mk ] || ! grep -q 'run_stage.*match_photos' out/t/graph/match_photos.mk || fail "matches are planned though the points suffice"
    for goal in features pairs matches; do wants '' $goal; done
    settings[SFM]=
}

depth_that_a_model_names_is_given_unless_depth_is()
{
    scene a b
    mkdir -p out/t/sfm_depth
    graph write
    cat out/t/graph/*.mk | matches -F -- '--given out/t/sfm_depth' || { grep -h given out/t/graph/*.mk; fail "the model's depth is not given"; }
    mkdir -p own
    given DEPTH=own
    graph write
    ! cat out/t/graph/*.mk | matches -F -- '--given out/t/sfm_depth' || fail "the model's depth replaces DEPTH"
    settings[DEPTH]=
}

a_photo_is_read_once_for_its_views()
{
    scene a@0 a@1 b
    graph write
    rule_of out/t/views/a@0.exr | matches -E '^out/t/views/a@0.exr out/t/views/a@1.exr &:' || fail "the views of a photo are not made together"
}

frames_come_in_chunks_and_wait_for_all_depth()
{
    scene a b
    given FRAMES_PER_JOB=2
    made
    [ "$(grep -c 'run_stage.sh quiet render_views' out/t/graph/render_views.mk)" = 2 ] || fail "three frames are not two chunks of two"
    touch out/t/depth/b.txt
    wants 'plan_path establishing_dolly
render_views establishing_dolly-0001
render_views establishing_dolly-0003
sample_validity establishing_dolly
' frames
}

what_is_held_out_is_rectified_and_not_matched()
{
    scene a b c
    given HOLDOUT_VIEWS=c
    mkdir -p out/t/holdout/views
    echo 'VIEWS := a b' >out/t/views/views.mk
    echo 'VIEWS := c' >out/t/holdout/views/views.mk
    graph write
    rule_of out/t/holdout/views/c.exr | matches rectify || true
    grep -q 'heldout-c' out/t/graph/rectify.mk || fail "a held-out view is not rectified"
    ! grep -q 'depth/c.exr' out/t/graph/segment_depth.mk || fail "a held-out view is matched"
    needs out/t/metrics.tsv out/t/holdout/frames/c.exr || fail "metrics do not need the frame of the held-out view"
}

photos_in_other_light_are_placed_and_held_out()
{
    scene a b c
    printf 'remodel-script 1\n' >scenes/t/model.txt
    printf 'remodel-states 1\nstate off lamps off\nphoto c in off\nphoto "x;y" in off\n' >scenes/t/states.txt
    mkdir -p out/t/holdout/views
    echo 'VIEWS := a b' >out/t/views/views.mk
    echo 'VIEWS := c' >out/t/holdout/views/views.mk
    graph write
    grep -qF -- "--holdout-views 'c'" out/t/graph/sfm_import.mk || { cat out/t/graph/sfm_import.mk; fail "the photo is not held out"; }
    grep -q -- "--held-views out/t/holdout/views" out/t/graph/light_levels.mk || { cat out/t/graph/light_levels.mk; fail "light levels do not look at it"; }
    ! grep -q 'heldout-c' out/t/graph/render_views.mk && ! needs out/t/metrics.tsv out/t/holdout/frames/c.exr || fail "a frame is drawn to compare it with"
    ! grep -q 'depth/c.exr' out/t/graph/segment_depth.mk || fail "it is matched"
    rm scenes/t/states.txt
    graph write
    ! grep -q -- '--holdout-views' out/t/graph/sfm_import.mk || fail "it is held out without states.txt"
}

a_kind_of_film_that_is_named_twice_is_made_once()
{
    scene a b c
    mkdir -p out/t/parallax/establishing_dolly
    echo 'FRAMES := 0001 0002' >out/t/parallax/establishing_dolly/frames.mk
    given FILM="pq hlg pq" EYES="vr180 vr180"
    graph write
    targets=$(sed -nE 's/^(out[^:]*video[^:]*):.*/\1/p' out/t/graph/encode_video.mk)
    [ "$(wc -l <<<"$targets")" = "$(sort -u <<<"$targets" | wc -l)" ] || { echo "$targets"; fail "a rule is there twice"; }
    grep -q 'video-vr180-hlg.mp4' <<<"$targets" || { echo "$targets"; fail "a kind is missing"; }
    ! grep -q 'establishing_dolly/left' out/t/graph/plan_eyes.mk || fail "flat eyes are planned, too"
}

an_edit_needs_the_scripts_and_meshes_that_it_stands_on()
{
    scene a b
    mkdir -p scenes/t/edits
    printf 'remodel-script 1\n' | tee scenes/t/model.txt scenes/t/edits/low.txt >/dev/null
    printf 'remodel-script 1\nbase low\nobject sofa sofa.obj at 1 2 0 matt 0.5 0.4 0.3\n' >scenes/t/edits/high.txt
    touch scenes/t/sofa.obj
    graph write
    local edited=out/t/remodel/high/model.txt
    needs $edited scenes/t/edits/high.txt && needs $edited scenes/t/edits/low.txt || fail "the edit does not need its base"
    needs $edited scenes/t/sofa.obj || fail "the edit does not need its mesh"
    ! needs $edited out/t/points/points.ply || fail "a script that places nothing in photographs needs points"
    printf 'remodel-script 1\nwall south in a 10 20 90 80\n' >scenes/t/model.txt
    graph write
    needs $edited out/t/points/points.ply || fail "a script that places a wall in a photograph needs no points"
    rm scenes/t/sofa.obj
    graph write
    needs $edited FORCE || fail "a missing mesh is not for the stage to report"
}

# of any name, and between any blanks: grep takes `[^ \t]` for neither a blank, a backslash nor a t
a_rectangle_on_a_wall_of_any_name_asks_for_points()
{
    scene a b
    mkdir -p scenes/t/edits
    local wall
    for wall in north south t tt west_tt start-0; do
        printf 'remodel-script 1\nwall %s in a 10 20 90 80\n' $wall >scenes/t/model.txt
        graph write
        needs out/t/model/model.txt out/t/points/points.ply || fail "a rectangle on the wall $wall is not seen"
    done
    printf 'remodel-script 1\n\twall\tnorth\tin\ta\t10\t20\t90\t80\n' >scenes/t/model.txt
    graph write
    needs out/t/model/model.txt out/t/points/points.ply || fail "a rectangle between tabs is not seen"
    printf 'remodel-script 1\nwall north from 0 0 to 4 0\n' >scenes/t/model.txt
    printf 'remodel-script 1\ndoor front on north in a 10 20 90 80\n' >scenes/t/edits/cut.txt
    graph write
    ! grep -q -- '--points' out/t/graph/build_model.mk || fail "a door in a photograph, which reads no points, asks for them"
    printf 'remodel-script 1\nwall north from 0 0 to 4 0\nadjust north in a 10 20 90 80\n' >scenes/t/model.txt
    graph write
    needs out/t/model/model.txt out/t/points/points.ply || fail "adjust north in a photograph is not seen"
}

given_cameras_see_the_unedited_model_too()
{
    scene a b
    mkdir -p scenes/t/edits
    printf 'remodel-script 1\n' | tee scenes/t/model.txt scenes/t/edits/one.txt scenes/t/edits/two.txt >/dev/null
    given CAMERAS=cams EDIT=one
    graph write
    local goal; goal=$(grep -h '^remodel-cameras:' out/t/graph/render_model.mk | tr '\n' ' ')
    for m in model remodel/one; do
        [[ $goal == *" out/t/$m/cameras/pictures.txt"* ]] || fail "EDIT=one: no pictures of $m from given cameras: $goal"
    done
    [[ $goal != *remodel/two* ]] || fail "EDIT=one draws the edit two"
    ! grep -q 'out/t/model/tour' out/t/graph/render_model.mk || fail "EDIT=one films the unedited rooms"
}

pictures_need_the_exposure_and_not_all_views()
{
    scene a b
    mkdir -p scenes/t/edits
    printf 'remodel-script 1\n' | tee scenes/t/model.txt scenes/t/edits/one.txt >/dev/null
    touch out/t/exposure.txt
    given PRODUCTS=remodel
    made
    needs out/t/remodel/one/pictures/a.txt out/t/exposure.txt || fail "a picture does not need the exposure"
    ! needs out/t/remodel/one/pictures/a.txt out/t/stamp/set/views || fail "a picture needs all views"
    needs out/t/stamp/exposure.txt out/t/stamp/set/views || fail "the exposure does not need all views"
    touch out/t/exposure.txt
    stale remodel >found
    grep -qx 'render_model one-a' found && ! grep -q '^choose_exposure' found || { cat found; fail "a new exposure does not redo a picture"; }
    graph steps remodel | grep -A9 ' exposure$' | matches ' remodel$' || { graph steps remodel; fail "the exposure does not come before the pictures"; }
}

an_edit_that_went_changes_what_edits_reveal()
{
    scene a b
    mkdir -p scenes/t/edits
    printf 'remodel-script 1\n' | tee scenes/t/model.txt scenes/t/edits/one.txt scenes/t/edits/two.txt >/dev/null
    made
    wants '' ids
    rm scenes/t/edits/two.txt
    wants 'trace_ids reveal-a
trace_ids reveal-b
' ids-reveal
}

steps_come_in_order()
{
    scene a b c
    [ "$(graph steps depth | cut -d' ' -f3 | tr '\n' ' ')" = 'hdr features pairs matches sfm views lines frame depth ' ] || { graph steps depth; fail "other steps for depth"; }
    given PRODUCTS='model textures'
    graph steps report >steps
    for s in model ids vdta vita textures report; do
        grep -q " $s\$" steps || fail "the step $s is missing"
    done
    grep -qx 'segment_depth farm depth' steps || fail "depth is not farmed"
}

pieces_of_work_name_their_products()
{
    scene a b
    graph write
    grep -qE "^segment_depth a out/t/depth/round0/a.d	out/t/depth/round0/a.exr out/t/depth/round0/a.txt out/t/depth/round0/a.round\$" out/t/graph/segment_depth.pieces ||
        { cat out/t/graph/segment_depth.pieces; fail "no piece of work for the depth of a"; }
    make -s --no-print-directory PHASE=graph O=out/t -n -s depth-round0 | common/run/plan_lines.sh out/t/graph >plan
    grep -qE '^out/t/depth/round0/a.exr out/t/depth/round0/a.txt out/t/depth/round0/a.round	common/run/run_stage.sh quiet segment_depth a out/t ' plan ||
        { cat plan; fail "no line of a plan for the depth of a"; }
}

a_graph_that_is_the_same_is_not_rewritten()
{
    scene a b
    made
    stat -c '%n %y' out/t/graph/* >before
    graph write
    stat -c '%n %y' out/t/graph/* | diff before - || fail "a file of the graph was rewritten"
}

wrong_settings_are_refused()
{
    scene a b
    # refused SETTING WORDS
    refused()
    {
        local rc=0
        (given "$1"; graph check) >log 2>&1 || rc=$?
        [ "$rc" = 2 ] && grep -qF "$2" log || { cat log; fail "$1: exit $rc, wanted 2 and '$2'"; }
    }
    refused HOLDOUT=x 'HOLDOUT=x: wanted a number'
    refused SPLIT=3by2 'SPLIT=3by2: wanted COLUMNSxROWS'
    refused SPLIT=1x1 'leave SPLIT out'
    refused MORPH=a 'wanted the ids of two photos'
    refused 'MORPH=a a' 'found one twice'
    refused 'EFFECT=dolly$' 'effects are named with letters'
    refused PRODUCTS=films 'wanted one or more of: model textures parallax remodel tour relight'
    [ ! -e out/t/graph ] || fail "a check wrote the graph"
}

for t in nothing_is_stale_when_all_is_made every_goal_is_known_before_the_views_are \
    a_deleted_product_is_remade_with_what_follows a_changed_photo_redoes_its_view_and_the_frame_that_all_depth_reads \
    a_changed_photo_redoes_its_features_and_the_cameras a_neighbour_that_is_a_view_no_more_redoes_the_depth_that_read_it a_parameter_redoes_its_stage_and_what_follows \
    a_changed_program_redoes_its_products a_given_model_with_points_needs_no_matches depth_that_a_model_names_is_given_unless_depth_is a_photo_is_read_once_for_its_views frames_come_in_chunks_and_wait_for_all_depth \
    what_is_held_out_is_rectified_and_not_matched photos_in_other_light_are_placed_and_held_out a_kind_of_film_that_is_named_twice_is_made_once an_edit_needs_the_scripts_and_meshes_that_it_stands_on \
    a_rectangle_on_a_wall_of_any_name_asks_for_points given_cameras_see_the_unedited_model_too pictures_need_the_exposure_and_not_all_views \
    an_edit_that_went_changes_what_edits_reveal steps_come_in_order pieces_of_work_name_their_products \
    a_graph_that_is_the_same_is_not_rewritten wrong_settings_are_refused; do run "$t"; done
