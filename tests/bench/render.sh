# render.sh - render_views: PSNR of held-out photos against time for each of its parameters; frames per second; memory.
#
# Scenes: BENCH_SCENES, names of scenes/ or of folders of BENCH_DATA (../shared/data) that hold photos/; others are
# skipped with a message. Every eighth photo is held out, or the views named after a colon (still-life:s4). Depth maps come
# from `make SCENE=NAME HOLDOUT=8 depth`. NAME-truth is the scene of the photos of NAME with the cameras of
# BENCH_DATA/NAME/truth-cameras (true_cameras.awk). A folder with truth/novel, pictures that nobody photographed, is
# compared with these, and nothing is held out. The first run of bonsai and apartment takes long: BENCH_SCENES="fern kermit".
# psnr (dB), ssim and holes (%) are those of docs/evaluation.md; gain is psnr over that of plain hard z; psnr_VIEW is
# that of a photo, in the scenes of BENCH_BY_PHOTO (sceaux: a third of 100_7100 is a tree that no other photo shows). seconds and core_s_per_mp (CPU time per megapixel) are those of one frame, in memory, without reading
# the scene and writing files (render_rate.c); the megapixels are the photo's at any scale. peak_mib is of the process,
# including all views. BENCH_SWEEPS="scale views": only these panels.
#
# The default setting is in every panel; a panel varies one parameter. `scale`: size of the frames, which are enlarged
# to the photo's size before they are compared. `soft_z`: its width in depth uncertainties; 0 is that of [Colburn 2014],
# the scene's depth range. `views`: the number that may contribute to a pixel: 1 (views=nearest), 3 (more_views=0), or 3
# and that many more. `filling`: of holes, by patches (offline) or from the surroundings (fast); off is fill_diameter=0.
#
# `candidates` chooses without the scene that is reported (left_out.awk): BENCH_CANDIDATES lists settings, each KEY=VALUE or
# several of them with commas, the default beside them. For each scene the setting with the best mean PSNR over the other
# scenes is chosen. The result is render_left_out.tsv; these rows are not plotted.
#
# Baselines: the photo of the nearest view as it is, only in the table, because copying is not rendering; hard z, the
# nearest view's depth map alone, by the fast renderer; constant z, the offline renderer with every segment flattened at
# its middle (flatten_depth.c).
#
# Two more panels have no photos: `rate`, frames of the move of BENCH_RATE (still-life, all views) at 1200 x 800 by
# threads, and `memory`, frames of 15 synthetic views of 1 megapixel (made_layers.c). BENCH_THREADS (all cores) applies
# to all rows but those of `rate`.
title="New views: PSNR of held-out photos against time"
note="Upper left is better. Each panel varies one parameter; the others have their defaults."
repeats=1 # pictures repeat exactly; REPEATS=5 BENCH_SCENES= BENCH_SWEEPS=rate for times
baseline="hard z"
match="scene sweep"
timed="core_s_per_mp frames_per_s core_ms"
line=series label=value panel="scene sweep" across=4
x=core_s_per_mp x_label="Core-seconds per megapixel" y=psnr y_label="PSNR (dB)" zero=no

scenes=${BENCH_SCENES-fern sceaux kermit fountain still-life:s4 office fountain-truth bonsai apartment}
by_photo=${BENCH_BY_PHOTO-sceaux}
candidates=${BENCH_CANDIDATES-soft_z=0 soft_z=8 soft_z=16 soft_z=64 more_views=0 more_views=4 more_views=8 views=nearest \
    renderer=fast exposure=taken fill_diameter=0 fill_diameter=24 fill_patch=9 fill_window=50}
data=${BENCH_DATA:-../shared/data}
rate_scene=${BENCH_RATE-still-life}
threads=${BENCH_THREADS:-$(nproc)}
sweeps=${BENCH_SWEEPS:-scale soft_z views filling candidates rate memory}

wanted() { case " $sweeps " in *" $1 "*) ;; *) return 1 ;; esac; }
quietly() { "$@" >"$work/messages" 2>&1 || { tail -n 5 "$work/messages" >&2; missing "'$*' failed."; }; }
made() { echo "render: make $*" >&2; quietly "${MAKE:-make}" --no-print-directory QUALITY=default "$@"; }

