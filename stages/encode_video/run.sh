# run.sh - where the videos are. Sourced by common/run/run_scene.sh.

end_encode_video()
{
    local v
    case $goal in report | video | pan_scan | morph) ;; *) return 0 ;; esac
    for v in "$O"/parallax/*/video.mp4 "$O"/parallax/*/video-*.m* "$O"/parallax/*/pan_scan/video.mp4; do [ ! -e "$v" ] || echo "video  $v"; done
}
