/* support.c - box and support of each thing; see support.h.
 *
 * From voxels of its surface rays go down, up and to four sides until they meet the model. Furniture hides the floor
 * below it, so that its lowest seen voxels are often above it: floors get a larger reach than walls and ceilings. */
#include "stages/find_things/support.h"

#include <math.h>

#include "common/light/model_clearance.h"

#define FLOOR_REACH 3.0 /* times that of walls */
#define HANGING     3.0 /* times its height: what ends at the ceiling and is that far above the floor hangs there */
#define TABLE_REACH 9.0 /* the same where nothing else supports a thing: legs are too thin to be seen */

enum { SAMPLES = 2000 }; /* voxels of a thing that rays start from, about */

static void grow_box(struct thing *t, struct vec3 p, double half)
{
    const bool first = !t->voxels;
    t->low.x = first ? p.x - half : fmin(t->low.x, p.x - half);
    t->low.y = first ? p.y - half : fmin(t->low.y, p.y - half);
    t->low.z = first ? p.z - half : fmin(t->low.z, p.z - half);
    t->high.x = first ? p.x + half : fmax(t->high.x, p.x + half);
    t->high.y = first ? p.y + half : fmax(t->high.y, p.y + half);
    t->high.z = first ? p.z + half : fmax(t->high.z, p.z + half);
    t->voxels++;
}

/* The least distances of a thing's voxels from what is below, beside and above them. */
struct gaps {
    double below, beside, above;
    int64_t seen;
};

/* How far the next surface is that faces the point: from inside of a wall there is none. */
static double gap(const struct model_rays *m, struct vec3 from, struct vec3 direction)
{
    bool front = true;
    const double ahead = model_rays_gap(m, from, direction, &front);
    return front ? ahead : INFINITY;
}

double support_below(const struct model_rays *model, struct vec3 point)
{
    return gap(model, point, vec3_make(0, 0, -1));
}

static void look_around(struct gaps *g, const struct model_rays *m, struct vec3 p)
{
    g->below = fmin(g->below, support_below(m, p));
    g->above = fmin(g->above, gap(m, p, vec3_make(0, 0, 1)));
    for (int k = 0; k < 4; k++) {
        const double sign = k & 1 ? -1 : 1;
        g->beside = fmin(g->beside, gap(m, p, k & 2 ? vec3_make(0, sign, 0) : vec3_make(sign, 0, 0)));
    }
}

static void find_support(struct thing *t, uint32_t id, const struct thing_volume *v, const struct model_rays *m,
                         double reach)
{
    struct gaps g = {INFINITY, INFINITY, INFINITY, 0};
    const int64_t every = t->voxels / SAMPLES + 1;
    for (int64_t i = 0; i < (int64_t)voxel_count(&v->grid); i++)
        if (v->id[i] == id && g.seen++ % every == 0) look_around(&g, m, thing_voxel_centre(&v->grid, i));
    const double height = t->high.z - t->low.z;
    const bool hangs = g.above <= reach && g.below > HANGING * height;
    t->support = hangs                                                                 ? THING_ON_CEILING
                 : g.below <= FLOOR_REACH * reach && g.below <= FLOOR_REACH * g.beside ? THING_ON_FLOOR
                 : g.beside <= reach && g.beside <= g.above                            ? THING_ON_WALL
                 : g.above <= reach                                                    ? THING_ON_CEILING
                 : g.below <= TABLE_REACH * reach                                      ? THING_ON_FLOOR
                                                                                       : THING_ON_NONE;
}

void things_measure(struct thing *things, int count, const struct thing_volume *v, const struct model_rays *model,
                    double reach)
{
    for (int64_t i = 0; i < (int64_t)voxel_count(&v->grid); i++)
        if (v->id[i]) grow_box(&things[v->id[i] - 1], thing_voxel_centre(&v->grid, i), 0.5 * v->grid.voxel);
    for (int k = 0; k < count; k++) find_support(&things[k], (uint32_t)k + 1, v, model, reach);
}
