# export_model: the model and its edits with their texture and furniture, for other programs.
FOLLOWS.export_model := bake_vita find_things
READS.export_model := a model, its plan and axes, texture.txt, objects.txt, the meshes of objects and IES files of lamps, the things, the VITA
LIBS.export_model := -ljansson
HELP.exports := the model and its edits with their texture and furniture, for other programs
