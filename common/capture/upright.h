/* upright.h - the upright direction of photographs in the cameras of their views.
 *
 * Pictures are never rotated; EXIF orientation only gives their upper side. Directions have length 1, in camera axes (x
 * right, y down, z forward): (0, -1, 0) for a picture that is stored upright. */
#ifndef REMODEL_UPRIGHT_H
#define REMODEL_UPRIGHT_H

#include "common/base/provenance.h"
#include "common/capture/camera_set.h"

/* The upright direction in the photo's camera, from EXIF orientation (1..8; other values count as 1). */
struct vec3 upright_from_orientation(int orientation);

/* The same in each view's camera: ups[set->view_count]. views: folder of lenses.txt; records: folder of the photos'
 * ID.txt. The files read are added to prov as inputs. ST_DATA: a view of the set is not in lenses.txt. */
enum status upright_read(struct vec3 *ups, const struct camera_set *set, const char *views, const char *records,
                         struct provenance *prov, struct err *err);

/* The mean of what is up in all photos, a unit vector in the world. ups: of upright_read(); NULL: all pictures are
 * stored upright. */
struct vec3 upright_mean(const struct camera_set *set, const struct vec3 *ups);

#endif
