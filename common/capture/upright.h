/* upright.h - which way up the photographs are, in the cameras of their views.
 *
 * Pictures stay as they are stored; EXIF orientation only tells where their upper side is. Directions are of unit
 * length, in a camera's axes (x right, y down, z forward): (0, -1, 0) is a picture that is stored upright. */
#ifndef REMODEL_UPRIGHT_H
#define REMODEL_UPRIGHT_H

#include "common/base/provenance.h"
#include "common/capture/camera_set.h"

/* Where a photo's upright direction points in its camera, by EXIF orientation (1..8; anything else is 1). */
struct vec3 upright_from_orientation(int orientation);

/* The same in each view's camera: ups[set->view_count]. views: the folder of lenses.txt; records: of the photos'
 * ID.txt. What was read becomes inputs of prov. ST_DATA: lenses.txt lacks a view of the set. */
enum status upright_read(struct vec3 *ups, const struct camera_set *set, const char *views, const char *records,
                         struct provenance *prov, struct err *err);

#endif
