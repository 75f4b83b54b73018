/* marks.h - points that a user marked in photographs: scenes/NAME/scale.txt and scenes/NAME/axes_fix.txt.
 *
 * Both files mark points of the room, in one of four ways:
 *   mark NAME VIEW X Y            in two or more views, a line each: triangulated
 *   mark NAME VIEW X Y floor      in one view: on the floor
 *   mark NAME VIEW X Y surface    in one view: on the surface of the fused points
 *   mark NAME VIEW X Y above NAME in one view: straight above another point, as the head of a door is above its foot
 * scale.txt also has one or more distances between two points, or heights above the floor, of a point or the ceiling:
 *   length NAME NAME METRES
 *   height NAME|ceiling METRES
 * axes_fix.txt also has corners of the floor, points on the edges that end there, and the thickness of walls:
 *   corner NAME VIEW X Y          where two walls meet the floor; a second view of it gives the floor's height
 *   edge NAME VIEW X Y            on an edge from that corner, between a wall and the floor or between the two walls,
 *                                 in a view in which the corner is marked
 *   thickness NAME NAME           between marks on both sides of a wall's end
 * VIEW is a photo's id or a view's name. Pixels are those of the photograph as it is stored, x to the right and y down,
 * (0, 0) its upper left corner. */
#ifndef REMODEL_MARKS_H
#define REMODEL_MARKS_H

#include "common/capture/lens_list.h"
#include "common/capture/photo_camera.h"
#include "common/capture/point_cloud.h"

enum mark_kind { MARK_POINT, MARK_LENGTH, MARK_HEIGHT, MARK_CORNER, MARK_EDGE, MARK_THICKNESS };
enum mark_on { MARK_IN_VIEWS, MARK_ON_FLOOR, MARK_ON_SURFACE, MARK_ABOVE };

struct mark {
    enum mark_kind kind;
    enum mark_on on;
    int line;
    char *name, *view; /* owned; of lengths and thicknesses the two names; of heights "" is the view */
    char *foot;        /* MARK_ABOVE: the point that it is above; owned */
    double x, y;
    double metres;
};

struct mark_list {
    struct mark *marks;
    int count;
    char *path; /* owned; for errors */
};

enum mark_file { MARKS_SCALE, MARKS_FIX };

/* The caller releases the list, which a failure leaves empty. ST_DATA with file and line: a line that this file does
 * not have, a name without a mark, a point in one view only that is not on the floor or a surface, a point marked twice
 * in a view or in several ways, a point above itself or above one that is above another, a length of 0, an edge in a
 * view without its corner. */
enum status mark_list_read(struct mark_list *list, const char *path, enum mark_file file, struct provenance *prov,
                           struct err *err);
void mark_list_release(struct mark_list *list);

struct mark_scene { /* what positions of marks depend on */
    const struct camera_set *set;
    const struct lens_list *lenses;
    const struct point_cloud *cloud;
    struct vec3 up; /* unit, world */
    double floor;   /* p . up of its points p */
};

/* The unit direction through a mark's pixel, and its camera. ST_DATA with file and line: unknown view, bad pixel. */
enum status mark_ray(const struct mark *m, const struct mark_list *list, const struct mark_scene *scene,
                     struct photo_camera *camera, struct vec3 *ray, struct err *err);
/* Whether a height is that of the ceiling. */
bool mark_is_ceiling(const struct mark *m);
/* The position of a point in the world. ST_DATA with file and line: rays that do not meet, meet at too small an angle,
 * miss the floor, hit no surface, or do not pass above the foot. */
enum status mark_locate(struct vec3 *world, enum mark_kind kind, const char *name, const struct mark_list *list,
                        const struct mark_scene *scene, struct err *err);
/* Standard error of measure()'s value, from the standard error `click` (px) of each marked pixel. measure returns false
 * if there is no value. The list is changed during the call. */
double mark_error(struct mark_list *list, double click, bool (*measure)(void *ctx, double *value), void *ctx);

#endif
