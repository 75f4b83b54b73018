# reach.awk TABLE - prints for every panel, line and value of `targets` the x from which on y is at most that: between two
# settings by interpolation of the logarithms. Of other lines also the ratio to the baseline's.
function key_of(names,    list, n, i, text)
{
    n = split(names, list, " ")
    for (i = 1; i <= n; i++) text = text (i > 1 ? " " : "") $(column[list[i]])
    return text
}
/^#/ { next }
!width { width = NF; for (i = 1; i <= NF; i++) column[$i] = i; next }
$(column[x]) > 0 && $(column[y]) > 0 {
    p = key_of(panel); l = key_of(line)
    if (!(p in panels)) { panels[p] = 1; panel_order[++panel_count] = p }
    if (!(l in lines)) { lines[l] = $1 == baseline; line_order[++line_count] = l }
    i = ++count[p, l]
    xs[p, l, i] = $(column[x]); ys[p, l, i] = $(column[y])
}
# sets at and how: "" exact, "less than " before the first point, "more than " the last one does not reach it
function reach(p, l, target,    n, i, k, t, swap)
{
    n = count[p, l]
    for (i = 2; i <= n; i++)
        for (k = i; k > 1 && xs[p, l, k] < xs[p, l, k - 1]; k--) {
            swap = xs[p, l, k]; xs[p, l, k] = xs[p, l, k - 1]; xs[p, l, k - 1] = swap
            swap = ys[p, l, k]; ys[p, l, k] = ys[p, l, k - 1]; ys[p, l, k - 1] = swap
        }
    for (i = n; i >= 1 && ys[p, l, i] <= target; i--) { }
    if (i == n) { how = "more than "; at = xs[p, l, n]; return }
    if (!i) { how = "less than "; at = xs[p, l, 1]; return }
    t = log(target / ys[p, l, i]) / log(ys[p, l, i + 1] / ys[p, l, i])
    how = ""; at = xs[p, l, i] * (xs[p, l, i + 1] / xs[p, l, i]) ^ t
}
function print_line(p, l, target,    text, own, own_how, b)
{
    reach(p, l, target); own = at; own_how = how
    text = sprintf("%s %s at %s%.3g %s", y, target, how, at, x)
    for (b in lines) {
        if (!lines[b] || b == l || !((p, b) in count)) continue
        reach(p, b, target)
        if (own_how == "more than " || how == "less than ") continue # would be no bound
        text = text sprintf(", %s%.3g of the %s", own_how != "" || how != "" ? "less than " : "", own / at, b)
    }
    print (p == "" ? "" : p ", ") l ": " text
}
END {
    n = split(targets, list, " ")
    for (i = 1; i <= panel_count; i++)
        for (k = 1; k <= n; k++)
            for (j = 1; j <= line_count; j++)
                if ((panel_order[i], line_order[j]) in count) print_line(panel_order[i], line_order[j], list[k])
}
