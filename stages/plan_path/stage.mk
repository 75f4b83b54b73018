# plan_path: a camera move, or a film of keys.
FOLLOWS.plan_path := sample_validity
READS.plan_path := validity.txt, parallax/views.txt, cameras, all layers, subjects.txt; or keyframes/FILM.txt and the moves that it chains; or the cameras of CAMERAS
LIBS.plan_path := -ljansson
HELP.path := + the camera move
