# lib.sh - for the tests that are scripts: a scratch project, and verdicts.
#
# B is the build folder (out/build/FLAVOR). A test is a shell function; `run NAME` runs it in a subshell with -e and prints
# its verdict; `skip WHY` inside ends it as skipped.
set -uo pipefail
root=$PWD
B=${B:-out/build/release}
export FLAVOR=${B##*/}
unset MAKEFLAGS MFLAGS MAKELEVEL SCENE PHOTOS SPLIT LRI LRI_SFM SFM DEPTH EXCLUDE QUALITY HOLDOUT HOLDOUT_VIEWS TRUTH EFFECT MORPH JOBS CORES V CI
scratch=$(mktemp -d "${TMPDIR:-/tmp}/remodel-test.XXXXXX")
trap 'rm -rf --one-file-system "$scratch"' EXIT

# matches [OPTION...] PATTERN: whether standard input has it; in place of grep -q, which leaves at the first match, so that under
# pipefail the command that writes into the pipe dies of SIGPIPE and the test fails by chance
matches() { grep "$@" | cat >/dev/null; }
fail() { echo "# $*"; exit 1; }
skip() { echo "# $*" >"$scratch/.skip"; exit 0; }
run()
{
    rm -f "$scratch/.skip"
    local out rc=0
    out=$(set -e; "$1" 2>&1) || rc=$?
    if [ -e "$scratch/.skip" ]; then echo "skip $1: $(sed 's/^# //' "$scratch/.skip")"
    elif [ "$rc" -eq 0 ]; then echo "ok $1"
    else
        echo "$out" | tail -n 40
        echo "not ok $1: $(echo "$out" | grep '^# ' | tail -n 1 | sed 's/^# //')"
    fi
}

# project NAME: a project folder of its own under scratch (same Makefile, programs and configs; own scenes and out); goes there
project()
{
    mkdir -p "$scratch/$1/out" "$scratch/$1/scenes"
    for f in Makefile stages common configs tests; do ln -sfn "$root/$f" "$scratch/$1/$f"; done
    ln -sfn "$root/out/build" "$scratch/$1/out/build"
    cd "$scratch/$1" || exit 1
}

# photos DIR [OPTION...]: a synthetic scene, DIR/photos and DIR/model; 6 photos of 160x120 by default
photos()
{
    case "$*" in *--views*) ;; *) set -- "$@" --views 6 ;; esac
    case "$*" in *--size*) ;; *) set -- "$@" --size 160x120 ;; esac
    "$root/$B/tests/pipeline/make_photos" --out "$@" 2>&1
}

# small SCENE: a scene.cfg for tests that are about the graph: few planes, few frames
small()
{
    mkdir -p "scenes/$1"
    cat >"scenes/$1/scene.cfg" <<'CFG'
[segment_depth]
planes = 32
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

# tiny SCENE: films of three frames, as small as may be
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
# products SCENE: hash and name of every product from sfm_import on
products()
{
    (cd "out/$1" && find views depth parallax -type f ! -name '.*' ! -name '*.d' | LC_ALL=C sort | xargs -d '\n' sha256sum)
}
# snapshot FOLDER: names and times of all products, to see what was made again
snapshot() { find "$1"/ -type f \( -path '*/views/*' -o -path '*/depth/*' -o -path '*/parallax/*' -o -path '*/sfm/*' -o -name index.html \) -printf '%P %T@\n' | LC_ALL=C sort; }
# changed BEFORE AFTER: the names whose time changed, or that are new
changed() { comm -13 "$1" "$2" | cut -d' ' -f1; }
# painted FILE X Y: a mask of a photo of 160 x 120, black in 30 x 25 pixels from (X, Y) on
painted() { ffmpeg -v error -f lavfi -i color=white:s=160x120 -vf "drawbox=x=$2:y=$3:w=30:h=25:color=black:t=fill" -frames:v 1 -y "$1"; }
# alpha EXR X Y [LAYER]: the four bytes of a pixel's alpha
alpha() { ffmpeg -v error ${4:+-layer "$4"} -i "$1" -vf "extractplanes=a,crop=1:1:$2:$3" -f rawvideo - | od -An -tx1 | tr -d ' \n'; }
# reads DEPS PHOTO: whether a depth map with these make dependencies comes from that photo's view, be it by way of a round before
reads()
{
    local before
    grep -q "/views/$2.exr" "$1" && return
    for before in $(sed 1d "$1" | grep -oE "^[^ ]*/depth/round[0-9]+/[^ ]*\.exr"); do
        reads "${before%.exr}.d" "$2" && return
    done
    return 1
}
