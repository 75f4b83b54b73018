/* observe_lights.h - what the views show: the radiance of annotated points, and of the lamps themselves. */
#ifndef REMODEL_OBSERVE_LIGHTS_H
#define REMODEL_OBSERVE_LIGHTS_H

#include "stages/fit_lights/fit_lights_params.h"
#include "stages/fit_lights/lit_scene.h"

/* One photo's radiance of one point. */
struct observation {
    int point, photo;          /* photo: index of its first view */
    double radiance[3], sigma; /* sigma: of the noise, as a fraction of the radiance */
    double aside;              /* distance of the pixel from the view's centre, as a fraction of its width */
};

/* Of one view of a lamp. */
struct lamp_sight {
    int lamp, view;
    double angle;       /* between the lamp's normal and the direction to the camera, radians */
    double radiance[3]; /* the median of its pixels */
    bool saturated;     /* so that the radiance is a lower bound */
};

struct observations {
    struct observation *items; /* in order of point, then photo */
    struct lamp_sight *sights; /* in order of view, then lamp */
    int count, sight_count;
    int clipped;         /* observations left out because they are saturated or dark */
    int *clipped_points; /* the number of those of each point */
};

/* Reads VIEWS/VIEW.exr and IDS/VIEW.exr of the views that face a point or a lamp, and adds them to the provenance. The
 * view in which a point is marked counts as showing it; in others the model, `furnished` (the model with its furniture)
 * and the clutter decide. */
enum status observe(struct observations *o, const struct lit_scene *scene, const struct annotation_list *notes,
                    const struct lit_model *model, const struct model_rays *furnished, const char *views,
                    const char *ids, const struct fit_lights_params *params, struct provenance *prov, struct err *err);
void observe_release(struct observations *o);

#endif
