# run.sh - camera poses. Sourced by common/run/run_scene.sh.

run_sfm()
{
    one sfm
    report_changed_photos
}
