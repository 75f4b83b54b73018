# render_views: a film's frames, and the cameras of held-out photos.
FOLLOWS.render_views := segment_depth plan_path plan_eyes
READS.render_views := parallax/views.txt, all layers, the path, effects.txt
HELP.frames := + its frames
