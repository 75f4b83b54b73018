/* choose_material.h - the model that a surface needs: Lambert, Phong or Ward, by cross-validation. */
#ifndef REMODEL_CHOOSE_MATERIAL_H
#define REMODEL_CHOOSE_MATERIAL_H

#include "common/gather/materials.h"
#include "stages/fit_materials/material_fit.h"

enum { MATERIAL_KINDS = 3 };

struct material_choice {
    struct material_fit fit[MATERIAL_KINDS]; /* by enum brdf_kind */
    bool fitted[MATERIAL_KINDS];
    double error[MATERIAL_KINDS]; /* mean loss of held-out samples, per channel; about 1 where the model holds */
    double gain[MATERIAL_KINDS];  /* of error against Lambert's; and its standard error */
    double gain_error[MATERIAL_KINDS];
    int folds;           /* 0: too few points to hold any out */
    enum brdf_kind kind; /* what was chosen */
    const char *why;     /* a clause; static */
};

/* Fits all models and chooses one. ST_DATA: no light, no samples. */
enum status material_choose(struct material_choice *c, const struct material_samples *s, struct err *err);

/* Fits the model that a person declared. ST_DATA as above, or where the samples do not determine its lobe. */
enum status material_declared(struct material_choice *c, const struct material_samples *s, enum brdf_kind kind,
                              struct err *err);

#endif
