# scene.sh - scenes as small as they can be that together run every stage, and the campaign of faults over their
# programs. Sourced after tests/lib.sh, in a project folder.
#
# t: synthetic photos of a modelled room with edits, furniture, lamps, marks, light levels, films and pages.
# room: a described scene in two exposures, with a reference image.
# found: four photos whose cameras COLMAP finds.

faults_describe()
{
    photos set --views 5 --size 96x72 >/dev/null
    boxed t 'textures remodel'
    sed -i 's/^set slab 1$/set slab 1\nset glass 0.1/' scenes/t/model.txt
    printf 'window pane on east from -5 5 to 5 12\n' >>scenes/t/model.txt
    sed -i 's/^texels = .*/texels = 40/; s/^max_side = 160/max_side = 96/' scenes/t/scene.cfg
    cat >>scenes/t/scene.cfg <<'CFG'
[bake_outdoors]
height = 32
edge = 1
max_clutter = 1
[plan_tour]
width = 48
height = 36
fps = 2
speed = 20
clearance = 0.5
hold = 0.5
[update_vita]
spacing = 0.5
finest = 0.5
bend = 5
rounds = 3
rays = 64
tolerance = 0.2
[relight]
target_error = 0.5
rays = 64
[light_levels]
patches = 100
rays = 16
point_rays = 16
spacing = 1
margin = 0.25
[fit_materials]
points = 20
views = 3
max_clutter = 1
edge = 0
[gather_irradiance]
rays = 64
[render_views]
renderer = fast
[encode_video]
preset = ultrafast
CFG
    mkdir -p scenes/t/objects scenes/t/keyframes
    printf '%s\n' 'v 0 0 0' 'v 8 0 0' 'v 8 8 0' 'v 0 8 0' 'v 4 4 8' 'f 4 3 2 1' 'f 1 2 5' 'f 2 3 5' 'f 3 4 5' 'f 4 1 5' \
        >scenes/t/objects/tent.obj
    cat >scenes/t/edits/dark.txt <<'END'
remodel-script 1
# A dark floor, a chest, a tent and a lamp.
paint floor/hall 0.05 0.05 0.05
box chest from -4 6 to 4 12 top 3
colour box/chest 0.1 0.2 0.8
material box/chest ward 0.05 0.2
object tent objects/tent.obj at -14 4 0 matt 0.6 0.2 0.1
lamp hung ies new.ies at 0 8 16 colour 1 0.9 0.8
clear hall
END
    printf 'remodel-places 1\nplace desk at 0 8 size 2 1\n' >scenes/t/places.txt
    printf '%s\n' IESNA:LM-63-2002 TILT=NONE '1 -1 1 2 1 1 2 0 0 0' '1 1 0' '0 90' 0 '1000 1000' >scenes/t/new.ies
    cat >scenes/t/states.txt <<'END'
remodel-states 1
site 52.5 13.4 1
lamp new ies new.ies at 0 8 18
state noon lamps off sky clear 6 21 12
state planned lamps off lamp new 1
END
    printf 'remodel-keyframes 1\nkey 0 view photo_2\nkey 0.2 view photo_3\n' >scenes/t/keyframes/across.txt
    printf 'remodel-marked-materials 1\nmaterial paint in photo_2 1 1 95 1 95 71 1 71\n' >scenes/t/materials.txt
    printf 'remodel-lamps 1\ndisk spot in photo_2 48 10 rim 51 10 beta 30 radiance 9 8 7\n' >scenes/t/lights.txt
    printf 'remodel-lux 1\nluminance wall 35.5 in photo_2 48 36 52 40\n' >scenes/t/lux.txt
    printf '0 0 1 0 0 1\n5 5 1 0 0 1\n' >points.txt

    mkdir -p scenes/room
    cat >scenes/room/scene.txt <<'END'
remodel-scene 1
texture plain plaster 0.3 0.4 1  0.6 0.58 0.5
material m lambert plain
room hall 0 0 4 3  0 2.5  m m
wall south 0 0 4 0  0 2.5 0.2 m
wall east 4 0 4 3  0 2.5 0.2 m
wall north 4 3 0 3  0 2.5 0.2 m
wall west 0 3 0 0  0 2.5 0.2 m
lamp l quad 1 1 2.49  0 1 0  1 0 0  10 10 9
END
    cat >scenes/room/cameras.txt <<'END'
remodel-shoot 1
lens p pinhole 60 40 50 50 30 20
lens f equisolid 60 40 27 30 20
exposure 0.02
exposure 0.04
sensor 30000 6 1 5
photo a p 1 1 1.5  3 2 1.2
photo b p 1.2 1 1.5  3 2 1.2
photo c p 1.4 1 1.5  3 2 1.2
reference r f 2 1 1  0 1 1
END
    printf '[simulate]\nsamples = 4\nirradiance_samples = 64\n' >scenes/room/scene.cfg
    printf '%s\n' 'PHOTOS := out/room/simulated/photos' 'LRI := out/room/simulated/lri' \
        'LRI_SFM := out/room/simulated/truth/lri' 'LRI_FRAME := scene' >scenes/room/scene.mk

    photos textured --views 4 --size 240x180 >/dev/null
}

