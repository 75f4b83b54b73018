# encode_video: videos from frames.
FOLLOWS.encode_video := morph_views pan_scan render_views
READS.encode_video := frames (runs ffmpeg)
HELP.video := + the video
SETTINGS.encode_video := FILM

## FILM="WORDS": further formats of films: av1, prores, and of high dynamic range hlg and pq (docs/films.md)
