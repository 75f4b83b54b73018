# plan_eyes: the two eyes of stereo films.
FOLLOWS.plan_eyes := plan_path
READS.plan_eyes := a film's path, parallax/views.txt, cameras, all layers; only for EYES
SETTINGS.plan_eyes := EYES
HELP.eyes := + the two eyes of its stereo films, for EYES

## EYES="WORDS": films for two eyes besides the usual one: side_by_side, top_bottom, anaglyph, vr180 (docs/films.md)
