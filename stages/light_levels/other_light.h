/* other_light.h - photos that were taken with other lamps on, or with other blinds, than those that the textures are
 * from: how much of its light each patch has left there. */
#ifndef REMODEL_LEVELS_OTHER_LIGHT_H
#define REMODEL_LEVELS_OTHER_LIGHT_H

#include "stages/light_levels/group_fit.h"
#include "stages/light_levels/level_sums.h"

/* {0} is the empty state; everything is owned. Groups are those of level_factors.h: lamps, the rest, windows. */
struct other_light {
    struct group_photo *photos; /* of the lines `photo` of states.txt, in order */
    int count;
    struct group_quotient *patches; /* of all photos */
    double *light, *weights;
};

struct other_light_files {
    const char *views; /* folder of the cameras and views of the photos, which were held out */
};

/* The caller releases o in each case. ST_DATA: a photo that is not there, that shows nothing of the model, or whose
 * state has light that the photographs do not have, or none of theirs; ST_USAGE: there are such lines, and no views. */
enum status other_light_make(struct other_light *o, const struct other_light_files *files, const struct level_light *l,
                             const struct state_list *states, const struct model_axes *axes,
                             const struct levels_params *params, struct provenance *prov, struct err *err);
void other_light_release(struct other_light *o);

#endif
