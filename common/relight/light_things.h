/* light_things.h - furniture as surfaces that light meets, where an edit changes it: at its old places before the edit,
 * and at its new ones after it. */
#ifndef REMODEL_LIGHT_THINGS_H
#define REMODEL_LIGHT_THINGS_H

#include "common/gather/model_field.h"
#include "common/relight/placed_things.h"

/* Triangles and what each sends out on its front and on its back. Everything is owned. */
struct thing_surfaces {
    struct vec3 (*triangles)[3];
    struct rgb (*radiance)[2];
    int *thing; /* of each triangle: its id in the list of things; NULL: there is none */
    int count;
};

/* The things of a scene as they stand. folder: of the things. What hangs from the ceiling is left out. The caller
 * releases s in each case. ST_DATA: a damaged file. */
enum status thing_surfaces_read(struct thing_surfaces *s, const char *folder, struct provenance *prov, struct err *err);
void thing_surfaces_release(struct thing_surfaces *s);
struct field_surfaces thing_surfaces_of_field(const struct thing_surfaces *s);

/* {0} is the empty state; everything is owned. */
struct light_things {
    struct placed_things placed;
    struct thing_surfaces before, after;
    bool *stays;  /* of each triangle of `before`: `after` has it at the same place */
    bool changes; /* the edit changes a thing, or all are wanted; otherwise both are empty */
};

/* folder: of the things; NULL: none. before, after: model.txt of both models. always: read them also if the edit
 * changes none. What hangs from the ceiling is left out, as lamps do, which have lights of their own. Each side of a
 * thing has one radiance, the mean of its pixels. The caller releases t in each case. */
enum status light_things_read(struct light_things *t, const char *folder, const struct texture_map *map, bool always,
                              const char *before, const char *after, struct provenance *prov, struct err *err);
void light_things_release(struct light_things *t);

/* The thing that the edit moved to a point of the edited room; NULL: none. *was: where this place of it was before. */
const struct placed_thing *light_things_moved(struct vec3 *was, const struct light_things *t, struct vec3 at);

#endif
