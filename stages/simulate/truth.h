/* truth.h - what is true of a scene as a whole: cameras, faces, irradiance, exposures. */
#ifndef REMODEL_SIMULATE_TRUTH_H
#define REMODEL_SIMULATE_TRUTH_H

#include "stages/simulate/render.h"

/* OUT/truth/{points3D,cameras,images}.txt (no points; names NAME.jpg), faces.txt, irradiance.txt, scene.txt (FOLDER's);
 * of reference images truth/lri/{points3D,cameras,images}.txt and OUT/lri/exposures.txt; then OUT/photos.mk, which lists
 * photos and references. */
enum status truth_write(const struct world *w, const struct shoot *s, const char *folder, const char *out,
                        const struct simulate_params *params, const struct provenance *prov, struct err *err);

/* OUT/truth/edited-EDIT/{scene,faces}.txt */
enum status truth_write_edited(const struct world *w, const char *folder, const char *out, const char *edit,
                               const struct provenance *prov, struct err *err);

struct irradiance_point {
    struct vec3 point, normal; /* the point is 2 cm off its surface */
    struct rgb irradiance;
};

/* Points on surfaces that photos see, drawn evenly from the photos' pixels; lamps have none. */
enum status truth_irradiance(struct irradiance_point *points, int count, const struct world *w, const struct shoot *s,
                             const struct simulate_params *params, struct err *err);

#endif
