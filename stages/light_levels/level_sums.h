/* level_sums.h - light of a state of lamps and sky: a sum over groups. */
#ifndef REMODEL_LEVELS_SUMS_H
#define REMODEL_LEVELS_SUMS_H

#include "stages/light_levels/level_scene.h"
#include "stages/light_levels/state_list.h"

/* What each group is multiplied by, luminance by luminance: `relative` in the unit of the photographs, `absolute` in
 * lx or cd/m2. Owned. */
struct state_weights {
    const struct light_groups *groups; /* not owned */
    double *relative, *absolute;
    double *windows;                 /* the part of daylight that each window's blind lets through */
    bool has_relative, has_absolute; /* some weight is not 0 */
    bool has_planned;                /* so is that of a planned lamp */
    struct vec3 to_sun;
    double sun;        /* lx on a surface that faces it, within the panes; 0: none */
    double horizontal; /* lx, of the unobstructed horizontal under the computed sky */
};

/* ST_DATA: a state names a lamp or a window that the scene does not have, with file and line. */
enum status level_lamps_check(const struct state_list *states, const struct light_list *lights, struct err *err);
enum status level_blinds_check(const struct state_list *states, const struct level_scene *scene, struct err *err);

/* The caller releases w in each case. ST_NOMEM. */
enum status level_weights_make(struct state_weights *w, const struct light_state *state,
                               const struct state_list *states, const struct light_groups *groups,
                               const struct levels_params *params, struct err *err);
/* Adds a sky and its sun, through the blinds of w. */
void level_weights_add_sky(struct state_weights *w, const struct sky_luminance *sky, const struct light_groups *groups,
                           const struct levels_params *params);
/* lx of the sun directly, at a point, by a ray. */
double level_weights_sun(const struct state_weights *w, struct gather_point p);
enum status level_weights_init(struct state_weights *w, const struct light_groups *groups, struct err *err);
void level_weights_release(struct state_weights *w);

/* Illuminance at points, by group: luminances of what level_light_at() found. Everything is owned. */
struct level_points {
    const struct gather_point *points; /* not owned */
    int count, groups;
    float *whole, *direct; /* of each point and group; in `whole` beams have only what is reflected */
};

enum status level_points_make(struct level_points *p, const struct level_light *l, const struct gather_point *points,
                              int count, const struct levels_params *params, struct err *err);
/* The same, and *found as level_light_at() gives it, which the caller frees. */
enum status level_points_find(struct level_points *p, float **found, const struct level_light *l,
                              const struct gather_point *points, int count, const struct levels_params *params,
                              struct err *err);
void level_points_release(struct level_points *p);

/* A point's illuminance in a state: to[0] in the unit of the photographs, to[1] in lx. The sun's direct light comes
 * from a ray in its own direction; field NULL: it is left out. */
void level_points_sum(double to[2], const struct level_points *p, int point, const struct state_weights *w,
                      const struct model_field *field);

/* The same of all patches; to: of each. The sun's light is that of the beams around it. ST_NOMEM. */
enum status level_patches_sum(double (*to)[2], const struct level_light *l, const struct state_weights *w,
                              struct err *err);

/* A patch's light as it arrives directly, in a state. */
void level_patch_direct(double to[2], const struct level_light *l, int patch, const struct state_weights *w);
/* A patch's light by the first `count` groups, all and direct. */
void level_patch_groups(float *whole, float *direct, const struct level_light *l, int patch, int count);

#endif
