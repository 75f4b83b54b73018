/* place.h - finds positions in the model from pixels of photographs: walls from the oriented points that are visible in
 * a rectangle, corners of openings and boxes from the rays through their pixels.
 *
 * A point is visible in a rectangle if it projects into it, faces the camera, and is not behind other points. Pixels
 * are those of the photograph as it is stored, mapped through its lens. */
#ifndef REMODEL_BUILD_MODEL_PLACE_H
#define REMODEL_BUILD_MODEL_PLACE_H

#include "common/capture/camera_set.h"
#include "common/capture/lens_list.h"
#include "common/capture/photo_camera.h"
#include "common/capture/point_cloud.h"
#include "common/model/model_axes.h"
#include "stages/build_model/place/model_params.h"
#include "stages/build_model/script/statement.h"

struct placed_point {
    float position[3], normal[3], weight; /* in the model's frame */
};

struct placer_photo {
    const char *id;             /* of the lens list */
    struct photo_camera camera; /* in the model's frame */
};

struct place_memory;

/* The cameras of views and their photographs. */
struct placer_views {
    const struct camera_set *set;
    const struct lens_list *lenses;
};

struct placer {
    const struct lens_list *lenses[2];
    struct placer_photo *photos; /* in order of id, those held out last; all views of a photo are one item */
    int photo_count;
    struct placed_point *points;
    size_t count;
    double window; /* of wall positions, model units */
    const struct model_params *params;
    struct place_memory *memory; /* NULL: what was placed is not kept */
};

/* Of walls that were placed, for a placer that builds scripts again and again; NULL: not enough memory. The caller
 * frees it. It knows no points: another placer needs another one. */
struct place_memory *place_memory_new(void);
void place_memory_free(struct place_memory *memory);

/* views[1]: those that were held out, in which places may be drawn too. points may be NULL: then walls cannot be placed
 * by rectangles. Keeps pointers to lenses and params. */
enum status place_init(struct placer *placer, const struct placer_views views[2], const struct model_axes *axes,
                       const struct point_cloud *points, const struct model_params *params, struct err *err);
void place_release(struct placer *placer);

struct placed_wall {
    double n[2], c;    /* in face: n p = c, n towards the camera */
    double ends[2][2]; /* intersections with the rays through the middles of the rectangle's left and right sides */
    double spread;     /* median distance of the points with the wall's normal */
    size_t points;     /* number of points within the window */
};

struct place_direction {  /* of a wall; without any of these: the axis for which most normals vote */
    const double *normal; /* the wall's own, which is kept */
    const double *along;  /* of either sign */
    bool is_free;         /* the direction that fits the points */
};

/* path and line: of the script, for errors. ST_DATA: unknown view, rectangle outside the photo, too few points, points
 * of another direction, points that are scattered. */
enum status place_wall(struct placed_wall *wall, const struct placer *placer, const struct script_place *place,
                       const struct place_direction *wanted, const char *path, int line, struct err *err);

/* The intersections of the plane n p = d with the rays through the rectangle's corners X0 Y0 and X1 Y1. ST_DATA as for
 * place_wall(), and where a ray misses the plane. */
enum status place_corners(struct vec3 corners[2], const struct placer *placer, const struct script_place *place,
                          struct vec3 n, double d, const char *path, int line, struct err *err);

#endif
