/* view_records.h - a view's faces as files: O/ids/VIEW.exr and VIEW.txt. */
#ifndef REMODEL_VIEW_RECORDS_H
#define REMODEL_VIEW_RECORDS_H

#include "stages/trace_ids/view_faces.h"

/* Writes VIEW.txt (path with .txt for .exr), then the EXR. camera: in the model's frame; scale: model units per scene
 * unit. */
enum status view_records_write(const struct view_faces *f, const struct solid_mesh *mesh, const struct view *camera,
                               double scale, const char *path, const struct provenance *prov, struct err *err);

#endif
