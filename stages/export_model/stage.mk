# export_model: the model and its edits with their texture, for other programs.
FOLLOWS.export_model := bake_vita
READS.export_model := a model, its plan and axes, texture.txt, the VITA
WRITES.export_model := model/export/, remodel/E/export/: model.ifc, ... (a file a format), pageN.png
LIBS.export_model := -ljansson
HELP.exports := the model and its edits with their texture, for other programs
