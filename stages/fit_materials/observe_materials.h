/* observe_materials.h - points of a marked material on the model, and what the views show of them. */
#ifndef REMODEL_OBSERVE_MATERIALS_H
#define REMODEL_OBSERVE_MATERIALS_H

#include "common/capture/lens_list.h"
#include "common/gather/materials.h"
#include "common/light/model_rays.h"
#include "common/model/model_axes.h"
#include "stages/fit_materials/materials_params.h"

/* Where materials are looked for. Model frame, but for the cameras. */
struct observed_scene {
    const struct model_rays *model;
    const struct model_axes *axes;
    const struct camera_set *set;
    const struct lens_list *lenses;
    const char *path;        /* of the marks, for errors */
    const char *views, *ids; /* folders */
    const struct materials_params *params;
};

struct material_point {
    struct vec3 at, normal;
    int material, face; /* face: the id of its name */
};

/* One view of one point. */
struct point_sight {
    int point, view, photo; /* photo: the lens of its first view */
    double x, y, aside;     /* pixel; distance from the view's centre, in widths */
    double radiance[3], variance[3];
};

/* {0} is the empty state; everything is owned. */
struct observations {
    struct material_point *points; /* in order of material */
    struct point_sight *sights;    /* in order of point, then photo */
    int point_count, sight_count;
};

/* Points of all materials, on a grid of pixels of each region. ST_DATA with file and line: an unknown view, a region
 * outside the photo, a region that shows no surface of the model. */
enum status observe_points(struct observations *o, const struct observed_scene *scene,
                           const struct material_list *marked, struct err *err);
/* What the views show of them: at most params->views photos of each, spread evenly over those that show it. Adds what
 * was read to prov. */
enum status observe_views(struct observations *o, const struct observed_scene *scene, struct provenance *prov,
                          struct err *err);
void observe_release(struct observations *o);

#endif
