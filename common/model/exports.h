/* exports.h - the models for other programs, a row each (docs/adding-an-export.md): files in out/SCENE/model/export and
 * remodel/E/export, which export_model writes and the page links. */
#ifndef REMODEL_MODEL_EXPORTS_H
#define REMODEL_MODEL_EXPORTS_H

/* X(file, name, write): its name on the page; the function of export_model that writes it (writers.h). In the order of the
 * page. The first is written last: Make takes it for the whole. */
#define EXPORTS(X)                                     \
    X("model.ifc", "building model (IFC4)", write_ifc) \
    X("model.glb", "3D model (glTF)", write_gltf)      \
    X("model.obj", "3D model (OBJ)", write_obj)

#define EXPORT_ONE(file, name, write) +1
enum { EXPORT_COUNT = 0 EXPORTS(EXPORT_ONE) };

#endif
