/* exports.h - the models for other programs, a row each (docs/adding-an-export.md): files in out/SCENE/model/export and
 * remodel/E/export, which export_model writes and the page links. */
#ifndef REMODEL_PRODUCT_EXPORTS_H
#define REMODEL_PRODUCT_EXPORTS_H

/* X(format, file, name, write): its name on the page; the function of export_model that writes it (writers.h). In the
 * order of the page. The first is written last: Make takes it for the whole. */
#define EXPORTS(X)                                          \
    X(IFC, "model.ifc", "building model (IFC4)", write_ifc) \
    X(GLB, "model.glb", "3D model (glTF)", write_gltf)      \
    X(OBJ, "model.obj", "3D model (OBJ)", write_obj)

#define EXPORT_ID(format, file, name, write) EXPORT_##format,
enum export_format { EXPORTS(EXPORT_ID) EXPORT_COUNT };

#endif
