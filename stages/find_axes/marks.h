/* marks.h - what a user marked in photographs: scenes/NAME/scale.txt and scenes/NAME/axes_fix.txt.
 *
 * Both files mark points of the room, by one of these:
 *   mark NAME VIEW X Y            in two views or more, a line each: where their rays meet
 *   mark NAME VIEW X Y floor      in one view: on the floor
 *   mark NAME VIEW X Y surface    in one view: on the surface that the fused points show there
 * scale.txt also says how far apart two of them are, once or more often:
 *   length NAME NAME METRES
 * axes_fix.txt also marks corners of the floor, points on the edges that end there, and the thickness of walls:
 *   corner NAME VIEW X Y          where two walls meet the floor; seen in a second view it says how high the floor is
 *   edge NAME VIEW X Y            on a line from that corner, of a wall and the floor or of the two walls, in a view of it
 *   thickness NAME NAME           marks on both sides of a wall's end
 * VIEW is a photo's id or a view's name. Pixels are those of the photograph as it is stored, x to the right and y down,
 * (0, 0) its upper left corner. */
#ifndef REMODEL_MARKS_H
#define REMODEL_MARKS_H

#include "common/capture/lens_list.h"
#include "common/capture/photo_camera.h"
#include "common/capture/point_cloud.h"

enum mark_kind { MARK_POINT, MARK_LENGTH, MARK_CORNER, MARK_EDGE, MARK_THICKNESS };
enum mark_on { MARK_IN_VIEWS, MARK_ON_FLOOR, MARK_ON_SURFACE };

struct mark {
    enum mark_kind kind;
    enum mark_on on;
    int line;
    char *name, *view; /* owned; of lengths and thicknesses the two names */
    double x, y;
    double metres;
};

struct mark_list {
    struct mark *marks;
    int count;
    char *path; /* owned: to name */
};

enum mark_file { MARKS_SCALE, MARKS_FIX };

/* ST_DATA with file and line: another line than those of this file, a name that is not marked, a point marked in one
 * view that is on nothing, twice in one view or in several ways, a length of 0, an edge in a view without its corner. */
enum status mark_list_read(struct mark_list *list, const char *path, enum mark_file file, struct err *err);
void mark_list_release(struct mark_list *list);

struct mark_scene { /* what places marks */
    const struct camera_set *set;
    const struct lens_list *lenses;
    const struct point_cloud *cloud;
    struct vec3 up; /* unit, world */
    double floor;   /* of a point p on it: p . up */
};

/* Unit direction of what a mark's pixel shows, and its camera. ST_DATA with file and line: no such view, no such pixel. */
enum status mark_ray(const struct mark *m, const struct mark_list *list, const struct mark_scene *scene,
                     struct photo_camera *camera, struct vec3 *ray, struct err *err);
/* The point of that kind and name in the world. ST_DATA with file and line: rays that do not meet, or at too small an
 * angle; that miss the floor, or find no surface. */
enum status mark_locate(struct vec3 *world, enum mark_kind kind, const char *name, const struct mark_list *list,
                        const struct mark_scene *scene, struct err *err);
/* How far the marked pixels' standard error, click px each, moves what measure() says: a standard error. measure returns
 * false where it cannot say. The list is changed meanwhile. */
double mark_error(struct mark_list *list, double click, bool (*measure)(void *ctx, double *value), void *ctx);

#endif
