# encode_video: videos from frames.
FOLLOWS.encode_video := morph_views pan_scan render_views
READS.encode_video := frames (runs ffmpeg)
HELP.video := + the video
