# lib.sh - what test scripts share: a scratch project, small scenes, and verdicts.
#
# B is the build folder (out/build/FLAVOR). A test is a shell function; `run NAME` runs it in a subshell with -e and prints
# its verdict. Inside it, `fail WHY` ends it as failed and `skip WHY` as skipped.
set -uo pipefail
root=$PWD
B=${B:-out/build/release}
export FLAVOR=${B##*/}
unset MAKEFLAGS MFLAGS MAKELEVEL SCENE PHOTOS LENS SPLIT LRI LRI_SFM LRI_FRAME GATHER_POINTS GATHER_VIEWS SFM DEPTH EXCLUDE QUALITY HOLDOUT HOLDOUT_VIEWS TRUTH EFFECT MORPH JOBS CORES V CI
scratch=$(mktemp -d "${TMPDIR:-/tmp}/remodel-test.XXXXXX")
trap 'rm -rf --one-file-system "$scratch"' EXIT

# matches [OPTION...] PATTERN: whether standard input matches; use it instead of `| grep -q`, which exits at the first match, so
# that the writer of the pipe may die of SIGPIPE and pipefail makes the test fail by chance
matches() { grep "$@" | cat >/dev/null; }
fail() { echo "# $*"; exit 1; }
skip() { echo "# $*" >"$scratch/.skip"; exit 0; }
run()
{
    rm -f "$scratch/.skip"
    local out rc
    out=$(set -e; "$1" 2>&1); rc=$? # not behind ||, where bash ignores set -e
    if [ -e "$scratch/.skip" ]; then echo "skip $1: $(sed 's/^# //' "$scratch/.skip")"
    elif [ "$rc" -eq 0 ]; then echo "ok $1"
    else
        echo "$out" | tail -n 40
        echo "not ok $1: $(echo "$out" | grep '^# ' | tail -n 1 | sed 's/^# //')"
    fi
}

# project NAME: makes a project folder under scratch (same Makefile, programs and configs; own scenes and out) and changes to it
project()
{
    mkdir -p "$scratch/$1/out" "$scratch/$1/scenes"
    for f in Makefile stages common configs tests; do ln -sfn "$root/$f" "$scratch/$1/$f"; done
    ln -sfn "$root/out/build" "$scratch/$1/out/build"
    cd "$scratch/$1" || exit 1
}

# photos DIR [OPTION...]: makes a synthetic scene, DIR/photos and DIR/model; by default 6 photos of 160x120
photos()
{
    case "$*" in *--views*) ;; *) set -- "$@" --views 6 ;; esac
    case "$*" in *--size*) ;; *) set -- "$@" --size 160x120 ;; esac
    "$root/$B/tests/pipeline/make_photos" --out "$@" 2>&1
}

# small SCENE: writes a scene.cfg for tests of the graph: few planes, large segments, six frames; a view matches with three of
# the others, so that some views do not read a changed one
small()
{
    mkdir -p "scenes/$1"
    cat >"scenes/$1/scene.cfg" <<'CFG'
[segment_depth]
planes = 32
fine_pixels = 64
neighbours = 3
passes = 1
[sample_validity]
max_side = 160
check_side = 48
grid = 3
check_cells = 0
[plan_path]
seconds = 0.5
fps = 12
max_side = 160
pairs = 2
refine = no
parallax_side = 48
CFG
}

# boxed SCENE PRODUCTS: a scene of set/photos inside a closed room of 60 x 60 x 20, modelled, with a box on its floor; an edit removes the box.
# Depth is estimated in one round, and texels are large: their quality does not matter here
boxed()
{
    small "$1"
    sed -i 's/^planes = .*/&\nrounds = 0/' "scenes/$1/scene.cfg"
    printf '[bake_vita]\ntexels = 80\n' >>"scenes/$1/scene.cfg"
    printf 'PRODUCTS := %s\nPHOTOS := set/photos\n' "$2" >"scenes/$1/scene.mk"
    mkdir -p "scenes/$1/edits"
    cat >"scenes/$1/model.txt" <<'END'
remodel-script 1
set ceiling 20
set slab 1
wall south from 30 -30 to -30 -30 thickness 1
wall west from -30 -30 to -30 30 thickness 1
wall north from -30 30 to 30 30 thickness 1
wall east from 30 30 to 30 -30 thickness 1
join south west north east south
room hall south west north east
box block from -2 -2 to 2 2 top 0.01
END
    printf 'remodel-script 1\nremove block\n' >"scenes/$1/edits/bare.txt"
}

