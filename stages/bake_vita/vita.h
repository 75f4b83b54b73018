/* vita.h - bakes the view-independent atlas of a model [Colburn 2014, 4.5.3]. */
#ifndef REMODEL_VITA_H
#define REMODEL_VITA_H

#include "common/model/scene_inputs.h"
#include "common/texture/bake_atlas.h"
#include "common/texture/face_index.h"
#include "stages/bake_vita/vita_params.h"

struct vita_scene {
    struct scene_inputs in;    /* cameras in the model's frame; lenses; axes */
    struct solid_mesh *models; /* the unedited one, then those of the edits */
    int model_count;
    struct surfaces surfaces;
    struct face_views *shown_by; /* for each surface: the views that show its face, best first */
    struct source_files from;
    const char *out; /* folder */
    const struct vita_params *params;
};

/* Writes OUT/atlas.txt and its pages. prov: with the inputs of the scene; the views that are read are added. */
enum status vita_bake(const struct vita_scene *scene, struct provenance *prov, struct err *err);

#endif
