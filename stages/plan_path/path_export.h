/* path_export.h - a camera move for other programs: transforms.json, and blender.py for Blender.
 *
 * Both hold the same frames: camera to world, axes x right, y up, z back (OpenGL's), the world being the scene's own,
 * in scene units; focal lengths and principal point in px of a picture whose top left corner is (0, 0). docs/formats.md
 * has the fields. */
#ifndef REMODEL_PATH_EXPORT_H
#define REMODEL_PATH_EXPORT_H

#include "common/capture/camera_path.h"

/* Writes folder/blender.py, then folder/transforms.json, each whole or not at all. prov may be NULL. ST_DATA: no frame,
 * a value of a frame that is not finite, a name that is not UTF-8. */
enum status path_export_write(const struct camera_path *p, const char *folder, const struct provenance *prov,
                              struct err *err);

#endif
