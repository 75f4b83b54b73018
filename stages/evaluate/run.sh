# run.sh - what the products are worth. Sourced by common/run/run_scene.sh.

# after a described scene was photographed, which makes its truth too
prepare_evaluate()
{
    [ -z "${REMODEL_TRUTH-}" ] || [ -d "$REMODEL_TRUTH" ] ||
        usage "TRUTH=$REMODEL_TRUTH is not a folder. Give the folder that holds cameras.txt and images.txt of the truth."
    [ -z "${REMODEL_RENDERED-}" ] || [ -d "$REMODEL_RENDERED" ] ||
        usage "RENDERED=$REMODEL_RENDERED is not a folder. Give the folder that holds novel, edited-E, relit-E or shell with rendered pictures."
}

run_evaluate()
{
    case $O in *+holdout*) farm_frames render_views heldout ;; esac
    one evaluate
    [ "$goal" != evaluate ] || report_metrics
}

report_metrics()
{
    grep '^# skipped' "$O/metrics.tsv" | sed 's/^# /  /' || true
    awk -F'\t' '!/^#/ { printf "  %-36s %12.6g %s\n", $1, $2, $3 == "1" ? "" : $3 }' "$O/metrics.tsv"
    echo "table  $O/metrics.tsv"
}
