/* model_field.h - the field of light of a textured model: its VITA, its lamps, and the outdoors through its openings.
 *
 * Everything is in the model's frame and units. */
#ifndef REMODEL_GATHER_MODEL_FIELD_H
#define REMODEL_GATHER_MODEL_FIELD_H

#include "common/gather/field_atlas.h"
#include "common/gather/field_sky.h"
#include "common/gather/irradiance.h"
#include "common/light/model_rays.h"

/* Where a model's light is read from. */
struct model_field_files {
    const char *model;    /* model.txt */
    const char *vita;     /* folder of the VITA */
    const char *outdoors; /* outdoors.exr; NULL: it is dark outside */
    const char *lights;   /* lights.txt; NULL: no lamps, and the panes of the model are its openings */
};

/* A lamp, ready for rays: q, from its centre, is a x + b y with a = dual[0].q and b = dual[1].q. */
struct field_lamp {
    const struct lamp *lamp; /* of `lights` */
    struct vec3 dual[2];
    bool off;
};

/* {0} is the empty state; everything is owned. */
struct model_field {
    struct light_field field; /* for the estimators; its ctx is this struct, which must not move */
    struct model_rays model;  /* without panes: rays pass them */
    struct field_atlas atlas;
    struct outdoors outdoors;
    struct field_sky sky;
    struct light_list lights;
    struct field_lamp *lamps;
    struct emitter *emitters;  /* lamps, then openings, then suns */
    struct face_plane *planes; /* of each face id */
    double reach;              /* how far a lamp may be behind the surface that it lies on, model units */
    int covered_texels;        /* under and around lamps */
};

/* Reads everything and adds the files to prov, which may be NULL. The caller releases the field, also after a failure.
 * ST_DATA: a damaged file, or a VITA of another model. */
enum status model_field_read(struct model_field *f, const struct model_field_files *files, struct provenance *prov,
                             struct err *err);
void model_field_release(struct model_field *f);

/* Switches a lamp (an index into `lights`; -1: all) off or on. In the place of a lamp that is off there is the ceiling, in
 * the colour of its surroundings: what is left is the light from elsewhere. Not while others gather. */
void model_field_switch_lamp(struct model_field *f, int lamp, bool on);

/* Whether a point is behind a surface of the model, that is in a solid, with the surface no further than `most` ahead
 * along its normal. Then it is moved there: photographs and the model agree on a surface to some centimetres only. */
bool model_field_lift(const struct model_field *f, struct gather_point *p, double most);

#endif
