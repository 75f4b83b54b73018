# summary.awk SETTINGS RAW - prints the table of a bench: settings, seconds with their range, ratio, peak memory, error,
# unit, counts. Fields of RAW: build, repeat, row, name, value. On an error, prints a line that begins with "!" and
# exits with 1.
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
function fault(message) { print "!" name ": " message; failed = 1; exit 1 }
FNR == NR {
    settings[FNR - 1] = $0; rows = FNR - 1
    for (i = 1; i <= NF; i++) { if (FNR == 1) { column[$i] = i; width = NF } else cell[FNR - 1, i] = $i }
    if (NF != width) fault("setting " FNR - 1 " has " NF " values, wanted " width)
    next
}
{
    if ($2 > repeats) repeats = $2
    if ($4 == "cpu_seconds") next # too coarse
    if ($4 == "seconds" || $4 == "peak_mib" || $4 in is_timed) { timed[$4, $3, $2] = $5 + 0; next }
    if (!($4 in counts)) { counts[$4] = 1; if ($4 != "error" && $4 != "unit") order[++orders] = $4 }
    if (($3, $4) in value && value[$3, $4] != $5)
        fault("setting '" settings[$3] "': " $4 " was " value[$3, $4] " and is " $5 " in repeat " $2 "; values other than times must repeat")
    value[$3, $4] = $5
}
END {
    if (failed) exit 1
    if (rate != "" && !(rate in counts)) fault("no sample prints " rate ", the count of the rate")
    head = settings[0] "\tseconds\tseconds_least\tseconds_most\tratio\tpeak_mib"
    for (k = 1; k <= also; k++) head = head OFS too[k]
    head = head "\terror\tunit"
    for (k = 1; k <= orders; k++) head = head OFS order[k]
    if (rate != "") head = head OFS rate "_per_s"
    print head
    wanted = split(match_on, on, " ")
    for (i = 1; i <= rows; i++) {
        against = 0
        for (j = 1; baseline != "" && j <= rows && !against; j++) {
            if (cell[j, 1] != baseline) continue
            against = j
            for (k = 1; k <= wanted; k++) if (cell[i, column[on[k]]] != cell[j, column[on[k]]]) against = 0
        }
        least = 1e300; most = 0
        for (r = 1; r <= repeats; r++) {
            s[r] = timed["seconds", i, r]; m[r] = timed["peak_mib", i, r]
            if (s[r] < least) least = s[r]
            if (s[r] > most) most = s[r]
            if (against) q[r] = timed["seconds", against, r] > 0 ? s[r] / timed["seconds", against, r] : 0
        }
        seconds = median(s, repeats)
        text = settings[i] OFS sprintf("%.6g\t%.6g\t%.6g\t%s\t%.4g", seconds, least, most, against ? sprintf("%.3f", median(q, repeats)) : "-", median(m, repeats))
        for (k = 1; k <= also; k++) {
            has = 1
            for (r = 1; r <= repeats; r++) { has = has && ((too[k], i, r) in timed); if (has) s[r] = timed[too[k], i, r] }
            text = text OFS (has ? sprintf("%.4g", median(s, repeats)) : "-")
        }
        text = text OFS (((i, "error") in value) ? value[i, "error"] : "-") OFS (((i, "unit") in value) ? value[i, "unit"] : "-")
        for (k = 1; k <= orders; k++) text = text OFS (((i, order[k]) in value) ? value[i, order[k]] : "-")
        if (rate != "") text = text OFS sprintf("%.4g", seconds > 0 ? value[i, rate] / seconds : 0)
        print text
    }
}
