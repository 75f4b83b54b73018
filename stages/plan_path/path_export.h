/* path_export.h - export of a camera move to other programs: transforms.json, and blender.py for Blender.
 *
 * Both have the same frames: world_from_cam with OpenGL's camera axes (x right, y up, z back), in the scene's world and
 * units; focal lengths and principal point in px, with (0, 0) at the top left corner of the picture. docs/formats.md
 * lists the fields. */
#ifndef REMODEL_PATH_EXPORT_H
#define REMODEL_PATH_EXPORT_H

#include "common/capture/camera_path.h"

/* Writes folder/blender.py, then folder/transforms.json, each whole or not at all. prov may be NULL. ST_DATA: the path
 * has no frames, a value that is not finite, or a name that is not UTF-8. */
enum status path_export_write(const struct camera_path *p, const char *folder, const struct provenance *prov,
                              struct err *err);

#endif
