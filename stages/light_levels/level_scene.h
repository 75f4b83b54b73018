/* level_scene.h - the room that light is computed in: as photographed, or after an edit. */
#ifndef REMODEL_LEVEL_SCENE_H
#define REMODEL_LEVEL_SCENE_H

#include "common/model/model_metre.h"
#include "stages/light_levels/colours.h"
#include "stages/light_levels/levels_params.h"

/* {0} is the empty state; everything but the paths is owned. It must not move once it was read. */
struct level_scene {
    struct light_change change; /* of an edit */
    struct model_field alone;   /* of the unedited room */
    struct thing_surfaces furniture;
    struct field_surfaces surfaces;
    struct model_axes axes;
    bool edited;
    struct model_metre metre;
    const struct planned_lamps *planned; /* not owned; NULL: none */
};

/* files->edited NULL: the unedited room. Furniture counts in both. The caller releases s in each case. ST_DATA: a
 * damaged file. */
enum status level_scene_read(struct level_scene *s, const struct light_change_files *files, struct provenance *prov,
                             struct err *err);
void level_scene_release(struct level_scene *s);

/* Whether a point is inside of something: most rays from it meet the backs of surfaces. */
bool level_scene_inside(const struct model_field *f, struct vec3 at);

/* The room after the edit, or the unedited one. */
const struct model_field *level_scene_field(const struct level_scene *s);

/* Light in groups in the room: what patches send out for each group. */
struct level_light {
    struct light_groups groups;
    struct light_patches patches;
    struct light_rows rows;
    struct patch_colour *colours;
    struct radiosity radiosity;
    int bounded; /* patches of faces whose reflectance is that of their face */
};

/* hours: with groups for the sky and the sun of any hour, which a photographed state does not need. The caller releases
 * l in each case. Same bits for any number of threads. ST_DATA: a planned lamp inside of a wall or outdoors. */
enum status level_light_make(struct level_light *l, const struct level_scene *s, bool hours,
                             const struct levels_params *params, struct err *err);
void level_light_release(struct level_light *l);

/* The irradiance at points from each group: (*found)[(point * groups + group) * 3 + channel]; what arrives directly
 * alone is in `direct`, which the caller releases, as it frees *found. */
enum status level_light_at(float **found, struct light_rows *direct, const struct level_light *l,
                           const struct gather_point *points, int count, const struct levels_params *params,
                           struct err *err);

#endif
