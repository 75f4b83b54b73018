# export_model: the model and its edits with their texture, for other programs.
FOLLOWS.export_model := bake_vita
READS.export_model := a model, its plan and axes, texture.txt, the VITA
WRITES.export_model := model/export/, remodel/E/export/: model.obj, model.mtl, model.glb, model.ifc, pageN.png
LIBS.export_model := -ljansson
HELP.exports := the model and its edits with their texture as OBJ, glTF 2.0 and IFC4
