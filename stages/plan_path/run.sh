# run.sh - what is not known before moves are planned. Sourced by common/run/run_scene.sh.

unknown_plan_path()
{
    ! grep -q ' plan_path ' "$work/commands" || echo "not known before plan_path has run: how many frames the films have"
}
