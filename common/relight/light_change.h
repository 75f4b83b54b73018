/* light_change.h - light before and after an edit: the fields of both models, and what each point of the edited model
 * is in the unedited one [Colburn 2014, 5.5].
 *
 * Both fields have the same emitters, so that gathers with one key send the same rays in both, and what the edit does
 * not change has equal bits before and after. */
#ifndef REMODEL_LIGHT_CHANGE_H
#define REMODEL_LIGHT_CHANGE_H

#include "common/gather/model_field.h"
#include "common/model/model_axes.h"
#include "common/relight/edit_lamps.h"
#include "common/relight/face_areas.h"
#include "common/relight/light_objects.h"
#include "common/relight/light_things.h"
#include "common/texture/texture_map.h"

struct light_change_files {
    const char *base, *vita;  /* the unedited model.txt; folder of its VITA */
    const char *edited, *map; /* of the edit: model.txt and texture.txt */
    const char *edited_vita;  /* folder of its VITA under the new light (update_vita); NULL: not made yet */
    const char *axes;         /* the models' frame */
    const char *outdoors;     /* outdoors.exr; NULL: it is dark outside */
    const char *lights;       /* lights.txt; NULL: no lamps */
    const char *references;   /* folder of the reference images that openings name; NULL: none */
    const char *objects;      /* objects.txt of the edit; NULL: none */
    const char *scene;        /* scenes/NAME, the folder of the objects' meshes */
    const char *things;       /* folder of the scene's things; NULL: furniture throws no shadows */
    const char *object_light; /* their light, as update_vita wrote it; NULL: not known yet */
    const char *lux_scale;   /* lx of the photographs' unit; NULL: unknown, and lamps that the edit adds do not shine */
    const char *edited_plan; /* plan.txt of the edit, for those; NULL: none is needed */
    bool all_things;         /* furniture counts also where the edit changes none of it */
};

/* {0} is the empty state; everything is owned. It must not move once it was read. */
struct light_change {
    struct model_field before, after;
    struct texture_map map;
    struct model_axes axes;
    struct light_objects objects;
    struct light_things things;
    struct edit_lamps lamps;                    /* that the edit adds; in no field */
    struct thing_surfaces added;                /* the objects, then the things of `after` */
    struct field_surfaces old_things, surfaces; /* in `before`: the things; in `after`: what was added */
    struct face_areas old;                      /* of the unedited model */
    struct emitter *emitters;
    double inset; /* how far from the rim of an old area the light on a new one is taken, model units */
};

/* Reads both fields. The files are added to prov, which may be NULL. The caller releases the change in each case.
 * ST_DATA: a damaged file. */
enum status light_change_read(struct light_change *c, const struct light_change_files *files, struct provenance *prov,
                              struct err *err);
void light_change_release(struct light_change *c);

enum light_place_kind {
    LIGHT_PLACE_NONE,    /* nothing is known of the surface */
    LIGHT_PLACE_TEXTURE, /* it has a baked texel */
    LIGHT_PLACE_COLOUR   /* it has an albedo */
};

/* What a point of the edited model is. */
struct light_place {
    enum light_place_kind kind;
    struct rgb colour;        /* radiance of the baked texel, or the albedo */
    enum light_source source; /* of the texel */
    int face;                 /* id of the unedited face that has the texel */
    struct vec3 texel;        /* where the texel is, in the unedited model */
    /* Where the irradiance that lit the texel is gathered: there, or, if the edit made the place, on the nearest area
     * that the unedited model has. */
    struct gather_point before;
    bool is_new; /* the unedited model has no surface there */
};

/* face: index into the edited model's mesh; p: a point on it. The first rule of the texture map that covers p gives the
 * place; a face that the map does not list is itself. */
void light_change_place(struct light_place *place, const struct light_change *c, int face, struct vec3 p);

#endif
