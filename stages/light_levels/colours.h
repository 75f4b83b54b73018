/* colours.h - what patches reflect, from their photographed radiance and the light that reaches them. */
#ifndef REMODEL_LEVELS_COLOURS_H
#define REMODEL_LEVELS_COLOURS_H

#include "common/relight/light_change.h"
#include "stages/light_levels/radiosity.h"

struct photographed_patch {
    struct patch_colour colour;
    struct rgb before; /* irradiance in the photographs */
    bool known;        /* pi L / E is what the photographs say; otherwise it is the face's */
};

/* Sets found[i] of each patch of the photographed model, whose radiance is that of its texels. rows: of the patches.
 * ST_NOMEM. */
enum status colours_of_photographs(struct photographed_patch *found, const struct light_patches *p,
                                   const struct light_rows *rows, const struct light_groups *g, struct err *err);

/* The colours of an edit's patches, from those of the photographed model. `was` has the things of the photographs as
 * its further surfaces; an edit's are objects, whose owner is its place in the edit's list of objects, and things,
 * OWNER_THING + id. */
enum { OWNER_THING = 1 << 20 };
void colours_of_edit(struct patch_colour *found, const struct light_patches *p, const struct light_change *change,
                     const struct light_patches *was, const struct photographed_patch *photographed);

#endif
