# run.sh - what is not known before moves are planned, and films that seem to stand still. Sourced by common/run/run_scene.sh.

unknown_plan_path()
{
    ! grep -q ' plan_path ' "$work/commands" || echo "not known before plan_path has run: how many frames the films have"
}

# a film that moves through less than a degree, and shows less parallax than 2 % of its area, is nothing that anyone wants
end_plan_path()
{
    local path film
    case $goal in report | video) ;; *) return 0 ;; esac
    for path in "$O"/parallax/*/path.txt; do
        [ -e "$path" ] || continue
        film=${path%/path.txt}
        awk -v film="${film##*/}" '
            $1 == "score" && $2 == "angle" { angle = $3; known = 1 }
            $1 == "score" && $2 == "parallax" { parallax = $3 }
            END { if (known && angle < 1 && parallax < 0.02) printf "warning: film %s: its camera moves through only %.2g degrees and shows hardly any parallax. Depth is missing or poor, or the photos are from one place; see the warnings above.\n", film, angle }
        ' "$path" >&2
    done
}
