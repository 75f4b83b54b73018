# the command line of every stage, and make's errors for wrong arguments
. tests/lib.sh

stages=$(cd stages && echo */ | tr -d /)

# expect CODE WORD COMMAND...: the command exits with CODE, and its standard error has WORD
expect()
{
    local code=$1 word=$2 rc=0; shift 2
    "$@" >"$scratch/out" 2>"$scratch/err" </dev/null || rc=$?
    [ "$rc" = "$code" ] || { cat "$scratch/err"; fail "$*: exit $rc, wanted $code"; }
    grep -qF -- "$word" "$scratch/err" || [ -z "$word" ] || { cat "$scratch/err"; fail "$*: the message does not have '$word'"; }
}

help_version_and_config_of_every_stage()
{
    for s in $stages; do
        for o in --help --version --print-config; do
            "$B/bin/$s" "$o" >"$scratch/out" 2>"$scratch/err" || fail "$s $o"
            [ -s "$scratch/out" ] && [ ! -s "$scratch/err" ] || fail "$s $o: wanted all text on standard output"
        done
        grep -qx "\[$s\]" "$scratch/out" || fail "$s --print-config does not begin with its section"
    done
}

wrong_usage_exits_2_with_a_message()
{
    for s in $stages; do
        expect 2 "no-such-option" "$B/bin/$s" --no-such-option
        expect 2 "error" "$B/bin/$s"
        expect 2 "no-such-file" "$B/bin/$s" --config no-such-file.cfg
        expect 2 "no_such_key" "$B/bin/$s" --set no_such_key=1
        expect 2 "threads" "$B/bin/$s" --threads many
    done
}

parameters_out_of_range_are_refused()
{
    expect 2 "planes" "$B/bin/segment_depth" --set planes=-1
    expect 2 "planes" "$B/bin/segment_depth" --set planes=1e9
    expect 2 "tolerance" "$B/bin/fuse_points" --set tolerance=0
    expect 2 "max_angle" "$B/bin/plan_path" --set max_angle=nan
    expect 2 "max_h" "$B/bin/sample_validity" --set max_h=nan
    expect 2 "seed" "$B/bin/choose_effects" --set seed=-1
    expect 2 "tolerance" "$B/bin/pan_scan" --set tolerance=nan
    expect 2 "min_face" "$B/bin/find_subjects" --set min_face=0
    expect 2 "brackets" "$B/bin/import_photos" --set brackets=maybe
    expect 2 "fewer than two frames" "$B/bin/morph_views" --set seconds=0.01
    expect 2 "saturated" "$B/bin/hdr_merge" --set saturated=2
    expect 2 "camera_model" "$B/bin/sfm" --set camera_model=FISH
    expect 2 "baseline" "$B/bin/evaluate" --set baseline=-1
}

