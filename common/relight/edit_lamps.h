/* edit_lamps.h - the light of lamps that an edit hangs by their makers' photometry (planned_lamps.h), in the
 * photographs' unit.
 *
 * Such lamps are in no field of light: they are so small that their direct light is a sum over places of their
 * openings, without noise of its own. What surfaces reflect of it is in the atlas that update_vita makes. */
#ifndef REMODEL_EDIT_LAMPS_H
#define REMODEL_EDIT_LAMPS_H

#include "common/gather/model_field.h"
#include "common/light/brdf.h"
#include "common/relight/planned_lamps.h"

struct texture_map;

/* {0} is the empty state, without lamps; everything is owned. */
struct edit_lamps {
    struct planned_lamps planned;
    double metre; /* in model units */
    double scale; /* lx of the photographs' unit */
};

struct edit_lamp_files {
    const char *scale; /* calibrate_light's; NULL: unknown, and no lamp shines */
    const char *plan;  /* of the edited model, by which a metre is guessed where no scale is known */
    const char *scene; /* folder of the IES files */
};

/* Reads the lamps of an edit's map, none if lx of the photographs' unit are unknown. The caller releases l in each
 * case. ST_DATA: a damaged file; ST_USAGE: a folder or plan is missing. */
enum status edit_lamps_read(struct edit_lamps *l, const struct edit_lamp_files *files, const struct texture_map *map,
                            const struct model_axes *axes, struct provenance *prov, struct err *err);
void edit_lamps_release(struct edit_lamps *l);

/* Irradiance at a point from a lamp (-1: from all) where the field's surfaces do not hide it. The same key gives the
 * same bits. */
struct rgb edit_lamps_light(const struct edit_lamps *l, int lamp, const struct model_field *f, struct gather_point p,
                            uint64_t key);
/* What the lobe of a glossy surface reflects of all lamps to the viewer in the unit direction `view`. */
struct rgb edit_lamps_gloss(const struct edit_lamps *l, const struct model_field *f, struct gather_point p,
                            const struct brdf *brdf, struct vec3 view, uint64_t key);

/* The part of a luminous opening that a ray from `from` in a unit direction meets before the distance t of a surface
 * (INFINITY allowed): the radiance that it sends there. False: it meets none. */
bool edit_lamps_meet(struct rgb *radiance, const struct edit_lamps *l, const struct model_field *f, struct vec3 from,
                     struct vec3 direction, double t);

#endif
