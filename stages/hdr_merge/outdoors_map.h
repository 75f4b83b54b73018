/* outdoors_map.h - pictures of the outdoors by direction, in which features of different cameras look alike.
 *
 * A map has a column for each azimuth and a row for each elevation, `pitch` radians apart: column 0 begins at the
 * azimuth `left`, counted from the opening's direction to the right as seen from inside; row 0 at the elevation `top`.
 * Directions are in the frame of the room's model. */
#ifndef REMODEL_OUTDOORS_MAP_H
#define REMODEL_OUTDOORS_MAP_H

#include "common/capture/camera.h"
#include "common/capture/feature_list.h"
#include "common/capture/view_image.h"
#include "common/image/image.h"
#include "stages/hdr_merge/opening_sight.h"

struct outdoors_grid {
    struct vec3 out; /* unit, horizontal: azimuth 0 */
    double pitch, left, top;
    int width, height;
};

struct vec3 outdoors_map_direction(const struct outdoors_grid *g, double x, double y);

/* Features of a reference image of this pose; places are those of its map. lens: of the image. grid: `out` is set on
 * entry, the rest is chosen. ST_NOMEM. */
enum status outdoors_map_of_reference(struct feature_list *list, struct outdoors_grid *grid,
                                      const struct image *radiance, const struct camera *lens,
                                      const struct pose *cam_from_model, struct err *err);

/* How much of an opening a view in the model's frame shows: its solid angle, roughly, steradians. */
double outdoors_map_seen(const struct view *view, const struct opening_sight *sight);
/* Features of what a view shows through an opening, in a map of its own. *grid: out and pitch are set on entry. */
enum status outdoors_map_of_view(struct feature_list *list, struct outdoors_grid *grid,
                                 const struct view_planes *planes, const struct view *view,
                                 const struct opening_sight *sight, struct err *err);

#endif
