/* things.h - finds the things of a scene: furniture, one id across all views. */
#ifndef REMODEL_THINGS_H
#define REMODEL_THINGS_H

#include "common/light/model_rays.h"
#include "common/model/scene_inputs.h"
#include "common/model/thing_list.h"
#include "common/model/thing_marks.h"
#include "common/model/thing_volume.h"
#include "stages/find_things/things_params.h"

struct things_job {
    const char *views, *depth, *ids; /* folders */
    const char *out;                 /* folder of the products */
    const struct scene_inputs *in;   /* cameras, axes, plan */
    const struct model_rays *model;  /* without panes */
    const struct thing_marks *marks;
    const struct things_params *params;
    struct provenance *prov;
};

/* Writes the masks of all views, the volume, the contact sheet and the plan, then the list. A mark where no surface
 * is gives a warning. */
enum status things_find(const struct things_job *job, struct err *err);

#endif