# faults_goal SCENE WORD...: make of a goal
faults_goal()
{
    local scene=$1; shift
    make -s DEPS=manual CORES=1 SCENE="$scene" "$@" >log 2>&1 || { tail -n 20 log; fail "make $*"; }
}
# faults_make: all three
faults_make()
{
    local goal given=(PHOTOS=set/photos SFM=set/model 'LUX_PHOTOS=photo_1 photo_2' RELIT_VIEWS=photo_2)
    given+=(GATHER_POINTS=points.txt)
    for goal in all 'lux EDIT=dark' 'relight EDIT=dark' 'tour EDIT=dark' 'relit-tour EDIT=dark' walk exports draw suggest \
        'EFFECT=establishing_dolly video' 'EFFECT=across video' pan_scan subjects luminance lights \
        'irradiance GATHER_VIEWS=photo_2' materials evaluate things; do
        # shellcheck disable=SC2086 # words
        faults_goal t "${given[@]}" $goal
    done
    faults_goal t "${given[@]}" 'MORPH=photo_2 photo_3' morph
    faults_goal room hdr lri
    faults_goal found PHOTOS=textured/photos doctor
    faults_goal found PHOTOS=textured/photos sfm
}

# faults_record COMMAND...: runs it; each program that it starts leaves its command line in the folder `recorded`
faults_record()
{
    mkdir -p recorded
    FAULT_RECORD=$PWD/recorded LD_PRELOAD=$root/$B/tests/faults/shim.so "$@"
}
# faults_commands: of the recorded commands, one of each program and each set of options, one file a line
faults_commands()
{
    local f
    for f in recorded/*; do
        # the folder, the program, then its arguments
        tr '\0' '\n' <"$f" | awk -v file="$f" 'NR == 2 { n = split($0, part, "/"); key = part[n] }
            NR > 2 && /^--/ && !seen[$0]++ && $0 != "--config" { key = key " " $0 }
            # a run gives some programs a list, which is gone when it ends
            /\/remodel\.[A-Za-z0-9]*\// { passing = 1 }
            END { if (!passing && key !~ / --print-config/ && key !~ /^print_graph/) print key "\t" file }'
    done | sort -t "$(printf '\t')" -k1,1 -u | cut -f2
}
# faults_inject EACH INPUTS: of each command, EACH moments of each kind of fault, and INPUTS damaged files. Each begins with the
# same files. Results go to results.tsv and details.tsv
faults_inject()
{
    local f
    faults_commands >commands
    : >results.tsv; : >details.tsv
    cp -a "$PWD" "$scratch/kept"
    while read -r f; do
        rm -rf "$scratch/work" "$scratch/temp"; cp -a "$scratch/kept" "$scratch/work"; mkdir "$scratch/temp"
        "$root/$B/tests/faults/campaign" --folder "$scratch/work" --command "$f" --shim "$root/$B/tests/faults/shim.so" \
            --results results.tsv --details details.tsv --temp "$scratch/temp" --each "$1" --inputs "$2" </dev/null 2>log ||
            { cat log; fail "$f: the campaign ended"; }
    done <commands
    awk -F '\t' -v OFS='\t' 'BEGIN { print "stage", "fault", "right", "sentence", "killed", "library", "accepted", "wrong",
            "lost", "half", "crash", "hang", "silent", "vague", "rerun" }
        { key = $1 OFS $2; if (!(key in known)) { known[key] = 1; order[++n] = key }
            for (i = 3; i <= NF; i++) { sum[key, i] += $i; all[i] += $i } last = NF }
        END { order[++n] = "all" OFS "all"; for (i = 3; i <= last; i++) sum[order[n], i] = all[i]
            for (k = 1; k <= n; k++) { line = order[k]; for (i = 3; i <= last; i++) line = line OFS sum[order[k], i]; print line } }' \
        results.tsv >table.tsv
}
# faults_count COLUMN: how many injections ended so
faults_count()
{
    awk -F '\t' -v name="$1" 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == name) at = i } END { print $at }' table.tsv
}
# faults_none COLUMN: fails with the details of these
faults_none()
{
    [ "$(faults_count "$1")" = 0 ] || { grep "^$1" details.tsv | cut -c1-400; fail "$(faults_count "$1") injections"; }
}

every_result_is_right_or_is_an_error() { faults_none wrong; }
nothing_else_is_changed() { faults_none lost; }
no_half_product_is_left() { faults_none half; }
no_program_crashes() { faults_none crash; }
no_program_hangs() { faults_none hang; }
every_failure_has_a_sentence() { faults_none silent; }
every_sentence_names_a_file_or_memory() { faults_none vague; }
a_run_afterwards_gives_the_right_bytes() { faults_none rerun; }
FAULT_TESTS='every_result_is_right_or_is_an_error nothing_else_is_changed no_half_product_is_left no_program_crashes
    no_program_hangs every_failure_has_a_sentence every_sentence_names_a_file_or_memory a_run_afterwards_gives_the_right_bytes'
