/* loaded_atlas.h - an atlas with all its pages in memory, for look-ups. */
#ifndef REMODEL_LOADED_ATLAS_H
#define REMODEL_LOADED_ATLAS_H

#include "stages/evaluate/texture/textures.h"

struct loaded_atlas {
    struct atlas atlas;
    struct atlas_page *pages; /* owned */
};

/* name: a viewpoint; NULL: the VITA. The caller releases it, also after a failure. */
enum status loaded_atlas_read(struct loaded_atlas *a, struct evaluation *e, const char *name, struct err *err);
void loaded_atlas_release(struct loaded_atlas *a);

/* The colour of a point of the model on a face: from the first of the face's tiles that holds it; false: none does. */
bool loaded_atlas_look_up(float rgb[3], const struct loaded_atlas *a, int face, struct vec3 p);

#endif
