/* draft.h - where an edited room takes the colours of a photograph's pixels: a quick draft of what make remodel draws.
 *
 * Model frame and units; pixels are those of the photographs as they are stored. */
#ifndef REMODEL_BUILD_MODEL_DRAFT_H
#define REMODEL_BUILD_MODEL_DRAFT_H

#include "common/texture/texture_map.h"
#include "stages/build_model/building/building.h"
#include "stages/build_model/live/draft_things.h"

struct draft_solid;

/* {0} is the empty state. */
struct draft {
    struct building before; /* the rooms as they were photographed */
    struct texture_map map;
    struct draft_solid *solids[2]; /* before and after; owned */
    struct draft_things things;
    double size; /* of the model, for tolerances */
};

/* Compares a model with the rooms that `before` has. after gets their ids. scene: the folder of meshes of objects.
 * ST_NOMEM; ST_DATA: a mesh. */
enum status draft_begin(struct draft *d, struct building *after, const char *scene, struct err *err);
bool draft_is_begun(const struct draft *d);
/* What a pixel of a photo shows. Cameras: those of all photos, as many as the placer has. */
struct draft_pixel draft_pixel_of(const struct draft *d, const struct placer *placer, int photo, double u, double v);
/* Where another photo shows what this one shows at u, v, in the rooms as they were photographed. */
bool draft_other_pixel(const struct draft *d, const struct placer *placer, int photo, double u, double v, int other,
                       double at[2]);
/* Forgets the models; furniture and masks stay. */
void draft_end(struct draft *d);
void draft_release(struct draft *d);

#endif
