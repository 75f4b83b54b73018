# render_model.sh - frames per second of the shell of a model, 1024 x 768, between two viewpoints, in memory.
#
# The camera goes from one view to the other in 25 frames, each with another pose and another share of the second
# viewpoint (render_model.c). `pair`: the textures of both viewpoints are blended; `single`: those of the first one alone;
# in both the VITA fills what they do not show. `vita`: the VITA alone. Clutter is not drawn. visible_ms is the time of
# finding the faces, shade_ms that of their colours; core_ms is CPU time.
#
# The scene is BENCH_SCENE (loft) at BENCH_QUALITY (draft); its atlases are baked first ('make textures'), which takes
# long. BENCH_FOLDER, a folder with views, model, vdta and vita, is taken as it is. BENCH_VIEWS names the two views,
# BENCH_THREADS the numbers of threads.
title="Shells of models: frames per second"
note="1024 x 768, between two viewpoints, without clutter."
baseline=pair
match=threads
timed="frames_per_s core_ms visible_ms shade_ms"
line=series label=threads
x=core_ms x_label="Core-milliseconds per frame" y=frames_per_s y_label="Frames per second"

scene=${BENCH_SCENE:-loft}
quality=${BENCH_QUALITY:-draft}
folder=${BENCH_FOLDER:-out/$scene+$quality}
views=${BENCH_VIEWS:-v01@0 v02@0}
threads=${BENCH_THREADS:-1 2}

prepare()
{
    [ -x "$B/tests/bench/render_model" ] || missing "there is no program $B/tests/bench/render_model; this revision cannot render models."
    [ -n "${BENCH_FOLDER:-}" ] || "${MAKE:-make}" --no-print-directory SCENE="$scene" QUALITY="$quality" textures >"$work/messages" 2>&1 ||
        missing "'make SCENE=$scene QUALITY=$quality textures' failed: $(tail -n 1 "$work/messages")"
    local f
    for f in views/cameras.txt model/model.txt vita/atlas.txt; do
        [ -e "$folder/$f" ] || missing "there is no $folder/$f; BENCH_FOLDER names a folder with views, model, vdta and vita."
    done
}

settings()
{
    printf 'series\tthreads\n'
    local s n
    for s in pair single vita; do for n in $threads; do printf '%s\t%s\n' "$s" "$n"; done; done
}

sample() # SERIES THREADS
{
    measured "$B/tests/bench/render_model" --folder "$folder" --vdta "$folder/vdta" --vita "$folder/vita" \
        --from "${views% *}" --to "${views#* }" --texture "$1" --threads "$2"
}
