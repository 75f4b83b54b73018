/* outdoors_sun.h - the sun in the picture of the outdoors, as a lighting reference image shows it, or found from its
 * patches indoors. */
#ifndef REMODEL_OUTDOORS_SUN_H
#define REMODEL_OUTDOORS_SUN_H

#include "common/relight/light_things.h"
#include "stages/bake_outdoors/outdoors_gather.h"
#include "stages/bake_outdoors/sun_light.h"
#include "stages/bake_outdoors/sun_search.h"

enum sun_source {
    SUN_UNKNOWN, /* no picture shows it, and no patches are found */
    SUN_SEEN,    /* a lighting reference image shows it */
    SUN_HIDDEN,  /* there are patches, but a lighting reference image shows their direction without a sun */
    SUN_PATCHES  /* it is found from its patches */
};

/* {0} is the empty state. */
struct outdoors_sun {
    enum sun_source source;
    struct vec3 direction;    /* unless it is unknown; unit, model frame */
    struct sun_search search; /* if patches were looked for */
    struct sun_light light;   /* SUN_PATCHES */
    double radius;            /* degrees, of the disk that was painted */
    struct field_atlas atlas; /* the VITA; owned, as are those below */
    struct face_plane *planes;
    struct thing_surfaces things;
    struct field_surfaces furniture; /* of things */
    struct model_rays furnished;     /* the model with them: what throws shadows */
};

/* What patches of sun are looked for in. */
struct outdoors_sun_files {
    const char *model, *vita; /* model.txt; the folder of the VITA without edits; NULL: only reference images tell */
    const char *things;       /* folder of the furniture; NULL: none */
};

/* Finds the direction. o: what pictures show. The caller releases s, also after a failure. ST_DATA: a damaged file;
 * ST_NOMEM. */
enum status outdoors_sun_find(struct outdoors_sun *s, const struct outdoors *o, const struct outdoors_model *model,
                              const struct outdoors_sun_files *files, struct provenance *prov, struct err *err);
/* Of a sun found from patches: measures its light under the rest of the outdoors, and paints its disk into them. */
enum status outdoors_sun_add(struct outdoors_sun *s, struct outdoors *o, const struct outdoors_model *model,
                             struct err *err);
void outdoors_sun_release(struct outdoors_sun *s);

/* Paints a disk (radius in degrees) that gives a surface which faces it this irradiance. Its pixels count as guessed.
 * Returns the radius that was painted: a disk too bright for half floats is made wider. */
double outdoors_paint_sun(struct outdoors *o, struct vec3 direction, double radius, struct rgb irradiance);

#endif
