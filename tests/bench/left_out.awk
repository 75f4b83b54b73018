# left_out.awk ROWS - chooses a setting for each scene on the other scenes (leave one scene out), and prints the result.
#
# Fields of ROWS, separated by tabs: scene, setting, value; a value of - is missing. `better` is lower or higher, `format`
# that of values (%.2f). The setting named `default` is the one that would be used without a choice. For each scene:
#   default      its value with the default setting
#   left_out     with the setting of the best mean over all other scenes: what a choice is worth on a new scene
#   best         with the setting that is best on this very scene: what a bench reports if it tunes on what it reports
#   change, best_change   of left_out and best, against the default
# Of equal settings the default wins, then the one listed first. Only a setting with a value in every scene can be chosen.
# Without other scenes the default is chosen. A scene without a value of the default takes no part. Rows of SCENE/PART, where
# SCENE has rows too, are parts of that scene: they are reported with its choice, and count neither in choices nor in the mean.
BEGIN { FS = OFS = "\t"; if (format == "") format = "%.2f"; signed_format = format; sub(/%/, "%+", signed_format); same = 1e-9 }
/^#/ { next }
{
    if (!($1 in scenes)) { scenes[$1] = 1; scene_order[++scene_count] = $1 }
    if (!($2 in settings)) { settings[$2] = 1; setting_order[++setting_count] = $2 }
    if ($3 != "-" && $3 != "") value[$1, $2] = $3 + 0
}
# whether a is better than b by more than rounding
function wins(a, b,    d) { d = better == "higher" ? a - b : b - a; return d > same * ((b < 0 ? -b : b) + same) }
# mean of a setting over all scenes but `but`; sets `usable` to whether it has a value everywhere
function mean_of(setting, but,    i, sum, n)
{
    usable = (but, setting) in value
    for (i = 1; i <= scene_count; i++) {
        if (scene_order[i] == but || scene_order[i] in skipped || scene_order[i] in whole) continue
        if ((scene_order[i], setting) in value) { sum += value[scene_order[i], setting]; n++ } else usable = 0
    }
    usable = usable && n
    return n ? sum / n : 0
}
function chosen_for(scene,    i, chosen, least, mean)
{
    chosen = "default"
    least = mean_of(chosen, scene)
    if (!usable) return chosen
    for (i = 1; i <= setting_count; i++) {
        mean = mean_of(setting_order[i], scene)
        if (usable && wins(mean, least)) { chosen = setting_order[i]; least = mean }
    }
    return chosen
}
function best_for(scene,    i, best)
{
    best = "default"
    for (i = 1; i <= setting_count; i++)
        if ((scene, setting_order[i]) in value && wins(value[scene, setting_order[i]], value[scene, best])) best = setting_order[i]
    return best
}
function number(v) { return sprintf(format, v) }
function signed(v,    text) { text = sprintf(signed_format, v); if (text ~ /^[-+]0(\.0*)?$/) text = substr(text, 2); return text }
function report(name, a, b, c, chosen, best) { print name, number(a), number(b), signed(b - a), number(c), signed(c - a), chosen, best }
END {
    for (i = 1; i <= scene_count; i++) {
        name = scene_order[i]
        at = index(name, "/")
        if (at && substr(name, 1, at - 1) in scenes) whole[name] = substr(name, 1, at - 1)
        if (!((name, "default") in value)) { skipped[name] = 1; print "# " name " takes no part: the default has no value there" }
    }
    for (i = 1; i <= scene_count; i++) if (!(scene_order[i] in skipped) && !(scene_order[i] in whole)) count++
    if (count == 1) print "# only one scene: there is none to choose on, so the default is chosen"
    print "scene", "default", "left_out", "change", "best", "best_change", "chosen", "best_setting"
    for (i = 1; i <= scene_count; i++) {
        name = scene_order[i]
        if (name in skipped || name in whole) continue
        chosen = chosen_for(name); best = best_for(name)
        report(name, value[name, "default"], value[name, chosen], value[name, best], chosen, best)
        sum += value[name, "default"]; sum_out += value[name, chosen]; sum_best += value[name, best]
        for (k = 1; k <= scene_count; k++) {
            part = scene_order[k]
            if (!(part in whole) || whole[part] != name || part in skipped || !((part, chosen) in value)) continue
            best = best_for(part)
            report(part, value[part, "default"], value[part, chosen], value[part, best], chosen, best)
        }
    }
    if (count) report("mean", sum / count, sum_out / count, sum_best / count, "-", "-")
}
