/* scene_truth.h - ground truth of a scene as a whole: cameras, faces, irradiance, exposures. */
#ifndef REMODEL_SCENE_TRUTH_H
#define REMODEL_SCENE_TRUTH_H

#include "stages/simulate/render.h"

/* Writes OUT/truth/{points3D,cameras,images}.txt (no points; image names are NAME.jpg), faces.txt, irradiance.txt and
 * scene.txt; for witnesses truth/novel/{points3D,cameras,images}.txt; for reference images
 * truth/lri/{points3D,cameras,images}.txt and OUT/lri/exposures.txt; last OUT/photos.mk, lists of names and files. */
enum status truth_write(const struct world *w, const struct shoot *s, const char *folder, const char *out,
                        const struct simulate_params *params, const struct provenance *prov, struct err *err);

/* Writes OUT/truth/edited-EDIT/{scene,faces}.txt, the scene in full, and {points3D,cameras,images}.txt of all photos
 * and witnesses. */
enum status truth_write_edited(const struct world *w, const struct shoot *s, const char *folder, const char *out,
                               const char *edit, const struct provenance *prov, struct err *err);

struct irradiance_point {
    struct vec3 point, normal; /* the point is 2 cm off the surface */
    struct rgb irradiance;
};

/* Irradiance at `count` points on surfaces that photos see, chosen uniformly over the photos' pixels; none on lamps.
 * ST_DATA: no such surface was found for a point; ST_NOMEM. */
enum status truth_irradiance(struct irradiance_point *points, int count, const struct world *w, const struct shoot *s,
                             const struct simulate_params *params, struct err *err);

#endif
