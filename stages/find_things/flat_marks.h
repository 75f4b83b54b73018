/* flat_marks.h - marks of what lies flat, each with the corners of its outline, also where a user marked one pixel. */
#ifndef REMODEL_FLAT_MARKS_H
#define REMODEL_FLAT_MARKS_H

#include "common/light/model_rays.h"
#include "common/model/scene_inputs.h"
#include "common/model/thing_marks.h"

/* Where the pictures of the views and the faces that they see are read from. */
struct flat_pictures {
    const char *views, *ids; /* folders */
    const struct scene_inputs *in;
    const struct model_rays *model;
    struct provenance *prov;
};

/* Makes `all` a copy of `marks` in which a flat thing of one pixel has the corners at which its colour ends. slack: how
 * far a pixel's point may be off the face. The caller releases it with flat_marks_release(), before `marks`. ST_DATA
 * with line and pixel: no face is there, or no outline stands out. */
enum status flat_marks_complete(struct thing_marks *all, const struct thing_marks *marks,
                                const struct flat_pictures *pictures, double slack, struct err *err);
void flat_marks_release(struct thing_marks *all);

#endif
