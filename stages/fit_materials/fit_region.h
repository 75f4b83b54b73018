/* fit_region.h - one marked material: its light, its fit, its residuals. */
#ifndef REMODEL_FIT_REGION_H
#define REMODEL_FIT_REGION_H

#include "stages/fit_materials/choose_material.h"
#include "stages/fit_materials/incident.h"
#include "stages/fit_materials/observe_materials.h"

/* {0} is the empty state; everything is owned. */
struct region_fit {
    int first; /* of its sights: they are consecutive; there are samples.count of them */
    struct material_samples samples;
    struct material_choice choice;
    double shares[LIGHT_SOURCES]; /* of the light that arrives, by source; mean over points */
    double *predicted;            /* [3 samples.count] by the chosen model */
};

/* Fits material m (of o->points[].material). Its points are moved to the surface of the field where the two disagree by
 * at most `lift`. declared: m->kind is the model. Fills what m says of the fit. ST_DATA with the material's name and
 * the reason. */
enum status region_fit_make(struct region_fit *f, struct material *m, int index, bool declared,
                            const struct observations *o, const struct observed_scene *scene,
                            const struct light_field *field, struct err *err);
void region_fit_release(struct region_fit *f);

/* A line for each sample: NAME VIEW X Y, the observed radiance, the model's. */
void region_fit_print(FILE *to, const struct region_fit *f, const struct material *m, const struct observations *o,
                      const struct observed_scene *scene);

/* The view that shows most samples, with a dot for each: red where the view is brighter than the model says, blue where
 * it is darker, by a quarter at full colour. */
enum status region_fit_picture(const struct region_fit *f, const struct observations *o,
                               const struct observed_scene *scene, const char *path, struct err *err);

#endif
