/* field_openings.h - what lies behind an opening, from the reference images that lights.txt names for it. */
#ifndef REMODEL_GATHER_FIELD_OPENINGS_H
#define REMODEL_GATHER_FIELD_OPENINGS_H

#include "common/gather/light_list.h"
#include "common/gather/outdoors_picture.h"
#include "common/light/model_rays.h"

/* An opening, ready for rays: where one passes its plane, q from its centre is a x + b y with a = dual[0].q and
 * b = dual[1].q. */
struct field_opening {
    const struct daylight *opening; /* of lights.txt */
    struct vec3 dual[2];
    int *references; /* indices of pictures that show what lies behind it, nearest first; owned */
    int reference_count;
};

/* {0} is the empty state; everything is owned. */
struct field_openings {
    struct field_opening *items; /* those with references */
    int count;
    struct outdoors_picture *pictures; /* the references, in memory */
    int picture_count;
};

/* Vectors of the plane of x and y with which q = a x + b y has a = dual[0].q and b = dual[1].q. */
void field_dual(struct vec3 dual[2], struct vec3 x, struct vec3 y);

/* Reads the reference images that the openings of the list name, FOLDER/ID.exr, in place of those that o has. The list
 * must outlive o. model: whose faces hide the outdoors. The caller releases o, also after a failure. ST_DATA also: an
 * image without a pose, or that shows nothing of the outdoors. */
enum status field_openings_read(struct field_openings *o, const struct light_list *lights,
                                const struct model_rays *model, const char *folder, const struct model_axes *axes,
                                struct provenance *prov, struct err *err);
void field_openings_release(struct field_openings *o);

/* The colour of the first reference image that shows a unit direction, of the opening that a ray passes on its way out.
 * False: it passes none that has such an image. */
bool field_openings_look(float rgb[3], const struct field_openings *o, struct vec3 from, struct vec3 direction);

#endif
