/* thing_hull.c - the places that a thing hides from all views; see thing_hull.h.
 *
 * The fused surface ends where the views' sight does: the side of a bookcase that stands at a wall is on no photo, and
 * through the wall that an edit removes the bookcase was a front without depth. What is behind the front, hidden by the
 * thing from every view that has it in its picture, may be filled by it: the visual hull [Laurentini 1994], from depth
 * instead of silhouettes, within the thing's box. A view that looks past a place empties it, unless it is the only one
 * against many, since a single depth may be wrong. */
#include "stages/render_model/thing_hull.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"

#define TOLERANCE 0.02 /* of the depth, beside voxels: a surface this far behind a place leaves it free */
#define VOXELS    1.0  /* the same in voxels */
#define INSIDE    0.5  /* voxels: what is this far behind a surface is hidden by it */
#define SURE      0.5f /* confidence of a view that empties a place */

enum { OUTVOTES = 3 }; /* views that hide a place, for each that looks past it */

struct hull_job {
    struct thing_hull *hull;
    const struct clutter_scene *scene;
    const struct clutter_choice *choice;
    const struct thing_volume *volume;
    uint32_t thing;
};

static bool is_solid(const struct hull_job *job, struct vec3 model)
{
    const struct vec3 p = world_from_model_point(&job->scene->axes, model);
    const double voxel = job->hull->grid.voxel / job->scene->axes.scale;
    int hidden = 0, past = 0, hides = -1;
    for (int k = 0; k < job->choice->count; k++) {
        const struct view *view = &job->scene->set->views[job->choice->view[k]];
        const struct clutter_view *source = &job->scene->sources[job->choice->view[k]].view;
        double u, v;
        const double z = view_project(view, p, &u, &v);
        if (!(z > 0) || !(u >= 0 && v >= 0 && u < view->width && v < view->height)) continue;
        const struct clutter_sight *sight = &source->sight[(size_t)v * (size_t)view->width + (size_t)u];
        if (!(sight->nearest > 0)) continue;
        const double beyond = 1 / (double)sight->nearest - z, slack = TOLERANCE * z + VOXELS * voxel;
        const bool shell = sight->shows < CLUTTER_SURE / 2;
        const bool free = beyond > slack || (beyond > -slack && shell);
        if (free)
            past += (float)sight->sure / (float)CLUTTER_SURE >= SURE;
        else if (beyond < -INSIDE * voxel && sight->thing == job->thing && !shell)
            hides = job->choice->view[k], hidden++;
    }
    return hidden > OUTVOTES * past && !clutter_is_hidden(job->scene, job->scene->set->views[hides].center, p);
}

/* Whether no view of the scene looked through a place, and no other thing is there. */
static bool may_be_solid(const struct hull_job *job, struct vec3 p)
{
    const struct thing_volume *v = job->volume;
    const int64_t at = thing_voxel_at(&v->grid, p);
    if (at < 0 || (v->id[at] && v->id[at] != job->thing)) return false;
    return v->distance[at] == THING_UNSEEN || v->distance[at] <= 0;
}

static void find_voxels(void *ctx, size_t begin, size_t end, int thread)
{
    const struct hull_job *job = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        const struct vec3 p = thing_voxel_centre(&job->hull->grid, (int64_t)i);
        job->hull->solid[i] = may_be_solid(job, p) && is_solid(job, p);
    }
}

/* Takes off the voxels at the rim, whose sides are not all solid: depth at outlines is off by as much. What is outside
 * of the box counts as solid. */
static enum status take_rim(struct thing_hull *hull, struct err *err)
{
    const int *size = hull->grid.size;
    const size_t voxels = voxel_count(&hull->grid), step[3] = {1, (size_t)size[0], (size_t)size[0] * (size_t)size[1]};
    uint8_t *all = malloc(voxels);
    if (!all) return err_nomem(err, "the hull of a thing", voxels);
    memcpy(all, hull->solid, voxels);
    for (size_t i = 0; i < voxels; i++)
        for (int k = 0; k < 3; k++) {
            const int at = (int)(i / step[k] % (size_t)size[k]);
            if ((at > 0 && !all[i - step[k]]) || (at + 1 < size[k] && !all[i + step[k]])) hull->solid[i] = 0;
        }
    free(all);
    return ST_OK;
}

enum status thing_hull_find(struct thing_hull *hull, const struct clutter_scene *scene,
                            const struct clutter_choice *choice, const struct thing_shape *thing, struct err *err)
{
    const struct voxel_grid *g = &thing->volume->grid;
    const struct vec3 low = thing->points->low, size = vec3_sub(thing->points->high, low);
    *hull = (struct thing_hull){.grid = *g};
    if (thing->outline->count || !(size.x > 0 && size.y > 0 && size.z > 0)) return ST_OK;
    hull->grid.origin = low;
    const double sides[3] = {size.x, size.y, size.z};
    for (int k = 0; k < 3; k++) hull->grid.size[k] = (int)ceil(sides[k] / g->voxel);
    const size_t voxels = voxel_count(&hull->grid);
    if (!(hull->solid = malloc(voxels))) return err_nomem(err, "the hull of a thing", voxels);
    struct hull_job job = {hull, scene, choice, thing->volume, thing->id};
    parallel_for(voxels, 256, find_voxels, &job);
    return take_rim(hull, err);
}

void thing_hull_release(struct thing_hull *hull)
{
    free(hull->solid);
    *hull = (struct thing_hull){0};
}
