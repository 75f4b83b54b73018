# scene.sh - two scenes as small as they can be that together run every stage; sourced after tests/lib.sh, in a project folder.
#
# t: synthetic photos of a modelled room with edits, furniture, lamps, marks, light levels, films and pages.
# room: a described scene in two exposures, with a reference image.

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
    printf 'v 0 0 0\nv 8 0 0\nv 8 8 0\nv 0 8 0\nv 4 4 8\nf 4 3 2 1\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n' >scenes/t/objects/tent.obj
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
    printf 'IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 0\n0 90\n0\n1000 1000\n' >scenes/t/new.ies
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
    printf 'PHOTOS := out/room/simulated/photos\nLRI := out/room/simulated/lri\nLRI_SFM := out/room/simulated/truth/lri\nLRI_FRAME := scene\n' >scenes/room/scene.mk

    photos textured --views 4 --size 240x180 >/dev/null
}

# faults_goal SCENE WORD...: make of a goal
faults_goal()
{
    local scene=$1; shift
    make -s DEPS=manual CORES=1 SCENE="$scene" "$@" >log 2>&1 || { tail -n 20 log; fail "make $*"; }
}
# faults_make: both scenes, and one whose cameras COLMAP finds
faults_make()
{
    local goal given=(PHOTOS=set/photos SFM=set/model 'LUX_PHOTOS=photo_1 photo_2' RELIT_VIEWS=photo_2 GATHER_POINTS=points.txt)
    for goal in all 'lux EDIT=dark' 'relight EDIT=dark' 'tour EDIT=dark' 'relit-tour EDIT=dark' walk exports draw suggest \
        'EFFECT=establishing_dolly video' 'EFFECT=across video' pan_scan subjects luminance lights 'irradiance GATHER_VIEWS=photo_2' \
        materials evaluate things; do
        # shellcheck disable=SC2086 # words
        faults_goal t "${given[@]}" $goal
    done
    faults_goal t "${given[@]}" 'MORPH=photo_2 photo_3' morph
    faults_goal room hdr lri
    faults_goal found PHOTOS=textured/photos doctor
    faults_goal found PHOTOS=textured/photos sfm
}
