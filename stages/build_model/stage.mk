# build_model: solid models of rooms, by a script and its edits.
FOLLOWS.build_model := find_axes suggest_model
READS.build_model := scenes/NAME/model.txt, edits/E.txt, objects.txt and the meshes of objects, axes.txt, cameras, points.ply; the photos for overlays
SETTINGS.build_model := EDIT DRAW
HELP.model := the solid model of scenes/SCENE/model.txt and of each edit in edits/, with pictures to check them
