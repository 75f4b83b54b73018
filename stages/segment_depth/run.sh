# run.sh - depth in rounds, with an estimate of time and memory before. Sourced by common/run/run_scene.sh.

check_segment_depth()
{
    [ -z "${REMODEL_DEPTH-}" ] || [ -d "$REMODEL_DEPTH" ] || [ -f "$REMODEL_DEPTH" ] ||
        usage "DEPTH=$REMODEL_DEPTH is not a folder. Give the folder that holds VIEW.exr, .png, .pfm, .tif or .tiff, the depth of views, or, of one photo, the file."
}

# says which views have a file in DEPTH, and which files belong to no view
report_given_depth()
{
    local views held of_views=0 of_held=0 of_none='' f depth=${REMODEL_DEPTH-}
    [ -n "$depth" ] || [ ! -d "$S/sfm_depth" ] || depth=$S/sfm_depth
    [ -n "$depth" ] || [ ! -d "$S/photo_depth" ] || depth=$S/photo_depth
    [ -n "$depth" ] || return 0
    views=$(sed 's/^VIEWS :=//' "$O/views/views.mk")
    held=$([ ! -e "$O/holdout/views/views.mk" ] || sed 's/^VIEWS :=//' "$O/holdout/views/views.mk")
    for f in "$S"/stamp/given/*.txt; do
        [ -e "$f" ] && [ "$(<"$f")" != none ] || continue
        f=${f##*/} f=${f%.txt}
        case " $views " in *" $f "*) of_views=$((of_views + 1)); continue ;; esac
        case " $held " in *" $f "*) of_held=$((of_held + 1)) ;; *) of_none+=" $f" ;; esac
    done
    if [ -n "${REMODEL_DEPTH-}" ] && [ "$of_views$of_held" = 00 ]; then
        echo "DEPTH=$depth gives the depth of 0 of $(wc -w <<<"$views") views. Name its files VIEW.exr, VIEW.png, VIEW.pfm, VIEW.tif or VIEW.tiff, where VIEW is one of:$(cut -c1-200 <<<"$views"). It has: $(ls "$depth" | sed -n 1,5p | tr '\n' ' ')" >&2
        exit 2
    fi
    echo "DEPTH=$depth gives the depth of $of_views of $(wc -w <<<"$views") views."
    [ -z "$of_none" ] || echo "warning: DEPTH=$depth has files that belong to no view:$of_none; $O/views/views.mk lists the views." >&2
}

# views_and_rounds LAST: of commands, one a line, "VIEW ROUND" of those that make depth; LAST: the last round
views_and_rounds()
{
    awk -v last="$1" '
        {
            view = out = ""
            for (i = 2; i < NF; i++) { if ($i == "--view") view = $(i + 1); if ($i == "--out") out = $(i + 1) }
            if (view == "") next
            if (out ~ /\/depth\/model\//) print view, last ? last : 1
            else print view, match(out, /\/round[0-9]+\//) ? substr(out, RSTART + 6, RLENGTH - 7) : last
        }'
}
last_round() { sed -n 's/^rounds = //p' "$O/slice/segment_depth.cfg"; }
# ask_depth LIST WIDE: what segment_depth says of the views and rounds in LIST, WIDE at a time; 0: on a cluster
ask_depth()
{
    "$bin/segment_depth" --config "$O/slice/segment_depth.cfg" --threads $(($2 ? cores / $2 : 1)) --views "$O/views" \
        --estimate "$1" --jobs "$2"
}
estimate_segment_depth()
{
    views_and_rounds "$(last_round)" >"$work/pieces.list"
    ask_depth "$work/pieces.list" 0
}
# announce_depth LAST: time and memory of what is stale in all rounds up to LAST
announce_depth()
{
    local list=$work/depth.list wide
    # where this fails, making it will fail and say why
    graph -n -s depth 2>/dev/null | views_and_rounds "$1" >"$list" || return 0
    [ -s "$list" ] || return 0
    wide=$(cut -d' ' -f2 "$list" | sort | uniq -c | awk '$1 > n { n = $1 } END { print n }')
    wide=$((wide < max_jobs ? wide : max_jobs))
    [ "$jobs" != slurm ] || wide=0
    ask_depth "$list" "$wide" 2>"$work/words" | sed '/^estimate /d' >&2 || cat "$work/words" >&2
    [ "$1" -lt 2 ] || echo "depth: it takes less if some views need no estimate in the third round or later." >&2
}

# report_rounds LAST: how many views each round estimated; the others were carried over
report_rounds()
{
    local round folder views counts=''
    views=$(sed 's/^VIEWS :=//' "$O/views/views.mk")
    for round in $(seq 0 "$1"); do
        folder=$O/depth/round$round
        [ "$round" != "$1" ] || folder=$O/depth
        # shellcheck disable=SC2086,SC2016 # a list of views
        counts+=", $(printf "$folder/%s.round\n" $views | xargs -d '\n' cat | grep -cx 'estimated yes' || true)"
    done
    echo "depth: views estimated in each round: ${counts#, }, of $(wc -w <<<"$views")."
}

run_depth()
{
    local last round
    report_given_depth
    last=$(last_round)
    announce_depth "$last"
    # rounds in which no view needs an estimate only copy
    for round in $(seq 0 "$last"); do farm segment_depth "depth-round$round"; done
    one depth
    [ ! -s "$work/depth.list" ] || report_rounds "$last"
}
