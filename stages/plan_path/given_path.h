/* given_path.h - a film's cameras from a file of another program: transforms.json, or a COLMAP model as text.
 *
 * The world is the scene's, as in parallax/EFFECT/transforms.json, path/ and points/points.ply. */
#ifndef REMODEL_GIVEN_PATH_H
#define REMODEL_GIVEN_PATH_H

#include "common/capture/camera_path.h"

/* file: a JSON file, or a folder with cameras.txt and images.txt. Frames are in the order of the JSON file, of a model
 * in the order of their names, numbers by value; their times follow from fps. Odd sizes lose their last row or column.
 * Frames of transforms.json may have `aperture` and `focus`, scene units. set: the scene's views and points. ST_DATA
 * names the file and the frame: no cameras, a lens that is no pinhole, sizes that differ, a film that shows none of the
 * scene's points. */
enum status given_path_read(struct camera_path *path, const char *file, const char *name, double fps,
                            const struct camera_set *set, struct provenance *prov, struct err *err);

#endif
