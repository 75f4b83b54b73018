# run.sh - `make doctor` looks at the machine, too. Sourced by common/run/run_scene.sh.

end_judge_photos()
{
    [ "$goal" = doctor ] || return 0
    echo "list   $S/judgement.txt"
    common/run/doctor.sh
}