# makes the products of NAME, without the views HELD or every eighth one; $work/NAME has the layout that evaluate reads, the
# cameras to render, and frames/, where their frames belong
prepare_scene() # NAME HELD
{
    local to=$work/$1 from=out/$1+holdout8 of=$data/$1 args=() novel=
    if [[ $1 == *-truth && -d $data/${1%-truth}/truth-cameras ]]; then of=$data/${1%-truth}; fi
    if ! grep -qs '^PHOTOS' "scenes/$1/scene.mk"; then
        if [ ! -d "$of/photos" ]; then echo "render: $1 is skipped, because there is neither scenes/$1/scene.mk nor $of/photos." >&2; return; fi
        args=(PHOTOS="$of/photos")
    fi
    mkdir -p "$to/flat"
    if [ "$of" != "$data/$1" ]; then true_model "$of" "$to/model"; args+=(SFM="$to/model"); fi
    if [ -n "$2" ]; then
        args+=(HOLDOUT= HOLDOUT_VIEWS="$2")
        from=out/$1+holdout
    elif [ -d "$of/truth/novel" ]; then
        args+=(HOLDOUT= HOLDOUT_VIEWS=)
        from=out/$1 novel=$of/truth
    else
        args+=(HOLDOUT=8 HOLDOUT_VIEWS=)
    fi
    made SCENE="$1" "${args[@]}" depth
    ln -s "$(realpath "$from/views")" "$to/views"
    ln -s "$(realpath "$from/depth")" "$to/layers" # not named depth: `evaluate` would evaluate it each time
    ln -s "$(realpath "out/$1")" "$to/shared"
    if [ -n "$novel" ]; then
        ln -s "$(realpath "$novel")" "$to/truth"
        quietly "$B/bin/evaluate" --folder "$to" --shared "$to/shared" --truth "$to/truth/" --out "$to/metrics.tsv"
        mkdir -p "$to/rendered/novel"
        cp "$to"/evaluate/cameras/novel/*.txt "$to/rendered/novel/"
        ln -s "$to/evaluate/cameras/novel" "$to/cameras"
        ln -s rendered/novel "$to/frames"
    else
        mkdir -p "$to/holdout/frames"
        ln -s "$(realpath "$from/holdout/views")" "$to/holdout/views"
        ln -s holdout/views "$to/cameras"
        ln -s holdout/frames "$to/frames"
    fi
    quietly "$B/tests/bench/flatten_depth" --views "$to/views" --depth "$to/layers" --out "$to/flat"
    found_scenes+=" $1"
}
# the true cameras of the photos of DIR, as a model in TO
true_model() # DIR TO
{
    local photos=("$1"/photos/*)
    mkdir -p "$2"
    quietly awk -v size="$(ffprobe -v error -show_entries stream=width,height -of csv=p=0 "${photos[0]}")" -v to="$2" \
        -f "$here/true_cameras.awk" "$1"/truth-cameras/*.camera
}

prepare()
{
    [ -x "$B/tests/bench/render_rate" ] || missing "there is no program $B/tests/bench/render_rate."
    "$B/bin/render_views" --print-config >"$work/defaults"
    local s
    found_scenes=
    if wanted scale || wanted soft_z || wanted views || wanted filling || wanted candidates; then
        for s in $scenes; do prepare_scene "${s%%:*}" "$(case $s in *:*) echo "${s#*:}" ;; esac)"; done
    fi
    if [ -n "$rate_scene" ] && wanted rate; then made SCENE="$rate_scene" HOLDOUT= HOLDOUT_VIEWS= path; fi
    if wanted memory; then quietly "$B/tests/bench/made_layers" --out "$work/made"; fi
    if [ -z "$found_scenes" ]; then # no photos, no PSNR to draw
        note="Upper left is better." x=core_ms x_label="Core-milliseconds per frame" y=frames_per_s y_label="Frames per second" zero=yes
        title="New views: frames per second"
    fi
    [ -n "$found_scenes" ] || { [ -n "$rate_scene" ] && wanted rate; } || wanted memory || missing "there is no scene; BENCH_SCENES=\"NAMES\" lists names of scenes/, or of folders with photos/ in '$data' (BENCH_DATA)."
}

default_of() { sed -n "s/^$1 = //p" "$work/defaults"; }

settings()
{
    printf 'series\tscene\tsweep\tvalue\n'
    row() { printf '%s\t%s\t%s\t%s\n' "$@"; }
    local s sweep v r
    for s in $found_scenes; do
        for sweep in scale soft_z views filling; do
            wanted "$sweep" || continue
            for r in 'nearest photo' 'hard z' 'constant z'; do row "$r" "$s" "$sweep" -; done
            for r in fast offline; do
                case $sweep in
                scale) for v in ${BENCH_SCALES:-0.25 0.5 1}; do row "$r" "$s" scale "$v"; done ;;
                soft_z) for v in $(printf '%s\n' 0 4 8 16 64 "$(default_of soft_z)" | sort -gu); do row "$r" "$s" soft_z "$v"; done ;;
                views) for v in 1 3; do row "$r" "$s" views "$v"; done ;;
                filling) for v in off on; do row "$r" "$s" filling "$v"; done ;;
                esac
            done
            [ "$sweep" != views ] || for v in $(printf '%s\n' 4 8 12 "$(default_of more_views)" | sort -gu); do row offline "$s" views "3+$v"; done
        done
        # not where revisions are compared: an older one may lack a parameter
        [ -n "$old" ] || ! wanted candidates || for v in default $candidates; do row offline "$s" candidates "$v"; done
    done
    if [ -n "$rate_scene" ] && wanted rate; then
        for r in fast coverage offline; do for v in 1 2; do row "$r" "$rate_scene" rate "$v threads"; done; done
    fi
    if wanted memory; then for r in fast offline; do row "$r" made memory '15 views'; done; fi
}

# rate ARGS...: measures rendering of frames without photos
rate() { measured "$B/tests/bench/render_rate" "$@"; }

# solved SCENE KEY ARGS...: makes $fast/KEY, a sample's lines without gain. The default is in every panel, so the result
# of a setting is kept for the rest of the repeat.
solved()
{
    local scene=$1 of=$work/$1 key=$2 truth=(); shift 2
    [ ! -e "$fast/$key" ] || return 0
    [ ! -e "$of/truth" ] || truth=(--truth "$of/truth/" --rendered "$of/rendered")
    rm -f "$of"/frames/*.exr
    measured "$B/tests/bench/render_rate" --threads "$threads" --views "$of/views" --cameras "$of/cameras" --out "$of/frames" "$@" | grep -v '^holes ' >"$fast/rendered" &&
        "$B/bin/evaluate" --folder "$of" --shared "$of/shared" "${truth[@]}" --out "$of/metrics.tsv" 2>"$work/err" || return
    awk -F'\t' '$1 ~ /^(holdout|novel)\.(psnr|ssim|holes)$/ { sub(/.*\./, "", $1); printf "%s %.5g\n", $1, $2 }' "$of/metrics.tsv" >>"$fast/rendered"
    case " $by_photo " in *" $scene "*) awk -F'\t' '$2 == "holdout.psnr" { printf "psnr_%s %.5g\n", $1, $3 }' "$of/evaluate/views.tsv" >>"$fast/rendered" ;; esac
    mv "$fast/rendered" "$fast/$key"
}
psnr_of() { awk '$1 == "psnr" { print $2 }' "$fast/$1"; }

sample() # SERIES SCENE SWEEP VALUE
{
    local of=$work/$2 key v args=() same="$2 $r ${B//\//_}"
    case $3 in
    rate)
        args=(--threads "${4%% *}" --views "out/$2/views" --depth "out/$2/depth" --path "out/$2/parallax/establishing_dolly")
        case $1 in coverage) args+=(--coverage) ;; offline) args+=(--frames 5 --set renderer=offline) ;; *) args+=(--set "renderer=$1") ;; esac
        rate "${args[@]}"; return ;;
    memory) rate --threads "$threads" --views "$of/views" --depth "$of/depth" --cameras "$of/cameras" --set "renderer=$1"; return ;;
    esac
    local hard=(--depth "$of/layers" --set renderer=fast --set views=nearest)
    case $1 in
    'nearest photo') args=(--photo) ;;
    'hard z') args=("${hard[@]}") ;;
    'constant z') args=(--depth "$of/flat" --set renderer=offline) ;;
    *)
        args=(--depth "$of/layers" --set "renderer=$1")
        case $3=$4 in
        scale=1 | views=3+"$(default_of more_views)" | filling=on) ;;
        scale=*) args+=(--scale "$4") ;;
        views=1) args+=(--set views=nearest) ;;
        views=3) [ "$1" = fast ] || args+=(--set more_views=0) ;;
        views=*) args+=(--set "more_views=${4#3+}") ;;
        filling=off) args+=(--set fill_diameter=0) ;;
        candidates=default) ;;
        candidates=*) for v in ${4//,/ }; do args+=(--set "$v"); done ;;
        *) [ "$4" = "$(default_of "$3")" ] || args+=(--set "$3=$4") ;;
        esac ;;
    esac
    key="$same ${args[*]//\//_}"
    solved "$2" "$same ${hard[*]//\//_}" "${hard[@]}" && solved "$2" "$key" "${args[@]}" || return
    if [ "$1" = 'nearest photo' ] || [ "$3" = candidates ]; then grep -v '^core_s_per_mp ' "$fast/$key"; else cat "$fast/$key"; fi
    awk -v a="$(psnr_of "$key")" -v b="$(psnr_of "$same ${hard[*]//\//_}")" 'BEGIN { printf "gain %.2f\n", a - b }'
}

# photos that have a column of their own are parts of their scene
finish() # TABLE
{
    awk -F'\t' '
        /^#/ { next }
        !n { n = NF; for (i = 1; i <= n; i++) { column[$i] = i; name[i] = $i }; next }
        $(column["sweep"]) != "candidates" { next }
        { of = $(column["scene"]); print of "\t" $(column["value"]) "\t" $(column["psnr"]) }
        { for (i = 1; i <= n; i++) if (name[i] ~ /^psnr_/ && $i != "-") print of "/" substr(name[i], 6) "\t" $(column["value"]) "\t" $i }
        ' "$1" >"$work/candidates"
    [ ! -s "$work/candidates" ] || left_out higher <"$work/candidates"
}
