# run.sh - `make doctor` looks at the machine, too, and says what a film will take. Sourced by common/run/run_scene.sh.

# setting STAGE NAME: a parameter of this run
setting() { sed -n "s/^$2 = //p" "$O/slice/$1.cfg"; }

# foresee_film: between which times a film of the photos lies, and what memory and disk it takes. Views are photos of at most
# max_megapixels. Depth has the costs of `make plan`, with few neighbours and with all; the others were measured on kermit, and
# lie within a factor of two of that on sceaux
foresee_film()
{
    local max_megapixels low high mib bytes
    max_megapixels=$(setting sfm_import max_megapixels)
    awk -v most="$max_megapixels" '$1 == "photo" {
        pixels = $3 * $4 / 1e6; s = most > 0 && pixels > most ? sqrt(most / pixels) : 1
        printf "%d %d\n", $3 * s + 0.5, $4 * s + 0.5 }' "$S/judgement.txt" >"$work/foresee.list"
    [ "$(wc -l <"$work/foresee.list")" -gt 1 ] || return 0
    read -r _ low high mib bytes <<<"$("$bin/segment_depth" --config "$O/slice/segment_depth.cfg" --foresee "$work/foresee.list" 2>/dev/null)"
    [ -n "$bytes" ] || return 0
    awk -v low="$low" -v high="$high" -v mib="$mib" -v bytes="$bytes" -v cores="$cores" -v jobs="$max_jobs" -v again="$again" \
        -v frames="$(awk -v s="$(setting plan_path seconds)" -v f="$(setting plan_path fps)" 'BEGIN { print s * f }')" \
        -v side="$(setting plan_path max_side)" -v renderer="$(setting render_views renderer)" \
        -v free_mib="$(awk '/^MemAvailable:/ { print $2 / 1024 }' /proc/meminfo)" -v free_disk="$(df -Pk "$S" | awk 'NR == 2 { print $4 * 1024 }')" '
        function length_of(s) { return s < 100 ? sprintf("%d s", s) : s < 6000 ? sprintf("%d min", s / 60 + 0.5) : sprintf("%.2g h", s / 3600) }
        function size_of(m) { return m < 1000 ? sprintf("%d MiB", m) : sprintf("%.2g GiB", m / 1024) }
        FILENAME ~ /judgement/ { if ($1 == "photo") { photos++; p = $3 * $4 / 1e6; taken += p; if (p > largest) largest = p }; next }
        {
            views += $1 * $2 / 1e6
            long = $1 > $2 ? $1 : $2; s = side > 0 && long > side ? side / long : 1
            if ($1 * $2 * s * s / 1e6 > frame) frame = $1 * $2 * s * s / 1e6
        }
        END {
            # core-seconds: reading, matching and poses; the move; the frames
            low += 1.5 * photos + 2.5 * taken + 30 + (renderer == "offline" ? 0.8 : 0.25) * frames * frame
            high += 3 * photos + 5 * taken + 100 + (renderer == "offline" ? 2 : 0.6) * frames * frame
            memory = mib * (jobs < photos ? jobs : photos)
            if (40 + 65 * views > memory) memory = 40 + 65 * views
            if (25 * largest * jobs > memory) memory = 25 * largest * jobs
            disk = (bytes + 6e6 * views + 8e6 * frames * frame) / 2^20
            from = length_of(0.8 * low / cores); to = length_of(1.3 * high / cores)
            say = sprintf("a film of these %d photos takes %s on %d core%s, %s of memory and %s of disk",
                photos, from == to ? "about " to : "about " from " to " to, cores, cores == 1 ? "" : "s", size_of(memory), size_of(disk))
            if (memory > free_mib) print "note  " say ", but " size_of(free_mib) " of memory are free. Give -j1, or lower [sfm_import] max_megapixels"
            else if (disk * 2^20 > free_disk) print "note  " say ", but " size_of(free_disk / 2^20) " of disk are free"
            else print "ok    " say
            print "ok    make plan " again " says more, once make sfm " again " has found the cameras"
        }' "$S/judgement.txt" "$work/foresee.list"
}

end_judge_photos()
{
    [ "$goal" = doctor ] || return 0
    if [ -e "$S/judgement.txt" ]; then
        echo "list   $S/judgement.txt"
        foresee_film
    else
        echo "note  the cameras are given, so the photos were not compared with each other"
    fi
    common/run/doctor.sh
}
