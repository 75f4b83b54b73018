/* place_marks.h - places that were marked in photographs. */
#ifndef REMODEL_PLACE_MARKS_H
#define REMODEL_PLACE_MARKS_H

#include "common/light/model_rays.h"
#include "common/model/model_axes.h"
#include "common/model/model_plan.h"
#include "stages/light_levels/place_list.h"

/* Where a ray first comes to a height above the floor of a room, inside the room's outline. False: nowhere. */
bool place_mark_find(struct vec3 *at, const struct model_plan *plan, struct vec3 from, struct vec3 ray, double height);

/* What marks are resolved with. */
struct place_marks {
    const char *views; /* folder of the cameras */
    const struct model_axes *axes;
    const struct model_plan *plan;
    const struct model_rays *model; /* a mark must be in front of its faces */
    double work_plane;              /* height of places without one, model units */
};

/* Sets the place of each mark. ST_DATA with file and line: an unknown photo, a pixel outside it, a ray that comes to no
 * floor, or that a face of the model stops before. */
enum status place_marks_resolve(struct place_list *l, const struct place_marks *with, struct provenance *prov,
                                struct err *err);

#endif
