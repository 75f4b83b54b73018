/* rows.h - light that arrives at places: from each patch, as a form factor, and directly from each group. */
#ifndef REMODEL_LEVELS_ROWS_H
#define REMODEL_LEVELS_ROWS_H

#include "stages/light_levels/groups.h"
#include "stages/light_levels/patches.h"

struct row_entry {
    int patch;
    float share; /* form factor */
};

struct light_row {
    struct row_entry *entries; /* in order of patch; owned */
    int count;
    float away; /* the share of the hemisphere that leaves the model, or meets nothing that reflects */
};

/* {0} is the empty state; everything is owned. */
struct light_rows {
    struct light_row *rows;
    float *direct; /* irradiance from each group: direct[(row * groups + group) * 3 + channel] */
    int count, groups;
};

/* What a row is of: the mean over some places. */
struct row_place {
    const struct gather_point *origins;
    int count;
};

/* `rays` of each row go by the cosine, as many to the windows. Form factors of a row and `away` sum to 1. key:
 * different for rows that must not share random numbers. Same bits for any number of threads. The caller releases r
 * in each case. ST_NOMEM. */
enum status rows_trace(struct light_rows *r, const struct light_groups *g, const struct light_patches *p,
                       const struct row_place *places, int count, int rays, uint64_t key, const char *what,
                       struct err *err);
void rows_release(struct light_rows *r);

/* Whether the sun in a direction shines through the model at a point, whose normal looks towards it. */
bool rows_sees_sun(const struct model_field *f, struct gather_point p, struct vec3 to_sun);

#endif
