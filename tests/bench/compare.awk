# compare.awk SETTINGS RAW - compares two revisions: ratios new / old of the samples of each repeat, and changed values.
BEGIN { FS = OFS = "\t"; repeats = 0; also = split(timed_too, too, " "); for (i = 1; i <= also; i++) is_timed[too[i]] = 1 }
function median(list, n,    i, j, t)
{
    for (i = 2; i <= n; i++) { # insertion sort: there are few
        t = list[i]
        for (j = i - 1; j >= 1 && list[j] > t; j--) list[j + 1] = list[j]
        list[j + 1] = t
    }
    return n % 2 ? list[(n + 1) / 2] : (list[n / 2] + list[n / 2 + 1]) / 2
}
FNR == NR { settings[FNR - 1] = $0; rows = FNR - 1; next }
{
    if ($2 > repeats) repeats = $2
    if ($4 == "seconds" || $4 == "peak_mib") { timed[$4, $1, $3, $2] = $5 + 0; next }
    if ($4 == "cpu_seconds" || $4 in is_timed) next
    value[$1, $3, $4] = $5
    if (!($4 in seen)) { seen[$4] = 1; names[++n] = $4 }
}
END {
    print "# bench " name ": new over " old ", medians of " repeats " alternating pairs; below 1: the new one is faster"
    print settings[0] "\tseconds_old\tseconds_new\tratio\tratio_least\tratio_most\tpeak_mib_old\tpeak_mib_new\tchanged"
    for (i = 1; i <= rows; i++) {
        least = 1e300; most = 0
        for (r = 1; r <= repeats; r++) {
            a[r] = timed["seconds", 0, i, r]; b[r] = timed["seconds", 1, i, r]
            q[r] = b[r] > 0 ? a[r] / b[r] : 0
            if (q[r] < least) least = q[r]
            if (q[r] > most) most = q[r]
            ma[r] = timed["peak_mib", 0, i, r]; mb[r] = timed["peak_mib", 1, i, r]
        }
        changed = ""
        for (k = 1; k <= n; k++)
            if (value[0, i, names[k]] != value[1, i, names[k]])
                changed = changed (changed == "" ? "" : ", ") names[k] " " value[1, i, names[k]] " -> " value[0, i, names[k]]
        ratio = median(q, repeats)
        series = settings[i]; sub(/\t.*/, "", series)
        if (!(series in ratios)) order[++kinds] = series
        if (ratio > 0) { logs[series] += log(ratio); ratios[series]++ }
        printf "%s\t%.6g\t%.6g\t%.3f\t%.3f\t%.3f\t%.4g\t%.4g\t%s\n", settings[i], median(b, repeats), median(a, repeats), ratio, least, most,
            median(mb, repeats), median(ma, repeats), changed == "" ? "-" : changed
    }
    for (k = 1; k <= kinds; k++)
        if (ratios[order[k]]) printf "# geometric mean of the ratios, %s: %.3f\n", order[k], exp(logs[order[k]] / ratios[order[k]])
}
