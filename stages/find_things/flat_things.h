/* flat_things.h - what lies flat on a face of the model, such as a rug or a picture: a user drew its outline. */
#ifndef REMODEL_FLAT_THINGS_H
#define REMODEL_FLAT_THINGS_H

#include "common/capture/view.h"
#include "common/light/model_rays.h"
#include "common/model/model_axes.h"
#include "common/model/thing_list.h"
#include "common/model/thing_marks.h"
#include "common/model/thing_mask.h"
#include "common/model/thing_volume.h"
#include "common/texture/view_ids.h"

struct flat_thing {
    int name;    /* of the marks */
    uint32_t id; /* of the volume and the masks; the caller sets it */
    struct flat_outline outline;
};

/* {0} is the empty state; everything is owned. */
struct flat_things {
    struct flat_thing *list;
    int count;
};

/* Finds the faces that the outlines of the marks lie on. marks: with cameras; axes: the model's frame in the world of
 * the marks. slack: how far a corner may be off the face that the first one is on. ST_DATA with line and pixel: a
 * corner that shows no face, or another one; corners that hold no area. */
enum status flat_things_place(struct flat_things *f, const struct thing_marks *marks, const struct model_axes *axes,
                              const struct model_rays *model, double slack, struct err *err);
void flat_things_release(struct flat_things *f);

/* Gives the things the voxels about their faces that nothing else stands in. */
void flat_things_fill(const struct flat_things *f, struct thing_volume *v);

/* Sets the outline, the box and the support of a thing. v: with its voxels, of which one is its thickness. ST_NOMEM. */
enum status flat_thing_measure(struct thing *t, const struct flat_thing *f, const struct thing_volume *v,
                               struct err *err);

/* Sets the pixels of a mask that show a flat thing, with nothing before it. camera: model frame; ids: of the view;
 * depth: of what it shows, scene units, like that of ids; scale: model units per scene unit. */
void flat_things_see(struct thing_mask *mask, const struct flat_things *f, const struct view *camera,
                     const struct view_ids *ids, const float *depth, double slack, double scale);

#endif
