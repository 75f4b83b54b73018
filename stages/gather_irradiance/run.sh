# run.sh - irradiance. Sourced by common/run/run_scene.sh.

check_gather_irradiance()
{
    [ -z "${REMODEL_GATHER_POINTS-}" ] || [ -f "$REMODEL_GATHER_POINTS" ] ||
        usage "GATHER_POINTS=$REMODEL_GATHER_POINTS is no file. Give a file with a line X Y Z NX NY NZ for each point."
}

# the truth's points are in the frame of the views when evaluate has aligned the two
run_irradiance()
{
    if [ -z "${REMODEL_GATHER_POINTS-}" ] && [ -n "${REMODEL_TRUTH-}" ] && [ -e "$REMODEL_TRUTH/irradiance.txt" ] &&
        [ ! -e "$O/evaluate/irradiance_points.txt" ]; then
        one evaluate
        stages/gather_irradiance/look.sh "$bin" "$S" "$O"
    fi
    [ "$goal" != irradiance ] || [ -n "${REMODEL_GATHER_POINTS-}$REMODEL_GATHER_VIEWS" ] || [ -e "$O/evaluate/irradiance_points.txt" ] ||
        usage "There is nothing to gather: give GATHER_POINTS=FILE, GATHER_VIEWS=\"V W\", or a TRUTH that has an irradiance.txt."
    one irradiance
    [ "$goal" != irradiance ] || [ ! -e "$O/relight/irradiance.txt" ] || echo "points  $O/relight/irradiance.txt"
}