# tiny SCENE: writes a scene.cfg for films that are as small as possible, of three frames
tiny()
{
    mkdir -p "scenes/$1"
    cat >"scenes/$1/scene.cfg" <<'CFG'
[segment_depth]
planes = 32
rounds = 0
passes = 1
[sample_validity]
max_side = 96
check_side = 48
grid = 3
check_cells = 0
[plan_path]
seconds = 0.1
max_side = 96
pairs = 2
refine = no
parallax_side = 48
[render_views]
renderer = fast
[encode_video]
preset = ultrafast
CFG
}
# kill_at FILE COMMAND...: runs COMMAND in a process group of its own and kills the group as soon as FILE (a pattern) exists;
# returns once no process of a scene's run is left
kill_at()
{
    local file=$1 p lock; shift
    setsid "$@" >kill.log 2>&1 &
    p=$!
    while kill -0 "$p" 2>/dev/null && ! compgen -G "$file" >/dev/null; do sleep 0.02; done
    kill -9 -- "-$p" 2>/dev/null || true
    wait "$p" 2>/dev/null || true
    for lock in out/*/.lock; do flock "$lock" true; done # held by each process of the run
}
# products SCENE: hash and name of every product of sfm_import and later stages
products()
{
    (cd "out/$1" && find views depth parallax -type f ! -name '.*' ! -name '*.d' | LC_ALL=C sort | xargs -d '\n' sha256sum)
}
# snapshot FOLDER: names and times of all products, to see which are remade
snapshot() { find "$1"/ -type f \( -path '*/views/*' -o -path '*/depth/*' -o -path '*/parallax/*' -o -path '*/sfm/*' -o -name index.html \) -printf '%P %T@\n' | LC_ALL=C sort; }
# changed BEFORE AFTER: of two snapshots, the names that are new or have another time
changed() { comm -13 "$1" "$2" | cut -d' ' -f1; }
# painted FILE X Y: writes a mask for a photo of 160 x 120; black are 30 x 25 pixels, the first at (X, Y)
painted() { ffmpeg -v error -f lavfi -i color=white:s=160x120 -vf "drawbox=x=$2:y=$3:w=30:h=25:color=black:t=fill" -frames:v 1 -y "$1"; }
# alpha EXR X Y [LAYER]: the four bytes of a pixel's alpha
alpha() { ffmpeg -v error ${4:+-layer "$4"} -i "$1" -vf "extractplanes=a,crop=1:1:$2:$3" -f rawvideo - | od -An -tx1 | tr -d ' \n'; }
# reads DEPS PHOTO: whether a depth map with these make dependencies depends on that photo's view, directly or through an earlier round
reads()
{
    local before
    grep -q "/views/$2.exr" "$1" && return
    for before in $(sed 1d "$1" | grep -oE "^[^ ]*/depth/round[0-9]+/[^ ]*\.exr"); do
        reads "${before%.exr}.d" "$2" && return
    done
    return 1
}

# same_model FOLDER OTHER: the files of a model in FOLDER have the same bytes in OTHER; adds their number to `count`
same_model()
{
    local f
    for f in model.txt plan.txt merged.txt plan.svg texture.txt objects.txt; do
        [ -e "$1/$f" ] || continue
        cmp "$1/$f" "$2/$f" || fail "$2/$f differs"
        count=$((count + 1))
    done
}
