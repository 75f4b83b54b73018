# encode_video: videos from frames.
FOLLOWS.encode_video := morph_views pan_scan render_views
READS.encode_video := frames (runs ffmpeg)
WRITES.encode_video := parallax/EFFECT/video.mp4
HELP.video := + the video