options_that_exclude_each_other_are_refused()
{
    d=$scratch/nowhere
    expect 2 "wanted --depth with --validity" "$B/bin/plan_path" --views "$d" --effect e --out "$d"
    expect 2 "wanted --depth with --validity" "$B/bin/plan_path" --views "$d" --effect e --out "$d" --depth "$d"
    expect 2 "wanted --depth with --validity" "$B/bin/plan_path" --views "$d" --effect e --out "$d" --depth "$d" --validity v --moves "$d"
    expect 2 "wanted --depth with --validity" "$B/bin/plan_path" --views "$d" --effect e --out "$d" --keyframes k --subjects s
    expect 2 "either --path" "$B/bin/render_views" --views "$d" --depth "$d" --out "$d"
    expect 2 "either --path" "$B/bin/render_views" --views "$d" --depth "$d" --out "$d" --path "$d" --frames 1 --cameras "$d"
    expect 2 "either --path" "$B/bin/render_views" --views "$d" --depth "$d" --out "$d" --path "$d" --frames 1 --camera x
    expect 2 "either --photos" "$B/bin/morph_views" --out "$d"
    expect 2 "either --photos" "$B/bin/morph_views" --out "$d" --morph "$d"
    expect 2 "either --photos" "$B/bin/morph_views" --out "$d" --morph "$d" --frames 1 --first a
    expect 2 "either --photos" "$B/bin/morph_views" --out "$d" --photos "$d" --records "$d" --first a --second b --frames 1
    expect 2 "wanted --depth with --validity" "$B/bin/plan_path" --views "$d" --effect dolly_in --out "$d"
    expect 2 "wanted --depth with --validity" "$B/bin/plan_path" --views "$d" --effect dolly_in --out "$d" --depth "$d" --validity "$d" --keyframes "$d"
    expect 2 "wanted auto or all" "$B/bin/choose_effects" --subjects "$d" --effect dolly_in --out "$d"
    expect 2 "wanted auto or all" "$B/bin/choose_effects" --effect all --out "$d"
    expect 2 "did you mean dolly_in?" "$B/bin/choose_effects" --effect dolly_inn
    expect 2 "each part once and in this order" "$B/bin/choose_effects" --effect dolly_in+dim+narrow_dof
    expect 2 "takes no image effect" "$B/bin/choose_effects" --effect establishing_dolly+dim
    expect 0 "" "$B/bin/choose_effects" --effect dolly+pull_focus
    expect 2 "--memory -1" "$B/bin/fuse_points" --views "$d" --depth "$d" --out "$d" --memory -1
    expect 2 "or else --estimate" "$B/bin/segment_depth" --views "$d"
    expect 2 "or else --estimate" "$B/bin/segment_depth" --views "$d" --view v --out v.exr --estimate list
    expect 2 "--jobs -1" "$B/bin/segment_depth" --views "$d" --estimate list --jobs -1
    expect 2 "--holdout -3" "$B/bin/sfm_import" --sfm "$d" --records "$d" --out "$d" --holdout -3
    expect 2 "--split 3by2: wanted COLUMNSxROWS" "$B/bin/sfm_import" --sfm "$d" --records "$d" --out "$d" --split 3by2
}

missing_inputs_fail_with_their_name()
{
    d=$scratch/nowhere
    expect 1 "$d" "$B/bin/import_photos" --photos "$d" --out "$scratch/o"
    expect 1 "$d" "$B/bin/hdr_merge" --id v --photos "$d" --records "$d" --out "$scratch/o"
    expect 1 "$d" "$B/bin/sfm_import" --sfm "$d" --records "$d" --out "$scratch/o"
    expect 1 "$d" "$B/bin/rectify" --photo v --photos "$d" --records "$d" --views "$d" --out "$scratch/o"
    expect 1 "$d" "$B/bin/segment_depth" --view v --views "$d" --out "$scratch/o/v.exr"
    expect 1 "$d" "$B/bin/fuse_points" --views "$d" --depth "$d" --out "$scratch/o/p.ply"
    expect 1 "$d" "$B/bin/find_subjects" --views "$d" --depth "$d" --out "$scratch/o/subjects.txt"
    expect 1 "$d" "$B/bin/choose_effects" --subjects "$d" --effect all --out "$scratch/o/all-effects.mk"
    expect 1 "$d" "$B/bin/sample_validity" --views "$d" --depth "$d" --effect establishing_dolly --out "$scratch/o"
    expect 1 "$d" "$B/bin/plan_path" --views "$d" --depth "$d" --validity "$d" --effect establishing_dolly --out "$scratch/o"
    expect 1 "$d" "$B/bin/plan_path" --views "$d" --keyframes "$d" --effect film --out "$scratch/o"
    expect 1 "$d" "$B/bin/render_views" --views "$d" --depth "$d" --path "$d" --frames 1:2 --out "$scratch/o"
    expect 1 "$d" "$B/bin/render_views" --views "$d" --depth "$d" --cameras "$d" --out "$scratch/o"
    expect 1 "$d" "$B/bin/pan_scan" --views "$d" --path "$d" --frames 1:2 --out "$scratch/o"
    expect 1 "$d" "$B/bin/morph_views" --photos "$d" --records "$d" --first a --second b --out "$scratch/o"
    expect 1 "$d" "$B/bin/morph_views" --morph "$d" --frames 1:2 --out "$scratch/o"
    expect 1 "$d" "$B/bin/evaluate" --folder "$d" --shared "$d" --truth "$d" --out "$scratch/o/metrics.tsv"
    expect 1 "$d" "$B/bin/encode_video" --path "$d" --frames "$d" --out "$scratch/o/v.mp4"
    expect 1 "$d" "$B/bin/verify" --file "$d"
    [ -z "$(find "$scratch/o" -type f 2>/dev/null)" ] || { find "$scratch/o"; fail "a product was left"; }
}

