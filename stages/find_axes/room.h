/* room.h - a room's axes, floor, ceiling, scale and extent, from oriented points, cameras and what a user marked. */
#ifndef REMODEL_ROOM_H
#define REMODEL_ROOM_H

#include "common/model/model_axes.h"
#include "stages/find_axes/correct.h"
#include "stages/find_axes/heights.h"
#include "stages/find_axes/marks.h"

struct room_inputs {
    const struct camera_set *set;
    const struct lens_list *lenses;
    const struct vec3 *ups; /* of each view, in its camera's axes */
    const struct point_cloud *cloud;
    struct mark_list *scale, *fix; /* NULL: none; changed meanwhile, not in the end */
};

struct room {
    struct model_axes axes;
    double least[2], most[2]; /* of the outermost walls that look inwards, x and y, model units */
    int central;              /* view under whose camera the origin lies */
    /* how it was found */
    double part[3]; /* of normals along x, y, z */
    double leaning; /* degrees between up and the mean camera's up */
    struct correction fix;
    double corner_height;        /* of marked corners, like those of levels; 0: none is seen in two views */
    bool floor_marked;           /* the floor is where they say, since what was found contradicts them */
    struct level floor, ceiling; /* in scene units, from the central camera's height */
};

/* Model frame: z up; x the wall direction nearest to what is right in the central camera's picture; the origin on the
 * floor straight below that camera. ST_DATA: no axes, no floor, or marks that cannot be used. */
enum status find_room(struct room *room, const struct room_inputs *in, const struct axes_params *params,
                      struct err *err);

#endif
