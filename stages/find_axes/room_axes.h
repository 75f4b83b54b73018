/* room_axes.h - finds a room's axes, floor, ceiling, scale and extent from oriented points, cameras and the user's
 * marks. */
#ifndef REMODEL_ROOM_AXES_H
#define REMODEL_ROOM_AXES_H

#include "common/capture/room_frame.h"
#include "common/model/model_axes.h"
#include "stages/find_axes/correct.h"
#include "stages/find_axes/heights.h"
#include "stages/find_axes/marks.h"

struct room_inputs {
    const struct camera_set *set;
    const struct lens_list *lenses;
    const struct vec3 *ups; /* up direction of each view, in its camera's frame */
    const struct point_cloud *cloud;
    const struct room_frame *frame; /* what straight edges say; NULL: nothing */
    struct mark_list *scale, *fix;  /* NULL: none; changed during the call, then restored */
};

struct room {
    struct model_axes axes;
    double low[2], high[2]; /* extent in x and y, to the outermost walls that face inwards, model units */
    int central;            /* view under whose camera the origin lies */
    /* how it was found */
    enum axes_source { AXES_OF_LINES, AXES_OF_NORMALS, AXES_OF_MARKS } source;
    double part[3]; /* fractions of normals along x, y, z */
    double leaning; /* degrees between up and the mean camera's up */
    struct correction fix;
    double corner_height;               /* mean of the marked corners, as of levels; 0: none is marked in two views */
    bool floor_marked;                  /* the floor's height is theirs, because the points contradicted them */
    struct height_level floor, ceiling; /* in scene units, from the central camera's height */
};

/* Model frame: z up; x is the axis nearest to the right direction of the central camera's picture; the origin is on the
 * floor straight below that camera. ST_DATA: neither lines nor points nor marks give axes, or a floor; the text says
 * what to mark. Unusable marks. */
enum status room_find(struct room *room, const struct room_inputs *in, const struct axes_params *params,
                      struct err *err);

#endif
