/* bake_viewpoint.h - bakes the view-dependent atlas of one viewpoint [Colburn 2014, 4.5]. */
#ifndef REMODEL_BAKE_VIEWPOINT_H
#define REMODEL_BAKE_VIEWPOINT_H

#include "common/model/scene_inputs.h"
#include "common/texture/bake_atlas.h"
#include "common/texture/filled_atlas.h"
#include "stages/bake_vdta/vdta_params.h"

/* What all viewpoints of a run share. */
struct bake_scene {
    struct scene_inputs in; /* cameras in the model's frame; lenses; axes; the unedited model */
    struct surfaces surfaces;
    struct source_files from;
    const char *reveal, *out; /* folders */
    const char *fill;         /* folder of the atlas that texture of hidden places is taken from; NULL: none */
    struct filled_atlas filled;
    const struct vdta_params *params;
};

/* Writes OUT/PHOTO/, and, unless it is NULL, the file of make dependencies `deps`. prov: with the inputs that all
 * viewpoints share; more are added for this one and taken off again. ST_USAGE: there is no such photo. */
enum status viewpoint_bake(struct bake_scene *scene, const char *photo, const char *deps, struct provenance *prov,
                           struct err *err);

#endif
