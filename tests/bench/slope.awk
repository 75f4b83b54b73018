# slope.awk TABLE - prints slopes of log y over log of each column of `over`, by least squares, for every value of the
# columns `line`.
/^#/ { next }
!width { width = NF; for (i = 1; i <= NF; i++) column[$i] = i; lines = split(line, keys, " "); overs = split(over, xs, " "); next }
$(column[y]) > 0 {
    key = ""
    for (i = 1; i <= lines; i++) key = key (i > 1 ? " " : "") $(column[keys[i]])
    if (!(key in known)) { known[key] = 1; order[++count] = key }
    for (i = 1; i <= overs; i++) {
        u = log($(column[xs[i]])); v = log($(column[y]))
        n[key, i]++; su[key, i] += u; sv[key, i] += v; suu[key, i] += u * u; suv[key, i] += u * v
    }
}
END {
    for (k = 1; k <= count; k++)
        for (i = 1; i <= overs; i++) {
            d = n[order[k], i] * suu[order[k], i] - su[order[k], i] ^ 2
            if (d > 0) printf "slope of log %s over log %s, %s: %.3f\n", y, xs[i], order[k], (n[order[k], i] * suv[order[k], i] - su[order[k], i] * sv[order[k], i]) / d
        }
}
