/* export_lamps.h - lamps that an edit adds by their makers' photometry, as other programs take them. */
#ifndef REMODEL_EXPORT_LAMPS_H
#define REMODEL_EXPORT_LAMPS_H

#include "common/model/model_axes.h"
#include "common/model/model_plan.h"
#include "common/relight/planned_lamps.h"

struct texture_map;

/* {0} is the empty state; everything is owned. */
struct export_lamps {
    struct planned_lamps planned;
    char **files; /* of each, its IES file without a folder */
    double metre; /* in model units */
};

/* scene: folder of the IES files. The caller releases the lamps in each case. ST_DATA: a damaged file. */
enum status export_lamps_read(struct export_lamps *l, const struct texture_map *map, const char *scene,
                              const struct model_axes *axes, const struct model_plan *plan, struct provenance *prov,
                              struct err *err);
void export_lamps_release(struct export_lamps *l);

/* The luminous opening, a flat polygon that is at least 4 cm wide, so that it can be seen. */
int export_lamps_outline(struct vec3 corners[PLANNED_LAMP_CORNERS], const struct export_lamps *l, int lamp);
/* The colour of its light, the largest channel 1. */
void export_lamps_colour(double rgb[3], const struct planned_lamp *l);
/* All of its light in lm, with the factors of the edit. */
double export_lamps_lumens(const struct planned_lamp *l);

/* A cone with about the lamp's distribution and exactly its lumens: `candela` within `inner` of the axis, from there to
 * `outer` (radians) falling with the square of (cos - cos outer) / (cos inner - cos outer). False: it shines to all
 * sides, and `candela` is the mean. */
struct lamp_cone {
    double inner, outer, candela;
};
bool export_lamps_cone(struct lamp_cone *cone, const struct planned_lamp *l);

#endif
