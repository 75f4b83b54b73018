/* bright_ceilings.h - places of ceilings that photographs show as bright as lamps. */
#ifndef REMODEL_FIT_LIGHTS_BRIGHT_CEILINGS_H
#define REMODEL_FIT_LIGHTS_BRIGHT_CEILINGS_H

#include "common/gather/model_field.h"
#include "stages/fit_lights/lit_scene.h"

/* A rectangle along the model's axes about a bright place, as large as what is bright. */
struct bright_place {
    struct vec3 at; /* its middle, on the ceiling */
    double x, y;    /* half sides */
    bool is_round;  /* shines evenly to all sides, not down */
};

/* {0} is the empty state; everything is owned. */
struct bright_places {
    struct bright_place *list;
    int count;
};

/* bright: radiance from which a pixel shows a lamp; saturated ones always do. ST_NOMEM, ST_DATA: a damaged view. */
enum status bright_ceilings_find(struct bright_places *b, const struct model_field *field,
                                 const struct lit_model *model, const char *views, double bright,
                                 struct provenance *prov, struct err *err);
void bright_ceilings_release(struct bright_places *b);

#endif