make_without_a_scene_builds_and_explains()
{
    make -s DEPS=manual SCENES= >"$scratch/out" 2>&1 || { cat "$scratch/out"; fail "make"; }
    grep -q 'make PHOTOS=DIR SCENE=NAME' "$scratch/out" || fail "the message does not name the missing variables"
}

make_names_its_wrong_arguments()
{
    project words
    expect 2 "SCENE=NAME" make -s DEPS=manual depth
    expect 2 "QUALITY=best" make -s DEPS=manual SCENE=x QUALITY=best
    expect 2 "JOBS=cloud" make -s DEPS=manual SCENE=x JOBS=cloud
    expect 2 "HOLDOUT=some" make -s DEPS=manual SCENE=x HOLDOUT=some
    expect 2 "HOLDOUT=0" make -s DEPS=manual SCENE=x HOLDOUT=0
    expect 2 "SPLIT=9" make -s DEPS=manual SCENE=x SPLIT=9
    expect 2 "SPLIT=0x3" make -s DEPS=manual SCENE=x SPLIT=0x3
    expect 2 "COLUMNSxROWS" make -s DEPS=manual SCENE=x SPLIT="3x3'; touch bad; '"
    [ ! -e bad ] || fail "make ran a command in SPLIT"
    expect 2 "effects are named with letters" make -s DEPS=manual SCENE=x EFFECT='a;b'
    expect 2 "did you mean dolly_in?" make -s DEPS=manual SCENE=x PHOTOS=scenes EFFECT='dolly dolly_inn'
    expect 2 "film of keys scenes/x/keyframes/dolly_inn.txt" make -s DEPS=manual SCENE=x PHOTOS=scenes EFFECT=dolly_inn
    expect 2 "cannot be combined with other effects" make -s DEPS=manual SCENE=x PHOTOS=scenes EFFECT='dolly auto'
    expect 2 "both given" make -s DEPS=manual SCENE=x HOLDOUT=8 HOLDOUT_VIEWS=a
    expect 2 "ids of two photos" make -s DEPS=manual SCENE=x MORPH=a
    expect 2 "ids of two photos" make -s DEPS=manual SCENE=x MORPH='a b c'
    expect 2 "names of photos" make -s DEPS=manual SCENE=x HOLDOUT_VIEWS='a;b'
    expect 2 "scene-none.txt" make -s DEPS=manual edited SCENE=x EDIT=none
    expect 2 "letters, digits" make -s DEPS=manual SCENE='../x'
    expect 2 "PHOTOS=DIR" make -s DEPS=manual SCENE=nothing
    expect 2 "no-such-folder" make -s DEPS=manual SCENE=x PHOTOS=no-such-folder
    [ -z "$(ls scenes)" ] || fail "a scene was left behind"
}

missing_packages_are_named_with_the_command_to_install_them()
{
    project packages
    rm configs; cp -r "$root/configs" configs
    echo "run no-such-package command:no-such-command" >>configs/packages.txt
    expect 2 "no-such-command" make -s DEPS=manual
    grep -q 'apt-get install .*no-such-package' "$scratch/out" || fail "the command to run is not printed"
}

for t in help_version_and_config_of_every_stage wrong_usage_exits_2_with_a_message parameters_out_of_range_are_refused \
    options_that_exclude_each_other_are_refused \
    missing_inputs_fail_with_their_name make_without_a_scene_builds_and_explains make_names_its_wrong_arguments \
    missing_packages_are_named_with_the_command_to_install_them; do run "$t"; done
