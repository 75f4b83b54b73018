/* place.h - from pixels of photographs to places of the model: walls by the oriented points that a rectangle shows,
 * corners of openings and boxes by the rays through their pixels.
 *
 * A rectangle shows the points that project into it, face the camera, and are not behind others. Pixels are those of
 * the photograph as it is stored, mapped through its lens. */
#ifndef REMODEL_BUILD_MODEL_PLACE_H
#define REMODEL_BUILD_MODEL_PLACE_H

#include "common/capture/camera_set.h"
#include "common/capture/lens_list.h"
#include "common/capture/photo_camera.h"
#include "common/capture/point_cloud.h"
#include "common/model/model_axes.h"
#include "stages/build_model/model_params.h"
#include "stages/build_model/script.h"

struct placed_point {
    float position[3], normal[3], weight; /* of the model */
};

struct placer_photo {
    const char *id;             /* of the lens list */
    struct photo_camera camera; /* its world is the model */
};

struct placer {
    const struct lens_list *lenses;
    struct placer_photo *photos; /* in order of id; views of one photo are one */
    int photo_count;
    struct placed_point *points;
    size_t count;
    double step; /* of the walls' positions, model units */
    const struct model_params *params;
};

/* points may be NULL: then no wall can be placed by a rectangle. Keeps pointers to lenses and params. */
enum status placer_init(struct placer *placer, const struct camera_set *set, const struct lens_list *lenses,
                        const struct model_axes *axes, const struct point_cloud *points,
                        const struct model_params *params, struct err *err);
void placer_release(struct placer *placer);

struct placed_wall {
    double n[2], c;    /* in face: n p = c, n towards the camera */
    double ends[2][2]; /* where the rays through the middles of the rectangle's left and right sides meet it */
    double spread;     /* of the points about it: their median distance */
    size_t points;     /* that it rests on */
};

/* normal: the wall's own, which is kept (adjust), or NULL. Without it the canonical axis by the majority of the
 * normals, or, if `angled`, the direction that fits the points. path and line: to name. ST_DATA: no such view; no
 * points; ... */
enum status place_wall(struct placed_wall *wall, const struct placer *placer, const struct script_place *place,
                       const double normal[2], bool angled, const char *path, int line, struct err *err);

/* Where the rays through the rectangle's corners X0 Y0 and X1 Y1 meet the plane n p = d. */
enum status place_corners(struct vec3 corners[2], const struct placer *placer, const struct script_place *place, struct vec3 n,
                          double d, const char *path, int line, struct err *err);

#endif
