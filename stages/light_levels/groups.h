/* groups.h - the light of a model in groups that are switched, dimmed or vary with the hour.
 *
 * Groups are: each lamp, as fitted; the rest, light in the photographs that no lamp and no window explains; of each
 * window the sky and the sun as photographed; and of each window, for other skies, each of Tregenza's patches with a
 * luminance of 1, and the sun in the middle of each with an illuminance of 1 on a surface that faces it. A last window
 * stands for rays that leave the model elsewhere. Planned lamps come last; their light is in lx. */
#ifndef REMODEL_LEVELS_GROUPS_H
#define REMODEL_LEVELS_GROUPS_H

#include "common/daylight/sky_patches.h"
#include "common/gather/model_field.h"
#include "common/relight/planned_lamps.h"

struct light_window {
    const char *name;    /* of the mesh or of lights.txt */
    struct emitter pane; /* its normal points indoors */
    struct vec3 dual[2]; /* q from its centre is a x + b y, a = dual[0] . q, b = dual[1] . q */
};

/* {0} is the empty state; the windows are owned, the field is not. Groups of a kind are contiguous. */
struct light_groups {
    const struct model_field *field;
    struct light_window *windows; /* the last one is ELSEWHERE, without a pane */
    int windows_count;            /* with it */
    struct sky_patches patches;
    int lamps, rest, sky, sun;                 /* first group of each kind; of `sky` and `sun` one a window */
    int patch, beam;                           /* first of these; patches.count of each window */
    int planned;                               /* first planned lamp */
    int count;                                 /* groups */
    const struct planned_lamps *planned_lamps; /* not owned; NULL: none */
    double metre;                              /* model units of one */
    bool scaled;                               /* lx of the photographs are known: lamps of an edit shine with theirs */
    const double *factors; /* how bright groups of the photographs were measured; not owned; NULL: 1 */
};

#define WINDOW_ELSEWHERE "elsewhere"

/* hours: with patches and beams. The caller releases g in each case. ST_NOMEM. */
enum status groups_make(struct light_groups *g, const struct model_field *field, bool hours, struct err *err);
void groups_release(struct light_groups *g);
/* Adds planned lamps, which must outlive g, to groups that have none. */
void groups_add_planned(struct light_groups *g, const struct planned_lamps *lamps, double metre);

/* The window that a ray passes on its way out, of several the nearest one; the last one: none. */
int groups_window(const struct light_groups *g, struct vec3 from, struct vec3 direction);

/* The group of a part of a window's sky or sun. */
static inline int groups_patch(const struct light_groups *g, int window, int patch)
{
    return g->patch + window * g->patches.count + patch;
}
static inline int groups_beam(const struct light_groups *g, int window, int patch)
{
    return g->beam + window * g->patches.count + patch;
}

#endif
